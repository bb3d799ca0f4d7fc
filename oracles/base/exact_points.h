// Points with exact coordinates: integers at one common power-of-two scale, over odd denominators
// for points on planes. Of each coordinate two doubles are kept, for the filter: one within an ulp,
// and the rest. The integers are made again from the definition whenever they are needed, because
// intervals nearly always suffice, and all of them take several times the memory of a mesh. Shares
// nothing with the mesher's arithmetic.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/base/exact_number.h"
#include "oracles/base/interval.h"
#include "oracles/base/vector_store.h"

namespace tetproof::oracles {

using Index = std::uint32_t;
inline constexpr Index kNone = 0xffffffffU;

using Position = std::array<double, 3>;
using ExactVector = std::array<ExactNumber, 3>;
using Planes = std::span<const delmesher::ExactRecord::Plane>;
using IntervalVector = std::array<Interval, 3>;

class ExactPoints {
 public:
  // Empty on success, else why the points cannot be represented: a number is not finite, a
  // reference is out of range or to a point on a segment or a triangle, planes do not meet in one
  // point. The object is then empty. A point may lie beyond the ends of its segment or outside its
  // triangle: the oracles say where points have to lie.
  std::string assign(std::span<const delmesher::ExactPoint> points, Planes planes = {});
  // Plain doubles.
  std::string assign(std::span<const Position> positions);

  std::size_t size() const { return nearest_.size(); }
  // Coordinates times 2^-exponent().
  ExactVector exact(Index i) const;
  // Those of a point without denominators, in memory that is there already.
  void integers(Index i, std::array<mpz_class, 3>& x) const;
  // Is it exactly nearest(i)?
  bool is_double(Index i) const { return implicit_[i] == kNone; }
  bool is_integer(Index i) const { return is_double(i) || defined_[implicit_[i]].placed == kNone; }
  // Has no coordinate a denominator?
  bool all_integers() const { return all_integers_; }
  // Is a point given on a segment or a triangle of no other corners than these? Then it is in their
  // plane.
  bool is_combination(Index v, const std::array<Index, 3>& corners) const {
    if (is_double(v)) return false;
    const Defined& p = defined_[implicit_[v]];
    const auto among = [&corners](Index i) {
      return i == corners[0] || i == corners[1] || i == corners[2];
    };
    return among(p.corners[0]) && among(p.corners[1]) &&
           (p.corners[2] == kNone || among(p.corners[2]));
  }
  // The corner of least number of a segment on which both points are by their definitions, one of
  // them given on it; or kNone.
  Index corner_of_segment(Index a, Index b) const;
  // A plane of the record that contains all of these points by their definitions, or kNone: then
  // their being in one plane needs no arithmetic. The plane must be one of at least three of the
  // record's points, which are given on it.
  Index common_plane(std::span<const Index> vertices) const;
  // Are these points in one plane by their definitions? If not, they may be so all the same.
  bool surely_coplanar(std::span<const Index> vertices) const;
  // Is the point on that plane by its definition?
  bool is_defined_on(Index v, Index plane) const;
  // The sign of normal_of(plane) . (v - p) for any p on the plane.
  int side_of(Index plane, Index v) const;
  // Has far smaller numbers than an area vector of points on planes, and another length.
  ExactVector normal_of(Index plane) const;
  long exponent() const { return exponent_; }
  // Encloses the coordinates (in true units); a single point if they are doubles.
  IntervalVector enclosure(Index i) const {
    const Position &p = nearest_[i], &r = rest(i);
    return {around(p[0], r[0]), around(p[1], r[1]), around(p[2], r[2])};
  }
  // Encloses the vector between two points, to about an ulp of itself.
  IntervalVector rough_difference(Index from, Index to) const {
    const Position &p = nearest_[from], &q = nearest_[to], &r = rest(from), &s = rest(to);
    return {gap(p[0], r[0], q[0], s[0]), gap(p[1], r[1], q[1], s[1]), gap(p[2], r[2], q[2], s[2])};
  }
  // The vector between two points in doubles. Each component is off by a rounding of itself and
  // close_error(); where the rest of a point is not known, it is not a number.
  Position close_difference(Index from, Index to) const {
    const Position &p = nearest_[from], &q = nearest_[to];
    if (defined_.empty()) return {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const Position &r = rest(from), &s = rest(to);
    return {close_gap(p[0], r[0], q[0], s[0]).value, close_gap(p[1], r[1], q[1], s[1]).value,
            close_gap(p[2], r[2], q[2], s[2]).value};
  }
  // A rest and the error of a difference are at most an ulp of the largest coordinate, and what
  // becomes of them is right to 2^-49 of that (see gap).
  double close_error() const { return defined_.empty() ? 0 : largest_coordinate_ * 0x1p-98; }
  // A double within an ulp of the coordinates, in true units.
  const Position& nearest(Index i) const { return nearest_[i]; }
  double largest_coordinate() const { return largest_coordinate_; }
  // The largest error of a difference of two such doubles, before that is rounded.
  double difference_error() const { return difference_error_; }

  // normal . x = offset, for coordinates times 2^-exponent().
  struct IntegerPlane {
    std::array<mpz_class, 3> normal;
    mpz_class offset;
  };

 private:
  static Interval around(double x, double rest) {
    return rest == 0 ? Interval(x) : Interval::around(x, x);
  }
  // (q + s) - (p + r). The difference of p and q and its rounding error are exact (Knuth's
  // two-sum). Three roundings follow, each within what margin() allows for the result or for its
  // own terms. The rests are themselves known to 2^-52 of their size.
  struct Gap {
    double value, terms;
  };
  static Gap close_gap(double p, double r, double q, double s) {
    const double d = q - p, back = d - q;
    const double error = (q - (d - back)) - (p + back);
    return {d + (error + (s - r)), std::fabs(r) + std::fabs(s) + std::fabs(error)};
  }
  static Interval gap(double p, double r, double q, double s) {
    if (r == 0 && s == 0) return Interval::around(q - p, q - p);
    const auto [x, terms] = close_gap(p, r, q, s);
    const double slack = Interval::margin(x) + terms * 0x1p-49;
    return {x - slack, x + slack};
  }

  // A point that is not explicit.
  struct Defined {
    Position rest;
    // On a segment or a triangle of these, by these shares; the last is kNone on a segment, and all
    // are on planes.
    std::array<Index, 3> corners = {kNone, kNone, kNone};
    // Coordinates with denominators: where in placed_ they are.
    Index placed = kNone;
    double u = 0, v = 0;
  };

  const Position& rest(Index i) const {
    static constexpr Position kExact = {0, 0, 0};
    return is_double(i) ? kExact : defined_[implicit_[i]].rest;
  }
  std::string place_on_planes(std::span<const delmesher::ExactPoint> points, Planes planes);
  void keep_planes(std::span<const delmesher::ExactPoint> points, std::size_t planes,
                   const std::function<IntegerPlane(std::size_t)>& plane);
  // The corners by which a point is given; itself if it is one.
  std::span<const Index> corners_of(const Index& v) const;
  // By the corners of the points that have them.
  using Denominators = std::map<std::array<Index, 3>, ExactNumber::Denominator>;
  void define(Index i, const delmesher::ExactPoint& p, Denominators& known);
  // From their corners, which are defined.
  void combine_integers(const Defined& point, std::array<mpz_class, 3>& x) const;
  void place_combined(Defined& point, Denominators& known);

  std::vector<Position> nearest_;
  std::vector<Index> implicit_;  // per point: where in defined_ it is, kNone if it is explicit
  std::vector<Defined> defined_;
  VectorStore placed_;  // those on planes first
  std::vector<IntegerPlane> planes_;
  std::vector<std::array<Index, 3>> planes_of_;  // of points on planes; kNone: of too few points
  bool all_integers_ = true;
  long exponent_ = 0;
  double largest_coordinate_ = 0, difference_error_ = 0;
};

// The positions as explicit points of a record.
std::vector<delmesher::ExactPoint> explicit_points(std::span<const Position> positions);

// value * 2^exponent as a double, rounded towards zero, to an ulp.
double to_double(const ExactNumber& value, long exponent);
// The length of a vector, times 2^exponent.
double length(const ExactVector& vector, long exponent);

// Exact signs and measures. Intervals decide first, except where the value itself is wanted. Exact
// values are in integer units, 2^-exponent() to the unit of length, which no sign or comparison
// sees.
namespace exact {

// Sign of det(b - a, c - a, d - a): positive for the orientation that files are written in.
int orient3d(const ExactPoints& points, Index a, Index b, Index c, Index d);
// The determinant itself: six times the volume.
ExactNumber volume6(const ExactPoints& points, Index a, Index b, Index c, Index d);
// An enclosure of it, in true units.
Interval rough_volume6(const ExactPoints& points, const std::array<Index, 4>& tetrahedron);
// The same far less narrowly, in a fraction of the time: by rounded values and one bound on their
// error.
Interval quick_volume6(const ExactPoints& points, const std::array<Index, 4>& tetrahedron);
// The same for many tetrahedra, without allocating again for each.
class Volume6 {
 public:
  const ExactNumber& operator()(const ExactPoints& points, const std::array<Index, 4>& tetrahedron);
  // For the tetrahedron between the origin and a triangle: positive if the triangle is seen
  // clockwise from the origin.
  const ExactNumber& from_origin(const ExactPoints& points, const std::array<Index, 3>& triangle);

