// Exact answers about the solid: the parity along a vertical ray, and whether the surface enters a
// tetrahedron.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {
namespace {

// The centroid of some points. The direction from a vertex to it is scaled by the number of points:
// it is their sum minus that many times the vertex.
class Centroid {
 public:
  Centroid(const ExactPoints& points, std::span<const Index> corners)
      : points_(points), corners_(corners) {
    for (const Index v : corners) {
      for (int axis = 0; axis < 3; ++axis) nearest_[axis] += points.nearest(v)[axis];
    }
    for (double& x : nearest_) x /= static_cast<double>(corners.size());
    // Each of up to four points is within difference_error of its nearest doubles, and all
    // roundings of the sum and the quotient are within eight of the largest coordinate.
    error_ = points.difference_error() + points.largest_coordinate() * 0x1p-50;
  }

  // The side of a -> b, seen from above, on which the centroid lies, or 0 where doubles do not
  // tell. The value is a determinant of two differences: its errors are those of each difference
  // times the other one, and that of rounding. All bounds are taken twice or more.
  int rough_side_above(Index a, Index b) const {
    const Position &p = points_.nearest(a), &q = points_.nearest(b);
    const double u = q[0] - p[0], v = q[1] - p[1];
    const double x = nearest_[0] - p[0], y = nearest_[1] - p[1];
    const double along = std::fabs(u) + std::fabs(v), off = std::fabs(x) + std::fabs(y);
    const double along_error = along * 0x1p-53 + points_.difference_error();
    const double off_error = off * 0x1p-53 + points_.difference_error() + error_;
    const double error =
        2 * (along * (off_error + off * 0x1p-50) + off * along_error + along_error * off_error) +
        0x1p-1000;
    const double value = u * y - v * x;
    return value > error ? 1 : value < -error ? -1 : 0;
  }

  IntervalVector rough_from(Index vertex) const {
    IntervalVector sum;
    for (const Index v : corners_) {
      const IntervalVector u = points_.rough_difference(vertex, v);
      for (int axis = 0; axis < 3; ++axis) sum[axis] = sum[axis] + u[axis];
    }
    return sum;
  }

  ExactVector from(Index vertex) const {
    ExactVector result;
    for (const Index v : corners_) {
      const ExactVector x = points_.exact(v);
      for (std::size_t axis = 0; axis < 3; ++axis) result[axis] += x[axis];
    }
    const ExactNumber count(static_cast<long>(corners_.size()));
    const ExactVector x = points_.exact(vertex);
    for (std::size_t axis = 0; axis < 3; ++axis) result[axis] -= x[axis] * count;
    return result;
  }

  // Encloses the centroid itself.
  IntervalVector position() const {
    const double inverse = 1 / static_cast<double>(corners_.size());
    const Interval factor = Interval::around(inverse, inverse);
    IntervalVector sum;
    for (const Index v : corners_) {
      const IntervalVector p = points_.enclosure(v);
      for (int axis = 0; axis < 3; ++axis) sum[axis] = sum[axis] + p[axis];
    }
    return {sum[0] * factor, sum[1] * factor, sum[2] * factor};
  }

