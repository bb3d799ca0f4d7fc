// Mutation and crossover of surfaces for the targets that take one: half-edge edits that keep it
// valid, so that the fuzzer spends its time behind the input check. Deterministic in the seed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "corpus/generators/certify.h"
#include "corpus/generators/edits.h"
#include "corpus/generators/generate.h"
#include "corpus/generators/rotate.h"
#include "corpus/generators/twins.h"
#include "fuzz/entry.h"

namespace tetproof::fuzz {
namespace {

using delmesher::Surface;

// Below 2^-40 doubles leave stages little room: they stop, or chamfer by less than an ulp, and the
// properties show little. So most changes are larger.
constexpr int kBits = 32, kManyBits = 50;

#ifndef TETPROOF_FUZZ_INVALID
// A triangle so low beside the surface that a chamfer in it, about as long as its height times its
// angle, is near an ulp. The fuzzer finds these interesting, each for another stop, and would
// collect nothing else, so most of them are not taken.
constexpr double kLow = 0x1p-24, kNarrowTaken = 0.05;

bool narrow(const Surface& surface) {
  if (surface.triangles.empty()) return false;
  const auto difference = [&](std::uint32_t v, std::uint32_t w) {
    std::array<double, 3> d{};
    for (std::size_t i = 0; i < 3; ++i) d[i] = surface.vertices[v][i] - surface.vertices[w][i];
    return d;
  };
  const auto length = [](const std::array<double, 3>& d) { return std::hypot(d[0], d[1], d[2]); };
  double size = 0;
  for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
    size = std::max(size, length(difference(v, 0)));
  }
  return std::any_of(surface.triangles.begin(), surface.triangles.end(), [&](const auto& t) {
    double longest = 0;
    std::array<double, 3> base{}, other{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto side = difference(t[(i + 1) % 3], t[i]);
      if (!(length(side) > longest)) continue;
      longest = length(side);
      base = side;
      other = difference(t[(i + 2) % 3], t[i]);
    }
    const auto unit = [&](std::size_t i) { return base[i] / longest; };
    const std::array<double, 3> up = {unit(1) * other[2] - unit(2) * other[1],
                                      unit(2) * other[0] - unit(0) * other[2],
                                      unit(0) * other[1] - unit(1) * other[0]};
    return !(length(up) > kLow * size);
  });
}
#endif

std::size_t store(const Surface& surface, std::uint8_t* data, std::size_t size,
                  std::size_t max_size) {
  const std::string text = to_off(surface);
  if (text.size() > max_size || surface.triangles.size() > kLargestSurface) return size;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

int size_exponent(const Surface& surface) {
  double largest = 0;
  for (const auto& p : surface.vertices) {
    for (const double x : p) largest = std::max(largest, std::fabs(x));
  }
  return largest > 0 ? std::ilogb(largest) : 0;
}

// A member of a family, which now and then takes the place of an input of the corpus: one in five
// has few roundings, where most findings were.
Surface fresh(Random& random) {
  const Family& family =
      random.chance(0.2) ? *find_family("coarse") : families()[random.below(families().size())];
  const auto surface = generate(family, random.bits(), 0);
  return surface ? *surface : Surface{};
}

// Scales by a power of two to the size of another surface, with few exceptions. If their sizes
// differed by hundreds of binary digits, the smaller one would be nothing to a mesher.
Surface resized(Surface surface, const Surface& like, Random& random) {
  if (random.chance(0.02)) return surface;
  const int by = size_exponent(like) - size_exponent(surface);
  for (auto& p : surface.vertices) {
    for (double& x : p) x = std::ldexp(x, by);
  }
  return surface;
}

void move_everything(Surface& surface, Random& random) {
  Surface moved = surface;
  if (random.chance(0.2)) {
    moved = coarsened(surface, random.integer(1, 30), random);
    if (certified_valid(moved)) surface = std::move(moved);
    return;
  }
  const int most = random.chance(0.1) ? 350 : 40;
  const double scale = std::ldexp(random.sign(), random.integer(-most, most));
  std::array<double, 3> shift{};
  if (random.chance(0.5)) {
    for (double& x : shift) x = random.sign() * random.tiny(20) * (random.chance(0.3) ? 0x1p30 : 1);
  }
  for (auto& p : moved.vertices) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] * scale + shift[i];
  }
  if (certified_valid(moved)) surface = std::move(moved);
}

#ifdef TETPROOF_FUZZ_INVALID
// A small copy at a vertex, point by point on its other side. The two have only the vertex in
// common if the surface is convex there.
Surface pinched(Surface surface, Random& random) {
  const auto count = static_cast<std::uint32_t>(surface.vertices.size());
  const auto at = static_cast<std::uint32_t>(random.below(count));
  const auto of_copy = [&](std::uint32_t v) { return v == at ? at : count + v - (v > at ? 1 : 0); };
  const auto p = surface.vertices[at];
  const double size = random.tiny(20);
  for (std::uint32_t v = 0; v < count; ++v) {
    if (v == at) continue;
    auto q = surface.vertices[v];
    for (std::size_t i = 0; i < 3; ++i) q[i] = p[i] - (q[i] - p[i]) * size;
    surface.vertices.push_back(q);
  }
  const std::size_t triangles = surface.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = surface.triangles[t];
    surface.triangles.push_back({of_copy(a), of_copy(c), of_copy(b)});
  }
  return surface;
}
#endif

Surface mutate(Surface surface, Random& random) {
  if (random.chance(0.08)) return fresh(random);
  if (random.chance(0.05)) move_everything(surface, random);
  if (random.chance(0.05)) {
    combine(surface, resized(fresh(random), surface, random), random);
  }
  for (int changes = random.integer(1, 4), attempt = 0; changes > 0 && attempt < 16; ++attempt) {
    if (edit(surface, random, random.chance(0.1) ? kManyBits : kBits)) --changes;
  }
#ifdef TETPROOF_FUZZ_INVALID
  if (random.chance(0.1)) return pinched(std::move(surface), random);
  if (random.chance(0.5)) {
    const auto twins = make_twins(surface, random);
    if (!twins.empty()) return twins[random.below(twins.size())].surface;
  }
#endif
  return surface;
}

}  // namespace
}  // namespace tetproof::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  using namespace tetproof::fuzz;
  tetproof::Random random(seed);
  auto surface = parse(data, size);
  if (!surface || !tetproof::certified_valid(*surface)) surface = fresh(random);
  if (surface->triangles.empty()) return size;
  Surface mutated = mutate(*surface, random);
#ifndef TETPROOF_FUZZ_INVALID
  for (int attempt = 0; attempt < 4 && narrow(mutated) && !random.chance(kNarrowTaken); ++attempt) {
    mutated = mutate(narrow(*surface) ? fresh(random) : *surface, random);
  }
#endif
  return store(mutated, data, size, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1,
                                                 const std::uint8_t* data2, std::size_t size2,
                                                 std::uint8_t* out, std::size_t max_out,
                                                 unsigned int seed) {
  using namespace tetproof::fuzz;
  tetproof::Random random(seed);
  auto first = parse(data1, size1);
  const auto second = parse(data2, size2);
  if (!first || !second || !tetproof::certified_valid(*first) ||
      !tetproof::certified_valid(*second)) {
    return 0;
  }
  const auto other = resized(*second, *first, random);
  return tetproof::combine(*first, other, random) ? store(*first, out, 0, max_out) : 0;
}