 private:
  const ExactNumber& determinant();

  std::array<std::array<mpz_class, 3>, 3> rows_;
  std::array<mpz_class, 3> origin_;
  mpz_class minor_, sum_;
  ExactNumber value_;
};
// Positive if e lies strictly inside the sphere through a, b, c, d, where orient3d(a, b, c, d) > 0.
int insphere(const ExactPoints& points, Index a, Index b, Index c, Index d, Index e);
// Sign of (p - apex) . (q - apex); negative exactly if the apex lies strictly inside the ball with
// diameter pq.
int dot_sign(const ExactPoints& points, Index apex, Index p, Index q);
// Sign of (b - a) . (q - p).
int dot_sign(const ExactPoints& points, Index a, Index b, Index p, Index q);
// Does d lie strictly inside the smallest sphere through a, b, c?
bool in_diametral_ball(const ExactPoints& points, Index a, Index b, Index c, Index d);
// (b - a) x (c - a): twice the area vector.
ExactVector area2(const ExactPoints& points, Index a, Index b, Index c);
// Encloses it, in squares of the unit of length.
IntervalVector rough_area2(const ExactPoints& points, Index a, Index b, Index c);
ExactVector difference(const ExactPoints& points, Index from, Index to);
ExactNumber dot(const ExactVector& u, const ExactVector& v);
inline Interval dot(const IntervalVector& u, const IntervalVector& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}
ExactVector cross(const ExactVector& u, const ExactVector& v);
inline IntervalVector cross(const IntervalVector& u, const IntervalVector& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}
bool is_zero(const ExactVector& v);
bool equal(const ExactPoints& points, Index a, Index b);
// In units of length, right to a few roundings, however far from the origin both are.
double distance(const ExactPoints& points, Index a, Index b);
ExactNumber squared(const ExactVector& v);
// Are a, b, c on one line?
bool collinear(const ExactPoints& points, Index a, Index b, Index c);

}  // namespace exact
}  // namespace tetproof::oracles