 private:
  const ExactPoints& points_;
  std::span<const Index> corners_;
  Position nearest_ = {};
  double error_ = 0;
};

// The side of a -> b, seen from above, on which the centroid lies after moving it by (e, e^2) for
// an infinitesimal e: never 0 unless a and b have the same projection.
int side_above(const ExactPoints& points, Index a, Index b, const Centroid& q) {
  if (const int side = q.rough_side_above(a, b); side != 0) return side;
  const IntervalVector along = points.rough_difference(a, b), w = q.rough_from(a);
  const int rough = (along[0] * w[1] - along[1] * w[0]).sign();
  if (rough != 2 && rough != 0) return rough;
  const ExactVector u = exact::difference(points, a, b), v = q.from(a);
  if (const int sign = sgn(ExactNumber(u[0] * v[1] - u[1] * v[0])); sign != 0) return sign;
  return u[1] != 0 ? -sgn(u[1]) : sgn(u[0]);
}

// Sign of the height of the centroid over the plane of a triangle along its normal.
int side_of_plane(const ExactPoints& points, const std::array<Index, 3>& t, const Centroid& q) {
  const IntervalVector n = exact::rough_area2(points, t[0], t[1], t[2]);
  const IntervalVector w = q.rough_from(t[0]);
  const int rough = (n[0] * w[0] + n[1] * w[1] + n[2] * w[2]).sign();
  if (rough != 2) return rough;
  return sgn(exact::dot(exact::area2(points, t[0], t[1], t[2]), q.from(t[0])));
}

// Are all corners certainly higher than that?
bool is_above(const ExactPoints& points, const std::array<Index, 3>& triangle, double height) {
  return std::all_of(triangle.begin(), triangle.end(),
                     [&](Index v) { return points.enclosure(v)[2].low > height; });
}

// A cheap proof that the triangle enters: a point of it that is strictly inside the tetrahedron.
// Doubles look for one by clipping the triangle; a sum of the triangle's corners with shares that
// are not negative is one, up to a common factor, if intervals say so for each face.
bool surely_meets(const ExactPoints& points, const std::array<Index, 3>& triangle,
                  const std::array<Index, 4>& tetrahedron) {
  struct Corner {
    Position shares;
    std::array<double, 4> sides;
  };
  std::array<std::array<Interval, 4>, 3> rough;
  // Each face adds at most half as many corners as there are, even where rounding makes a polygon
  // that is not convex: 3, 4, 6, 9 and 13 are the most.
  std::array<Corner, 13> polygon{}, cut{};
  std::size_t size = 3;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t face = 0; face < 4; ++face) {
      std::array<Index, 4> replaced = tetrahedron;
      replaced[face] = triangle[corner];
      rough[corner][face] = exact::quick_volume6(points, replaced);
      polygon[corner].sides[face] = rough[corner][face].middle();
    }
    polygon[corner].shares[corner] = 1;
  }
  for (std::size_t face = 0; face < 4; ++face) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const Corner &a = polygon[i], &b = polygon[(i + 1) % size];
      const double at_a = a.sides[face], at_b = b.sides[face];
      if (at_a >= 0) cut[count++] = a;
      if (!(at_a * at_b < 0)) continue;
      const double share = at_a / (at_a - at_b);
      Corner& between = cut[count++];
      for (std::size_t j = 0; j < 3; ++j) {
        between.shares[j] = a.shares[j] * (1 - share) + b.shares[j] * share;
      }
      for (std::size_t j = 0; j < 4; ++j) {
        between.sides[j] = a.sides[j] * (1 - share) + b.sides[j] * share;
      }
    }
    polygon.swap(cut);
    size = count;
  }
  Position shares = {};
  for (const Corner& corner : std::span(polygon).first(size)) {
    for (std::size_t j = 0; j < 3; ++j) shares[j] += corner.shares[j];
  }
  if (!(shares[0] >= 0 && shares[1] >= 0 && shares[2] >= 0)) return false;
  for (std::size_t face = 0; face < 4; ++face) {
    const Interval height = Interval(shares[0]) * rough[0][face] +
                            Interval(shares[1]) * rough[1][face] +
                            Interval(shares[2]) * rough[2][face];
    if (height.sign() != 1) return false;
  }
  return true;
}

// Are all corners of the triangle on the outer side of one face, or on it?
bool faces_separate(const ExactPoints& points, const std::array<Index, 3>& triangle,
                    const std::array<Index, 4>& tetrahedron) {
  for (int face = 0; face < 4; ++face) {
    const auto outside = [&](Index v) {
      // A corner of the tetrahedron needs no arithmetic: it lies on this face or is its apex.
      if (v == tetrahedron[face]) return false;
      if (std::find(tetrahedron.begin(), tetrahedron.end(), v) != tetrahedron.end()) return true;
      std::array<Index, 4> replaced = tetrahedron;
      replaced[face] = v;
      return exact::orient3d(points, replaced[0], replaced[1], replaced[2], replaced[3]) <= 0;
    };
    if (std::all_of(triangle.begin(), triangle.end(), outside)) return true;
  }
  return false;
}

// The planes parallel to an edge of the tetrahedron, from p to q, and to a side of the triangle,
// from a to b. Exact only where intervals do not tell.
class ParallelPlanes {
 public:
  ParallelPlanes(const ExactPoints& points, Index p, Index q, Index a, Index b)
      : points_(points),
        defining_{p, q, a, b},
        rough_normal_(exact::cross(points.rough_difference(p, q), points.rough_difference(a, b))) {}

