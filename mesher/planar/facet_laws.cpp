#include "mesher/planar/facet_laws.h"

#include <algorithm>
#include <utility>

#include "mesher/base/disjoint_sets.h"
#include "mesher/base/sort_unique.h"
#include "mesher/predicates/exact_point.h"
#include "mesher/predicates/stages.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::planar {
namespace {

struct Outline {
  std::vector<VertexId> corners;
  std::vector<std::pair<VertexId, VertexId>> sides;  // half-edges without an opposite one inside
  bool operator==(const Outline&) const = default;
};

Outline outline(std::span<const std::array<std::uint32_t, 3>> triangles,
                std::span<const std::uint32_t> opposite, const std::vector<std::uint32_t>& facet) {
  Outline result;
  for (const std::uint32_t t : facet) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexId a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      result.corners.push_back(a);
      if (!std::ranges::binary_search(facet, opposite[3 * t + k] / 3)) {
        result.sides.emplace_back(a, b);
      }
    }
  }
  sort_unique(result.corners);
  std::ranges::sort(result.sides);
  return result;
}

DyadicPoint minus(const DyadicPoint& p, const DyadicPoint& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
DyadicPoint product(const DyadicPoint& p, const DyadicPoint& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
Dyadic inner(const DyadicPoint& p, const DyadicPoint& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

}  // namespace

std::vector<std::vector<std::uint32_t>> facets_of(const ChangedSurface& s, Predicates& predicates) {
  const auto label = [&](std::uint32_t t) {
    return t < s.given.labels.size() ? s.given.labels[t] : 0;
  };
  DisjointSets sets(s.triangles.size());
  for (std::uint32_t h = 0; h < s.opposite.size(); ++h) {
    const std::uint32_t g = s.opposite[h], t = h / 3, u = g / 3;
    if (h > g || label(t) != label(u) || sets.smallest(t) == sets.smallest(u)) continue;
    const auto& [a, b, c] = s.triangles[t];
    if (predicates.orient3d(a, b, c, s.triangles[u][(g % 3 + 2) % 3]) == 0) sets.join(t, u);
  }
  std::vector<std::vector<std::uint32_t>> facets;
  std::vector<std::size_t> number(s.triangles.size());
  for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
    const std::uint32_t root = sets.smallest(t);
    if (root == t) {
      number[t] = facets.size();
      facets.emplace_back();
    }
    facets[number[root]].push_back(t);
  }
  return facets;
}

bool keeps_outline(const ChangedSurface& s, const std::vector<std::uint32_t>& facet) {
  return outline(s.triangles, s.opposite, facet) ==
         outline(s.given.triangles, s.given_opposite, facet);
}

// Is x farther than `bound` from the plane of three points? The sign of what it is farther by;
// kUnknownSign if that is not certain.
int far_by_doubles(const PointStore& points, const std::array<VertexId, 3>& t, const Vec3& x,
                   double bound) {
  const auto a = stages::bounded_point(points, t[0]);
  const auto normal = polynomials::cross(stages::bounded_point(points, t[1]) - a,
                                         stages::bounded_point(points, t[2]) - a);
  const Bounded height =
      polynomials::dot(normal, polynomials::Triple<Bounded>{{x[0]}, {x[1]}, {x[2]}} - a);
  const Bounded least = Bounded{bound} * Bounded{bound} * polynomials::dot(normal, normal);
  return (height * height - least).sign();
}

std::vector<std::uint32_t> far_from_plane(const ChangedSurface& s,
                                          const std::vector<std::uint32_t>& facet, double bound,
                                          PointStore& points) {
  const std::size_t before = points.size();
  const VertexId scale = points.add_explicit(bound, 0, 0);
  const auto is_far = [&](VertexId v) {
    const Vec3& x = s.given.vertices[v];
    const int sign = far_by_doubles(points, s.triangles[facet.front()], x, bound);
    if (sign != kUnknownSign) return sign > 0;
    const VertexId as_given = points.add_explicit(x[0], x[1], x[2]);
    const auto& [a, b, c] = s.triangles[facet.front()];
    const std::array<VertexId, 5> asked = {a, b, c, as_given, scale};
    const std::vector<DyadicPoint> p = scaled_exact_points(points, asked);
    points.pop_back();
    const DyadicPoint normal = product(minus(p[1], p[0]), minus(p[2], p[0]));
    const Dyadic height = inner(normal, minus(p[3], p[0]));
    return (height * height - p[4][0] * p[4][0] * inner(normal, normal)).sign() > 0;
  };
  std::vector<VertexId> far;
  for (const std::uint32_t t : facet) {
    far.insert(far.end(), s.given.triangles[t].begin(), s.given.triangles[t].end());
  }
  sort_unique(far);
  std::erase_if(far, [&](VertexId v) { return !is_far(v); });
  points.truncate(before);
  std::vector<std::uint32_t> result;
  for (const std::uint32_t t : facet) {
    if (std::ranges::any_of(s.given.triangles[t],
                            [&](VertexId v) { return std::ranges::binary_search(far, v); })) {
      result.push_back(t);
    }
  }
  return result;
}

}  // namespace delmesher::planar
