// Points known exactly: explicit, on an input segment, on an input triangle (section 4.3.1), and
// the meeting point of three planes (the corner of a surface whose facets were made planar).
//
//   on-segment   t p + (1 - t) q              = q + t (p - q)
//   on-triangle  u p + v q + (1 - u - v) r    = r + u (p - r) + v (q - r)
//   on-planes    the solution of n_i . (x - a_i) = 0, i = 1, 2, 3
// with p, q, r explicit or on-planes, t, u, v and all n_i and a_i doubles (PlaneEquation). The
// formulas hold for any finite t, u, v: a point with parameters outside [0, 1] still lies exactly
// on the line or plane. Coordinates are dyadic numbers over a common odd denominator, which is 1
// unless points on planes are involved.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/arithmetic/words.h"
#include "mesher/base/growing_array.h"
#include "mesher/base/ids.h"

namespace delmesher::predicates {

using Vec3 = std::array<double, 3>;

enum class PointKind : std::uint8_t { explicit_point, on_segment, on_triangle, on_planes };

// All x with normal . (x - through[0]) = 0, exactly; or, if `spanned`, the plane through three
// points, of which `normal` is an approximate normal only.
struct PlaneEquation {
  Vec3 normal;
  std::array<Vec3, 3> through;
  bool spanned = false;

  bool operator==(const PlaneEquation&) const = default;
};

// The nearest doubles of a point (within a hair, with a denominator) and a bound on the error of
// each coordinate (0: they are exact).
struct Approximation {
  double x, y, z;
  double error;
};

struct PointDefinition {
  PointKind kind;
  // p, q (, r); kNone where unused. On planes: their numbers in the store.
  std::array<VertexId, 3> corner;
  double u, v;  // t = u on a segment
};

// An exact coordinate: (odd integer of |size| 64-bit limbs, least significant first, negative if
// size is) times 2^exponent; size 0 is zero. Points into the store or into `own`.
struct ExactCoordinate {
  const Word* limbs = nullptr;
  std::int32_t size = 0;
  std::int32_t exponent = 0;
};

// The exact coordinates of one point. Valid until the store changes; not to be copied or moved (the
// coordinates of explicit points lie inside).
struct ExactPosition {
  ExactPosition() = default;
  ExactPosition(const ExactPosition&) = delete;
  ExactPosition& operator=(const ExactPosition&) = delete;

  std::array<ExactCoordinate, 3> coordinate;  // numerators
  ExactCoordinate denominator;                // odd and above 1, or size 0 for 1
  std::array<Word, 3> own;
};

struct RationalPoint;

// For an explicit point.
void set_exact(const Vec3& x, ExactPosition& out);

// Append-only list of points with cached exact and approximate coordinates and "supports": ids of
// planes and lines known to contain the point. A support shared by all arguments of a predicate
// proves that its determinant is zero; no shared support proves nothing.
class PointStore {
 public:
  VertexId add_explicit(double x, double y, double z);
  // p, q, r must be points of this store, explicit or on planes.
  VertexId add_on_segment(VertexId p, VertexId q, double t);
  VertexId add_on_triangle(VertexId p, VertexId q, VertexId r, double u, double v);
  // Returns the number of the plane. The normal must not be zero.
  std::uint32_t add_plane(const PlaneEquation& plane);
  std::size_t plane_count() const { return equations_.size(); }
  const PlaneEquation& plane(std::uint32_t n) const { return equations_[n]; }
  // The planes, by their numbers, must meet in one point: throws InternalError otherwise.
  VertexId add_on_planes(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  // The same where it is known to be a point on planes of another store, by the same equations.
  VertexId add_on_planes(std::uint32_t a, std::uint32_t b, std::uint32_t c, const PointStore& from,
                         VertexId same);
  VertexId add(const PointDefinition& implicit_point);
  // Appends the first `count` points of another store to an empty one; they are explicit or on
  // planes. Supports are left out.
  void copy_corners(const PointStore& from, std::size_t count);
  // Moves an explicit point that has no supports and is not a corner of others.
  void move_explicit(VertexId v, const Vec3& x);
  // Removes the last point.
  void pop_back();
  // Removes the points from `first` on, the last one first.
  void truncate(std::size_t first) {
    while (size() > first) pop_back();
  }

  // Sorted, without repetition. Replaces earlier supports of v.
  void set_supports(VertexId v, std::span<const PlaneId> planes,
                    std::span<const std::uint32_t> lines);
  std::span<const PlaneId> planes(VertexId v) const;
  std::span<const std::uint32_t> lines(VertexId v) const;

  std::size_t size() const { return approximations_.size(); }
  void reserve(std::size_t n);
  const Approximation& approximation(VertexId v) const { return approximations_[v]; }
  void prefetch(VertexId v) const { __builtin_prefetch(&approximations_[v]); }
  Vec3 nearest(VertexId v) const {
    const Approximation& a = approximations_[v];
    return {a.x, a.y, a.z};
  }
  PointDefinition definition(VertexId v) const;
  bool is_explicit(VertexId v) const {
    const std::uint32_t detail = detail_of_[v];
    return detail == kNone || details_[detail].definition.kind == PointKind::explicit_point;
  }

  // May it be a corner of on-segment and on-triangle points?
  bool is_corner(VertexId v) const {
    return is_explicit(v) || definition(v).kind == PointKind::on_planes;
  }

  // The nearest doubles of the remainder beyond approximation(), with the error that is left: the
  // sum of both is a double-double approximation. Zero for explicit points.
  Approximation remainder(VertexId v) const;
  // b - a. Where the points are known to few digits compared with their distance, with the digits
  // of their remainders.
  Vec3 difference(VertexId a, VertexId b) const;
  void exact(VertexId v, ExactPosition& out) const;

 private:
  // A definition, exact coordinates and supports, which plain volume points do not have. Kept
  // apart, so that a point in the volume costs 36 bytes.
  struct Detail {
    PointDefinition definition{PointKind::explicit_point, {kNone, kNone, kNone}, 0, 0};
    Approximation remainder{0, 0, 0, 0};
    std::size_t first_limb = 0;
    std::size_t first_support = 0;
    std::array<std::int32_t, 3> size{};  // of the three mantissas, in limbs, signed
    std::array<std::int32_t, 3> exponent{};
    std::int32_t denominator = 0;  // limbs; 0 for a denominator of 1
    std::uint32_t planes = 0;
    std::uint32_t lines = 0;
  };

  Detail& detail(VertexId v);
  VertexId add_implicit(const PointDefinition& definition);
  void append(const PointDefinition& definition, const RationalPoint& exact);
  void put(const Approximation& approximation, const Detail& d);
  // The limbs of details are stored in the order of the points, x before y before z before the
  // denominator.
  static std::size_t limb_count(const Detail& d);

  GrowingArray<Approximation> approximations_;
  GrowingArray<std::uint32_t> detail_of_;  // index into details_, or kNone
  GrowingArray<Detail> details_;
  GrowingArray<Word> limbs_;
  GrowingArray<std::uint32_t> supports_;  // per detail: planes, then lines
  std::vector<PlaneEquation> equations_;
};

}  // namespace delmesher::predicates