  // The side of the plane through p on which a point lies.
  int side(Index v) {
    const auto& [p, q, a, b] = defining_;
    if (v == p || v == q) return 0;
    const int rough = exact::dot(rough_normal_, points_.rough_difference(p, v)).sign();
    if (rough != 2) return rough;
    if (points_.surely_coplanar(std::array{p, q, a, b, v})) return 0;
    if (!normal_) {
      normal_ = exact::cross(exact::difference(points_, p, q), exact::difference(points_, a, b));
    }
    return sgn(exact::dot(*normal_, exact::difference(points_, p, v)));
  }

 private:
  const ExactPoints& points_;
  std::array<Index, 4> defining_;
  IntervalVector rough_normal_;
  std::optional<ExactVector> normal_;
};

// Does a plane parallel to an edge of the tetrahedron and to a side of the triangle have the two on
// different sides, or touch them?
bool edges_separate(const ExactPoints& points, const std::array<Index, 3>& triangle,
                    const std::array<Index, 4>& tetrahedron) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t k = i == 3 ? (j == 2 ? 1 : 2) : 3, l = 6 - i - j - k;
      for (std::size_t n = 0; n < 3; ++n) {
        const Index a = triangle[n], b = triangle[(n + 1) % 3], c = triangle[(n + 2) % 3];
        ParallelPlanes planes(points, tetrahedron[i], tetrahedron[j], a, b);
        const int first = planes.side(tetrahedron[k]);
        const int second = planes.side(tetrahedron[l]);
        const int side = first != 0 ? first : second;
        if (side == 0 || first * second < 0) continue;
        if (side * planes.side(a) <= 0 && side * planes.side(c) <= 0) return true;
      }
    }
  }
  return false;
}

// Has the plane of the triangle the tetrahedron on one side?
bool triangle_separates(const ExactPoints& points, const std::array<Index, 3>& triangle,
                        const std::array<Index, 4>& tetrahedron) {
  const auto& [a, b, c] = triangle;
  int lowest = 0, highest = 0;
  for (const Index v : tetrahedron) {
    const int side = v == a || v == b || v == c ? 0 : exact::orient3d(points, a, b, c, v);
    lowest = std::min(lowest, side);
    highest = std::max(highest, side);
  }
  return lowest * highest == 0 && lowest != highest;
}

// A cheap proof that the tetrahedron stays out, above all for large triangles: it lies beyond one
// of the triangle's edges. Any direction along which one is wholly beyond the other is a proof. So
// the direction across the edge may be rounded, but not the heights along it.
bool beyond_edge(const ExactPoints& points, const std::array<Index, 3>& triangle,
                 const IntervalVector& rough_normal, const std::array<Index, 4>& tetrahedron) {
  const Position n = {rough_normal[0].middle(), rough_normal[1].middle(), rough_normal[2].middle()};
  for (std::size_t i = 0; i < 3; ++i) {
    const Index a = triangle[i], b = triangle[(i + 1) % 3], c = triangle[(i + 2) % 3];
    const Position &p = points.nearest(a), &q = points.nearest(b);
    const Position u = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
    const Position inwards = {n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2],
                              n[0] * u[1] - n[1] * u[0]};
    const auto height = [&](Index v) {
      const IntervalVector w = points.rough_difference(a, v);
      return w[0] * inwards[0] + w[1] * inwards[1] + w[2] * inwards[2];
    };
    const double at_b = height(b).low, at_c = height(c).low;
    const double low = std::min({0.0, at_b, at_c});
    if (!(low <= at_b && low <= at_c)) continue;  // not a number
    if (std::all_of(tetrahedron.begin(), tetrahedron.end(),
                    [&](Index v) { return height(v).high < low; })) {
      return true;
    }
  }
  return false;
}

// The half-spaces beyond the faces of a tetrahedron. Their normals may be rounded, as long as the
// whole tetrahedron is short of the offset: the roundings of a height, those of the point among
// them, are below 2^-49 of the sum of the sizes of its terms, unless these underflow.
std::array<BoxTree::HalfSpace, 4> beyond_faces(const ExactPoints& points,
                                               const std::array<Index, 4>& tetrahedron) {
  std::array<BoxTree::HalfSpace, 4> result;
  for (std::size_t i = 0; i < 4; ++i) {
    const Position &a = points.nearest(tetrahedron[(i + 1) % 4]),
                   &b = points.nearest(tetrahedron[(i + 2) % 4]),
                   &c = points.nearest(tetrahedron[(i + 3) % 4]),
                   &apex = points.nearest(tetrahedron[i]);
    Position u, v, w;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      u[axis] = b[axis] - a[axis];
      v[axis] = c[axis] - a[axis];
      w[axis] = apex[axis] - a[axis];
    }
    Position normal = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]};
    if (normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2] > 0) {
      for (double& x : normal) x = -x;
    }
    const auto height = [&normal](const Position& p) {
      double sum = 0, size = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double term = normal[axis] * p[axis];
        sum += term;
        size += std::fabs(term);
      }
      return sum + size * 0x1p-49 + 0x1p-1000;
    };
    result[i] = {normal, std::max({height(a), height(b), height(c), height(apex)})};
  }
  return result;
}

