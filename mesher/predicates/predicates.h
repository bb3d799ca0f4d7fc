// Exact geometric predicates on any mix of points: explicit, on a segment, on a triangle, on
// planes.
//
// Stages: (1) one semi-static double filter on nearest doubles for all mixes of kinds, (2) shared
// supports prove zero, (3) a double-double or expansion stage, (4) exact integers at a common
// scale. Every stage is separately callable (predicates/stages.h) and counted. Signs are -1, 0, +1.
// Valid for all finite coordinates: overflow and underflow are detected and fall through to the
// exact stage.
#pragma once

#include <cstdint>

#include "mesher/base/ids.h"
#include "mesher/predicates/filter.h"
#include "mesher/predicates/points.h"

namespace delmesher::predicates {

struct PredicateCounters {
  std::uint64_t filter = 0;    // decided by the double filter
  std::uint64_t support = 0;   // zero proved by a shared plane or line
  std::uint64_t extended = 0;  // decided by the extended-precision stage
  std::uint64_t fixed = 0;     // decided by integers of a few words
  std::uint64_t exact = 0;     // decided by integers of any size
  std::uint64_t symbolic = 0;  // ties broken by symbolic perturbation

  PredicateCounters& operator+=(const PredicateCounters& other) {
    filter += other.filter;
    support += other.support;
    extended += other.extended;
    fixed += other.fixed;
    exact += other.exact;
    symbolic += other.symbolic;
    return *this;
  }

  // Signs that were asked for.
  std::uint64_t decided() const { return filter + support + extended + fixed + exact; }
};

// One object per thread: it owns scratch memory and counters. The points must outlive it; points
// may be added to the store at any time.
class Predicates {
 public:
  explicit Predicates(const PointStore& points) : points_(points) {}

  const PointStore& points() const { return points_; }

  // Sign of det(b - a, c - a, d - a): +1 if d lies on the side of plane abc to which the normal
  // (b - a) x (c - a) points. Laws: exchanging two arguments inverts the sign; 0 iff coplanar.
  int orient3d(VertexId a, VertexId b, VertexId c, VertexId d) {
    const int s = filters::orient3d(points_.approximation(a), points_.approximation(b),
                                    points_.approximation(c), points_.approximation(d));
    if (s == 0) return orient3d_unfiltered(a, b, c, d);
    ++counters.filter;
    return s;
  }

  // Sign of the area of triangle abc projected along coordinate axis 0, 1 or 2 (onto yz, zx, xy):
  // the component `axis` of (b - a) x (c - a).
  int orient2d(int axis, VertexId a, VertexId b, VertexId c);

  // For orient3d(a, b, c, d) > 0: +1 if e is strictly inside the circumsphere of abcd, 0 on it. For
  // a negative tetrahedron the sign is inverted. Antisymmetric in all five arguments.
  int insphere(VertexId a, VertexId b, VertexId c, VertexId d, VertexId e) {
    const int s = filters::insphere(points_.approximation(a), points_.approximation(b),
                                    points_.approximation(c), points_.approximation(d),
                                    points_.approximation(e));
    if (s == 0) return insphere_unfiltered(a, b, c, d, e);
    ++counters.filter;
    return s;
  }

  // insphere with ties broken by perturbing the lifted heights |p|^2 + eps^(rank), where the point
  // with the smaller id has the dominant perturbation (raised, so it tends to be outside). Never 0
  // unless all five points are coplanar; then, too, consistent. Antisymmetric in all five
  // arguments.
  int insphere_perturbed(VertexId a, VertexId b, VertexId c, VertexId d, VertexId e) {
    const int s = insphere(a, b, c, d, e);
    return s != 0 ? s : perturbed_sign(a, b, c, d, e);
  }

  // Sign of (p - q) . (r - q): +1 if the angle at q is acute. dot_sign(a, p, b) < 0 iff p is in the
  // open diametral ball of segment ab.
  int dot_sign(VertexId p, VertexId q, VertexId r) {
    const int s =
        filters::dot(points_.approximation(p), points_.approximation(q), points_.approximation(r));
    if (s == 0) return dot_sign_unfiltered(p, q, r);
    ++counters.filter;
    return s;
  }
  // Sign of (b - a) . (d - c).
  int dot_difference_sign(VertexId a, VertexId b, VertexId c, VertexId d);

  // +1 if p is strictly inside the smallest ball with a, b, c on its sphere (the triangle's
  // diametral ball), 0 on the sphere, -1 outside. abc must not be collinear.
  int in_diametral_ball(VertexId a, VertexId b, VertexId c, VertexId p);

  // Sign of [(b - d) x (c - d)] . [(a - d) x (c - d)]: +1 if the dihedral angle of triangles acd
  // and bcd at edge cd is acute (appendix A.2).
  int dihedral_sign(VertexId a, VertexId b, VertexId c, VertexId d);

  // Sign of the difference a - b of a coordinate.
  int compare_coordinate(int axis, VertexId a, VertexId b);
  // Lexicographic order of coordinates; 0 iff the points coincide.
  int compare_xyz(VertexId a, VertexId b);

  // Is the angle p q r (at q) strictly below the angle in [0, 90] whose squared cosine is given?
  bool angle_below(VertexId p, VertexId q, VertexId r, double cosine_squared);
  // Same for the dihedral angle of triangles acd and bcd at edge cd.
  bool dihedral_below(VertexId a, VertexId b, VertexId c, VertexId d, double cosine_squared);
  // Same for the angle by which acd and bcd bend at edge cd: 0 if they continue each other.
  bool bends_below(VertexId a, VertexId b, VertexId c, VertexId d, double cosine_squared);
  // Same for the angle between the ray from a towards q and the plane of abc (its projection). Does
  // not ask where the projection falls.
  bool edge_plane_angle_below(VertexId q, VertexId a, VertexId b, VertexId c,
                              double cosine_squared);

  PredicateCounters counters;

 private:
  // Filter, extended and exact stage of a polynomial of predicates/polynomials.h.
  template <class Polynomial>
  int sign(const Polynomial& polynomial, const VertexId* ids);
  template <class Polynomial>
  int sign_unfiltered(const Polynomial& polynomial, const VertexId* ids);

  int perturbed_sign(VertexId a, VertexId b, VertexId c, VertexId d, VertexId e);
  int orient3d_unfiltered(VertexId a, VertexId b, VertexId c, VertexId d);
  int dot_sign_unfiltered(VertexId p, VertexId q, VertexId r);
  int insphere_unfiltered(VertexId a, VertexId b, VertexId c, VertexId d, VertexId e);

  const PointStore& points_;
};

// Squared cosine of an angle given in degrees, in [0, 90], by a fixed sequence of IEEE operations:
// the same double in every build (libm differs between builds). Exact for 0, 30, 45, 60 and 90.
double cosine_squared(double degrees);

}  // namespace delmesher::predicates
