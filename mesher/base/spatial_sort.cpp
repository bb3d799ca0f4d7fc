#include "mesher/base/spatial_sort.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace delmesher::base {
namespace {

constexpr int kBits = 20;  // per axis: three of them fit a 64-bit key, with room for the round

// Leaves two bits of room above each bit of a number of kBits.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffU;
  x = (x | x << 16) & 0x1f0000ff0000ffU;
  x = (x | x << 8) & 0x100f00f00f00f00fU;
  x = (x | x << 4) & 0x10c30c30c30c30c3U;
  return (x | x << 2) & 0x1249249249249249U;
}

// Skilling, "Programming the Hilbert curve" (2004): transposed index of a grid point.
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  constexpr std::uint32_t kTop = 1U << (kBits - 1);
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (int i = 0; i < 3; ++i) {
      if ((x[i] & q) != 0) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ x[i]) & p;
        x[0] ^= t;
        x[i] ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = kTop; q > 1; q >>= 1) {
    if ((x[2] & q) != 0) t ^= q - 1;
  }
  return spread(x[0] ^ t) << 2 | spread(x[1] ^ t) << 1 | spread(x[2] ^ t);
}

std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

// Permutes `order` by a number from 0 to 15 for each position, then along a Hilbert curve.
template <class Group>
void sort_in_groups(std::span<std::uint32_t> order,
                    std::span<const std::array<double, 3>> coordinates, Group&& group) {
  if (order.empty()) return;
  std::array<double, 3> low = coordinates[order[0]];
  std::array<double, 3> high = low;
  for (const std::uint32_t i : order) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], coordinates[i][k]);
      high[k] = std::max(high[k], coordinates[i][k]);
    }
  }
  // Halved before subtracting, so that the largest doubles do not overflow.
  double extent = 0;
  for (int k = 0; k < 3; ++k) extent = std::max(extent, high[k] / 2 - low[k] / 2);
  const double cells = static_cast<double>((1U << kBits) - 1);

  struct Item {
    std::uint64_t key;
    std::uint32_t position, point;
  };
  std::vector<Item> items(order.size());
  for (std::uint32_t n = 0; n < order.size(); ++n) {
    std::array<std::uint32_t, 3> cell{};
    for (int k = 0; k < 3; ++k) {
      const double half = coordinates[order[n]][k] / 2 - low[k] / 2;
      cell[k] = extent > 0 ? static_cast<std::uint32_t>(half / extent * cells) : 0;
    }
    items[n] = {(std::uint64_t(group(n)) << 60) | hilbert_key(cell), n, order[n]};
  }
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.key != b.key ? a.key < b.key : a.position < b.position;
  });
  for (std::size_t n = 0; n < items.size(); ++n) order[n] = items[n].point;
}

}  // namespace

InsertionRounds::InsertionRounds(std::size_t points)
    : last_(std::clamp(static_cast<int>(std::bit_width(points)) - 6, 0, 31)) {}

int InsertionRounds::operator()(std::uint32_t n) const {
  return std::max(0, last_ - std::countr_zero(hash(n) | (1U << 31)));
}

void spatial_sort(std::span<std::uint32_t> order,
                  std::span<const std::array<double, 3>> coordinates) {
  const InsertionRounds rounds(order.size());
  // A Hilbert key has 60 bits, so at most 15 rounds get their own group.
  sort_in_groups(order, coordinates, [&](std::uint32_t n) {
    return std::clamp(rounds(n) - rounds.last() + 15, 0, 15);
  });
}

void hilbert_sort(std::span<std::uint32_t> order,
                  std::span<const std::array<double, 3>> coordinates) {
  sort_in_groups(order, coordinates, [](std::uint32_t) { return 0; });
}

}  // namespace delmesher::base