// A cheap proof that triangle and tetrahedron have at most one corner in common: a direction along
// which all other corners of one are beyond those of the other. Rosenblatt's perceptron looks for
// it among the differences, in doubles; intervals decide.
bool apart(const ExactPoints& points, const std::array<Index, 3>& triangle,
           const std::array<Index, 4>& tetrahedron) {
  constexpr int kRounds = 30;
  std::array<Position, 12> differences;
  std::array<IntervalVector, 12> exact;
  std::size_t count = 0;
  Position along = {};
  for (const Index v : tetrahedron) {
    for (const Index w : triangle) {
      if (v == w) continue;
      exact[count] = points.rough_difference(v, w);
      Position& u = differences[count++];
      for (int axis = 0; axis < 3; ++axis) u[axis] = exact[count - 1][axis].middle();
      const double norm = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
      for (int axis = 0; axis < 3; ++axis) along[axis] += u[axis] /= norm;
    }
  }
  const auto height = [&along](const auto& u) {
    return along[0] * u[0] + along[1] * u[1] + along[2] * u[2];
  };
  for (int round = 0; round < kRounds; ++round) {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < count; ++i) {
      if (height(differences[i]) < height(differences[worst])) worst = i;
    }
    if (height(differences[worst]) > 0 &&
        std::all_of(exact.begin(), exact.begin() + static_cast<std::ptrdiff_t>(count),
                    [&](const IntervalVector& u) { return height(u).low > 0; })) {
      return true;
    }
    for (int axis = 0; axis < 3; ++axis) along[axis] += differences[worst][axis];
  }
  return false;
}

}  // namespace

BoxTree::Box box_around(const ExactPoints& points, std::span<const Index> corners) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  BoxTree::Box box{{kFar, kFar, kFar}, {-kFar, -kFar, -kFar}};
  for (const Index v : corners) {
    const IntervalVector x = points.enclosure(v);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], x[axis].low);
      box.high[axis] = std::max(box.high[axis], x[axis].high);
    }
  }
  return box;
}

RayCrossings crossings_above(const ExactPoints& points,
                             const std::vector<std::array<Index, 3>>& triangles,
                             const BoxTree& tree, const RayParts& parts,
                             std::span<const Index> corners, Index except) {
  const Centroid q(points, corners);
  const IntervalVector p = q.position();
  const BoxTree::Box around = {{p[0].low, p[1].low, p[2].low}, {p[0].high, p[1].high, p[2].high}};
  const double top = parts.top_around(around);
  if (top < around.low[2]) return {};
  thread_local std::vector<Index> found;  // allocating would take as long as the search
  found.clear();
  tree.query({around.low, {around.high[0], around.high[1], top}}, found);
  RayCrossings crossings;
  for (const Index t : found) {
    if (!parts.is_around(t, around)) continue;
    const auto& [a, b, c] = triangles[t];
    const int s = side_above(points, a, b, q);
    if (t == except || s == 0 || side_above(points, b, c, q) != s ||
        side_above(points, c, a, q) != s) {
      continue;
    }
    int height = -1;
    if (!is_above(points, triangles[t], p[2].high)) {
      height = side_of_plane(points, triangles[t], q) * s;
    }
    if (height == 0) return {.on_triangle = true};
    if (height > 0) continue;
    ++crossings.count;
    crossings.winding += s;
  }
  return crossings;
}

int InputSurface::inside(const ExactPoints& points, std::span<const Index> corners) const {
  const RayCrossings crossings = crossings_above(points, triangles_, *tree_, *parts_, corners);
  return crossings.on_triangle ? -1 : static_cast<int>(crossings.count % 2);
}

