#include "corpus/generators/vary.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "corpus/generators/rotate.h"
#include "corpus/generators/shapes.h"
#include "reports/relations.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using shapes::Point;

constexpr std::array<int, 2> kExponents = {10, -10};

std::vector<std::uint32_t> shuffled(std::size_t count, Random& random) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return order;
}

std::optional<double> exact_mean(double a, double b) {
  const double sum = a + b, part = sum - a;
  const bool exact_sum = (a - (sum - part)) + (b - part) == 0;  // Knuth's two-sum
  const double mean = sum / 2;
  if (!std::isfinite(sum) || !exact_sum || mean * 2 != sum) return std::nullopt;
  return mean;
}

std::optional<Point> exact_midpoint(const Point& p, const Point& q) {
  Point middle{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto mean = exact_mean(p[i], q[i]);
    if (!mean) return std::nullopt;
    middle[i] = *mean;
  }
  return middle;
}

std::string suffix_of(Relation relation, std::size_t index) {
  return kRelations[static_cast<std::size_t>(relation)].letter + std::to_string(index + 1);
}

}  // namespace

Surface quarter_turned(const Surface& surface) {
  Surface result = surface;
  shapes::move(result, [](const Point& p) { return Point{0 - p[1], p[0], p[2]}; });
  return result;
}

Surface third_turned(const Surface& surface) {
  Surface result = surface;
  shapes::move(result, [](const Point& p) { return Point{p[2], p[0], p[1]}; });
  return result;
}

std::optional<Surface> scaled(const Surface& surface, int exponent) {
  Surface result = surface;
  for (Point& p : result.vertices) {
    for (double& x : p) {
      const double before = x;
      x = std::ldexp(x, exponent);
      if (!std::isfinite(x) || std::ldexp(x, -exponent) != before) return std::nullopt;
    }
  }
  return result;
}

Surface renumbered(const Surface& surface, Random& random) {
  const std::vector<std::uint32_t> vertices = shuffled(surface.vertices.size(), random);
  const std::vector<std::uint32_t> triangles = shuffled(surface.triangles.size(), random);
  std::vector<std::uint32_t> number(vertices.size());  // of a vertex, in the result
  Surface result;
  for (const std::uint32_t v : vertices) {
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(surface.vertices[v]);
  }
  for (const std::uint32_t t : triangles) {
    const auto& corners = surface.triangles[t];
    const std::size_t k = random.below(3);
    result.triangles.push_back(
        {number[corners[k]], number[corners[(k + 1) % 3]], number[corners[(k + 2) % 3]]});
    if (!surface.labels.empty()) result.labels.push_back(surface.labels[t]);
  }
  return result;
}

std::optional<Surface> split_exactly(const Surface& surface, Random& random) {
  for (const std::uint32_t t : shuffled(surface.triangles.size(), random)) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& corners = surface.triangles[t];
      const auto middle =
          exact_midpoint(surface.vertices[corners[k]], surface.vertices[corners[(k + 1) % 3]]);
      if (!middle) continue;
      Surface result = surface;
      split_edge_at(result, t, static_cast<int>(k), *middle);
      return result;
    }
  }
  return std::nullopt;
}

std::vector<ExactCopy> exact_copies(const Surface& surface) {
  Random random(surface.triangles.size());
  std::vector<ExactCopy> copies;
  copies.push_back({suffix_of(Relation::turned, 0), quarter_turned(surface)});
  copies.push_back({suffix_of(Relation::turned, 1), third_turned(surface)});
  for (std::size_t i = 0; i < kExponents.size(); ++i) {
    copies.push_back({suffix_of(Relation::scaled, i), scaled(surface, kExponents[i])});
  }
  copies.push_back({suffix_of(Relation::renumbered, 0), renumbered(surface, random)});
  copies.push_back({suffix_of(Relation::split, 0), split_exactly(surface, random)});
  return copies;
}

}  // namespace tetproof
