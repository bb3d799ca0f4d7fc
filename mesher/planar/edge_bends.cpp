#include "mesher/planar/edge_bends.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/geometry/vector.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::planar {
namespace {

using predicates::Vec3;

// As noisy as the corners are, however narrow the triangles.
double bend(const Surface& surface, std::uint32_t h, std::uint32_t g) {
  const auto corner = [&](std::uint32_t edge, std::uint32_t k) {
    return surface.vertices[surface.triangles[edge / 3][(edge % 3 + k) % 3]];
  };
  const std::array<Vec3, 4> p = {corner(h, 0), corner(h, 1), corner(h, 2), corner(g, 2)};
  const Vec3 edge = subtract(p[1], p[0]), t = cross(edge, subtract(p[2], p[0])),
             u = cross(subtract(p[3], p[0]), edge);
  if (!(dot(t, u) > 0)) return HUGE_VAL;
  const double weight_t = norm(t), weight_u = norm(u);
  Vec3 normal, centre;
  for (std::size_t i = 0; i < 3; ++i) {
    normal[i] = t[i] + u[i];
    centre[i] = (edge[i] + (weight_t * (p[2][i] - p[0][i]) + weight_u * (p[3][i] - p[0][i])) /
                               (weight_t + weight_u)) /
                3;
  }
  double largest = 0;
  for (const Vec3& q : p) {
    largest = std::max(largest, std::fabs(dot(normal, subtract(subtract(q, p[0]), centre))));
  }
  return std::copysign(largest / norm(normal), -dot(t, subtract(p[3], p[0])));
}

// Bends to one side, or to both, by their sizes.
class Sizes {
 public:
  void add(double size) { sizes_.push_back(size); }
  void sort() { std::sort(sizes_.begin(), sizes_.end()); }
  const std::vector<double>& all() const { return sizes_; }
  std::ptrdiff_t up_to(double most) const {
    return std::upper_bound(sizes_.begin(), sizes_.end(), most) - sizes_.begin();
  }
  std::ptrdiff_t between(double more_than, double most) const {
    return up_to(most) - up_to(more_than);
  }

 private:
  std::vector<double> sizes_;
};

}  // namespace

std::vector<double> edge_bends(const Surface& surface) {
  const HalfEdgeGroups edges(surface.triangles, surface.vertices.size());
  std::vector<double> result;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (const auto h = edges[e]; h.size() == 2) result.push_back(bend(surface, h[0], h[1]));
  }
  return result;
}

double noise_of_bends(const std::vector<double>& bends, double rounding, double least, double most,
                      std::ptrdiff_t fewest) {
  constexpr std::ptrdiff_t kTimes = 7, kSmaller = 8, kShare = 4, kShareOfLarge = 8, kTimesAll = 10;
  constexpr double kSoon = 2.5;
  Sizes all, convex, concave;
  for (const double x : bends) {
    if (!(std::fabs(x) > rounding)) continue;
    all.add(std::fabs(x));
    (x > 0 ? convex : concave).add(std::fabs(x));
  }
  for (Sizes* sizes : {&all, &convex, &concave}) sizes->sort();
  // To the side that has fewer.
  const auto fewer = [&](double more_than, double to) {
    return std::min(convex.between(more_than, to), concave.between(more_than, to));
  };
  double noise = 0;
  for (const double x : all.all()) {
    if (x <= least) continue;
    if (x > most || (noise > 0 && x > kSoon * noise)) break;
    const std::ptrdiff_t up_to = all.up_to(x), large = all.between(x / 4, x),
                         to_either_side = fewer(0, x);
    const bool like_noise = up_to >= fewest && to_either_side >= kTimes * fewer(x, 4 * x) &&
                            kSmaller * all.between(x / 16, x / 4) >= large &&
                            kShare * std::min(large, to_either_side) >= up_to &&
                            kShareOfLarge * fewer(x / 4, x) >= large;
    if (!like_noise) continue;
    if (up_to >= kTimesAll * all.between(x, 4 * x)) return x;
    if (noise == 0) noise = x;
  }
  return noise;
}

double roughness(const Surface& surface, double rounding, double noise) {
  constexpr double kAlike = 0.95, kTimes = 2;  // cosine; of the length
  constexpr std::size_t kFewest = 32, kManyEdges = 32;
  struct BentEdge {
    std::array<std::uint32_t, 4> corners;  // the first two are its ends
    Vec3 along;
    double length, bend;
  };
  std::vector<BentEdge> bent;
  std::vector<std::vector<std::uint32_t>> at(surface.vertices.size());
  const HalfEdgeGroups edges(surface.triangles, surface.vertices.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges[e];
    if (h.size() != 2) continue;
    const double x = bend(surface, h[0], h[1]);
    if (!(std::fabs(x) > rounding) || std::fabs(x) > 4 * noise) continue;
    const auto corner = [&](std::uint32_t edge, std::uint32_t k) {
      return surface.triangles[edge / 3][(edge % 3 + k) % 3];
    };
    const std::uint32_t a = corner(h[0], 0), b = corner(h[0], 1);
    const Vec3 along = subtract(surface.vertices[b], surface.vertices[a]);
    for (const std::uint32_t v : {a, b}) at[v].push_back(static_cast<std::uint32_t>(bent.size()));
    bent.push_back({{a, b, corner(h[0], 2), corner(h[1], 2)}, along, norm(along), x});
  }
  double differences = 0, squares = 0;
  std::size_t telling = 0;
  std::vector<std::uint32_t> beside;
  for (std::uint32_t i = 0; i < bent.size(); ++i) {
    const BentEdge& edge = bent[i];
    if (std::fabs(edge.bend) > noise) continue;
    beside.clear();
    for (const std::uint32_t v : edge.corners) {
      if (at[v].size() <= kManyEdges) beside.insert(beside.end(), at[v].begin(), at[v].end());
    }
    std::sort(beside.begin(), beside.end());
    beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
    bool tells = false;
    for (const std::uint32_t j : beside) {
      const BentEdge& other = bent[j];
      const double product = edge.length * other.length;
      if (j == i || !(std::fabs(dot(edge.along, other.along)) > kAlike * product) ||
          edge.length > kTimes * other.length || other.length > kTimes * edge.length) {
        continue;
      }
      const double difference = edge.bend - other.bend;
      differences += difference * difference;
      squares += edge.bend * edge.bend + other.bend * other.bend;
      tells = true;
    }
    telling += tells ? 1 : 0;
  }
  return telling >= kFewest ? differences / squares : 1;
}

}  // namespace delmesher::planar