// The height is a sum of three products. Each component of the normal is off by at most half the
// width of its interval, each difference by a rounding and what difference_error() says. All bounds
// are taken twice or more.
int InputSurface::rough_side(const ExactPoints& points, const Facet& facet, Index v) {
  const IntervalVector& n = facet.rough_normal;
  const Position &p = points.nearest(facet.span[0]), &q = points.nearest(v);
  double height = 0, error = 0x1p-1000, steepness = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double slope = n[axis].middle(), width = n[axis].high - n[axis].low;
    const double along = q[axis] - p[axis];
    height += slope * along;
    error += (std::fabs(slope) * 0x1p-48 + width) * std::fabs(along);
    steepness += std::fabs(slope) + width;
  }
  error += 2 * steepness * points.difference_error();
  if (height > error) return 1;
  if (height < -error) return -1;
  return 2;
}

// A facet's plane that does not enter the tetrahedron keeps all its triangles out. Only where
// doubles do not tell is the side looked up or decided.
bool InputSurface::plane_enters(const ExactPoints& points, const std::array<Index, 4>& tetrahedron,
                                std::span<const Index> triangles, PlaneSides& known,
                                Contact& contact) const {
  const Index f = facet_of_triangle_[triangles[0]];
  const Facet& facet = facets_[f];
  std::array<int, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) sides[i] = rough_side(points, facet, tetrahedron[i]);
  const auto has = [&](int wanted) {
    return std::find(sides.begin(), sides.end(), wanted) != sides.end();
  };
  for (std::size_t i = 0; i < 4 && !(has(1) && has(-1)); ++i) {
    if (sides[i] != 2) continue;
    const Index v = tetrahedron[i];
    if (std::any_of(triangles.begin(), triangles.end(), [&](Index t) {
          const auto& corners = triangles_[t];
          return v == corners[0] || v == corners[1] || v == corners[2];
        })) {
      sides[i] = 0;
      continue;
    }
    const auto key = static_cast<std::uint64_t>(f) << 32 | v;
    const auto [at, fresh] = known.try_emplace(key, 0);
    if (fresh) at->second = facet.side(points, v);  // a triangle may be flat, a facet is not
    sides[i] = at->second;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    bool off = false;
    for (std::size_t j = 0; j < 4; ++j) off = off || (j != i && sides[j] % 2 != 0);
    if (!off) contact.covered |= static_cast<std::uint8_t>(1U << i);
  }
  return has(1) && has(-1);
}

// The triangle has no point strictly inside exactly if a plane separates it from the tetrahedron.
// Such planes are parallel to a face of one of the two or to an edge of each: those are the
// directions of the faces of all differences of their points.
InputSurface::Contact InputSurface::contact(const ExactPoints& points,
                                            const std::array<Index, 4>& tetrahedron,
                                            const BoxTree& parts, std::span<const Index> triangles,
                                            PlaneSides& known) const {
  thread_local std::vector<Index> found;  // allocating would take as long as the search
  found.clear();
  parts.query(box_around(points, tetrahedron), found,
              [&] { return beyond_faces(points, tetrahedron); });
  if (found.empty()) return {};  // as for most tetrahedra of a refined mesh
  if (!triangles.empty()) {
    for (Index& t : found) t = triangles[t];
  }
  std::sort(found.begin(), found.end(), [this](Index s, Index t) {
    return std::pair(facet_of_triangle_[s], s) < std::pair(facet_of_triangle_[t], t);
  });
  found.erase(std::unique(found.begin(), found.end()), found.end());
  Contact contact;
  for (std::size_t first = 0, last = 0; first < found.size() && !contact.enters; first = last) {
    const Facet& facet = facets_[facet_of_triangle_[found[first]]];
    while (last < found.size() && &facets_[facet_of_triangle_[found[last]]] == &facet) ++last;
    const std::span<const Index> of_facet = std::span(found).subspan(first, last - first);
    if (!plane_enters(points, tetrahedron, of_facet, known, contact)) continue;
    contact.enters = std::any_of(of_facet.begin(), of_facet.end(), [&](Index t) {
      return !beyond_edge(points, triangles_[t], facet.rough_normal, tetrahedron) &&
             !faces_separate(points, triangles_[t], tetrahedron) &&
             (surely_meets(points, triangles_[t], tetrahedron) ||
              (!apart(points, triangles_[t], tetrahedron) &&
               !triangle_separates(points, triangles_[t], tetrahedron) &&
               !edges_separate(points, triangles_[t], tetrahedron)));
    });
  }
  return contact;
}

}  // namespace tetproof::oracles
