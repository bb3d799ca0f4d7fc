// Points known exactly: explicit, on an input segment, on an input triangle (section 4.3.1).
//
// The two implicit kinds are polynomials in doubles, so every coordinate is an exact dyadic number:
//   on-segment   t p + (1 - t) q              = q + t (p - q)
//   on-triangle  u p + v q + (1 - u - v) r    = r + u (p - r) + v (q - r)
// with p, q, r explicit and t, u, v doubles. The formulas hold for any finite t, u, v: a point with
// parameters outside [0, 1] still lies exactly on the line or plane.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/ids.h"

namespace delmesher {

using Vec3 = std::array<double, 3>;

enum class PointKind : std::uint8_t { explicit_point, on_segment, on_triangle };

// The nearest doubles of a point and a bound on the error of each coordinate (0: they are exact).
struct Approximation {
  double x, y, z;
  double error;
};

struct PointDefinition {
  PointKind kind;
  std::array<VertexId, 3> corner;  // p, q (, r); kNone where unused
  double u, v;                     // t = u on a segment
};

// The exact value of one coordinate, cached: see points.cpp for the representation.
struct ExactCoordinates;

// Append-only list of points with cached exact and approximate coordinates and "supports": ids of
// planes and lines known to contain the point. A support shared by all arguments of a predicate
// proves that its determinant is zero; no shared support proves nothing.
class PointStore {
 public:
  VertexId add_explicit(double x, double y, double z);
  // p, q, r must be explicit points of this store.
  VertexId add_on_segment(VertexId p, VertexId q, double t);
  VertexId add_on_triangle(VertexId p, VertexId q, VertexId r, double u, double v);
  // Removes the last point.
  void pop_back();

  // Sorted, without repetition. Replaces earlier supports of v.
  void set_supports(VertexId v, std::span<const PlaneId> planes,
                    std::span<const std::uint32_t> lines);
  std::span<const PlaneId> planes(VertexId v) const;
  std::span<const std::uint32_t> lines(VertexId v) const;

  std::size_t size() const { return approximations_.size(); }
  void reserve(std::size_t n);
  const Approximation& approximation(VertexId v) const { return approximations_[v]; }
  Vec3 nearest(VertexId v) const {
    const Approximation& a = approximations_[v];
    return {a.x, a.y, a.z};
  }
  const PointDefinition& definition(VertexId v) const { return definitions_[v]; }
  bool is_explicit(VertexId v) const { return definitions_[v].kind == PointKind::explicit_point; }
};

}  // namespace delmesher
