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

#include "mesher/arithmetic/words.h"
#include "mesher/base/growing_array.h"
#include "mesher/base/ids.h"

namespace delmesher::predicates {

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

  std::array<ExactCoordinate, 3> coordinate;
  std::array<Word, 3> own;
};

// Of an explicit point.
void set_exact(const Vec3& x, ExactPosition& out);

// Append-only list of points with cached exact and approximate coordinates and "supports": ids of
// planes and lines known to contain the point. A support shared by all arguments of a predicate
// proves that its determinant is zero; no shared support proves nothing.
class PointStore {
 public:
  VertexId add_explicit(double x, double y, double z);
  // p, q, r must be explicit points of this store.
  VertexId add_on_segment(VertexId p, VertexId q, double t);
  VertexId add_on_triangle(VertexId p, VertexId q, VertexId r, double u, double v);
  VertexId add(const PointDefinition& implicit_point);
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

  // The nearest doubles of what approximation() leaves over, with the error that remains: the sum
  // of both is a double-double approximation. Zero for explicit points.
  Approximation remainder(VertexId v) const;
  // b - a. Where the points are known to few digits compared with their distance, with the digits
  // that the nearest doubles leave over.
  Vec3 difference(VertexId a, VertexId b) const;
  void exact(VertexId v, ExactPosition& out) const;

 private:
  // What plain volume points do not have: a definition, exact coordinates, supports. Kept apart, so
  // that a point in the volume costs 36 bytes.
  struct Detail {
    PointDefinition definition{PointKind::explicit_point, {kNone, kNone, kNone}, 0, 0};
    Approximation remainder{0, 0, 0, 0};
    std::size_t first_limb = 0;
    std::size_t first_support = 0;
    std::array<std::int32_t, 3> size{};  // of the three mantissas, in limbs, signed
    std::array<std::int32_t, 3> exponent{};
    std::uint32_t planes = 0;
    std::uint32_t lines = 0;
  };

  Detail& detail(VertexId v);
  VertexId add_implicit(const PointDefinition& definition);
  // The limbs of details are stored in the order of the points, x before y before z.
  static std::size_t limb_count(const Detail& d);

  GrowingArray<Approximation> approximations_;
  GrowingArray<std::uint32_t> detail_of_;  // index into details_, or kNone
  GrowingArray<Detail> details_;
  GrowingArray<Word> limbs_;
  GrowingArray<std::uint32_t> supports_;  // per detail: planes, then lines
};

}  // namespace delmesher::predicates
