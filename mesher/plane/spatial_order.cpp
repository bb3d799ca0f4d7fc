#include "mesher/plane/spatial_order.h"

#include <algorithm>

#include "mesher/base/spatial_sort.h"

namespace delmesher::plane {
namespace {

// Without branches: where a point lies is random.
std::uint64_t hilbert_key(std::uint32_t x, std::uint32_t y, int bits) {
  std::uint64_t key = 0;
  for (int b = bits - 1; b >= 0; --b) {
    const std::uint32_t right = x >> b & 1, upper = y >> b & 1;
    key = 4 * key + ((3 * right) ^ upper);
    const std::uint32_t mirror = (upper ^ 1) & right;
    const std::uint32_t turn = (x ^ y) & (upper - 1);
    x ^= turn ^ (0 - mirror);
    y ^= turn ^ (0 - mirror);
  }
  return key;
}

}  // namespace

SpatialKey::SpatialKey(const std::array<double, 2>& low, const std::array<double, 2>& high)
    : low_(low), extent_(std::max(high[0] / 2 - low[0] / 2, high[1] / 2 - low[1] / 2)) {}

std::uint64_t SpatialKey::operator()(double x, double y) const {
  if (!(extent_ > 0)) return 0;
  constexpr int kBits = 32;  // per axis
  constexpr double kCells = 0xffffffff;
  const auto column = static_cast<std::uint32_t>((x / 2 - low_[0] / 2) / extent_ * kCells);
  const auto row = static_cast<std::uint32_t>((y / 2 - low_[1] / 2) / extent_ * kCells);
  return hilbert_key(column, row, kBits);
}

std::vector<std::uint32_t> order_along_curve(std::span<const std::array<double, 2>> points) {
  if (points.empty()) return {};
  std::array<double, 2> low = points[0], high = low;
  for (const auto& x : points) {
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], x[k]);
      high[k] = std::max(high[k], x[k]);
    }
  }
  const SpatialKey key(low, high);
  struct Item {
    std::uint64_t key;
    std::uint32_t position;
  };
  std::vector<Item> items(points.size());
  for (std::uint32_t n = 0; n < points.size(); ++n) items[n] = {key(points[n][0], points[n][1]), n};
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.key != b.key ? a.key < b.key : a.position < b.position;
  });
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t n = 0; n < items.size(); ++n) order[n] = items[n].position;
  return order;
}

void arrange_in_rounds(std::vector<VertexId>& order) {
  const InsertionRounds rounds(order.size());
  const auto round = [&rounds](std::size_t n) {
    return static_cast<std::size_t>(rounds(static_cast<std::uint32_t>(n)));
  };
  std::array<std::size_t, 33> first{};
  for (std::size_t n = 0; n < order.size(); ++n) ++first[round(n) + 1];
  for (std::size_t r = 1; r < first.size(); ++r) first[r] += first[r - 1];
  std::vector<VertexId> result(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) result[first[round(n)]++] = order[n];
  order = std::move(result);
}

}  // namespace delmesher::plane
