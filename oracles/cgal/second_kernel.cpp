#include "oracles/cgal/second_kernel.h"

#include <CGAL/Homogeneous.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <boost/variant/get.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <type_traits>
#include <unordered_map>
#include <variant>
#include <vector>

#include "oracles/cgal/record_text.h"
#include "oracles/cgal/residue.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;
using Rough = CGAL::Simple_cartesian<CGAL::Interval_nt<false>>;

using Whole = CGAL::Simple_cartesian<Number>;
using Fractions = CGAL::Homogeneous<Number>;

// All questions need ring operations only, and CGAL's exact floating-point numbers have them. Where
// points are on three planes, coordinates are homogeneous: fractions would be reduced again and
// again, which takes most of the time of a verification.
template <class K>
class Point {
 public:
  Rough::Point_3 rough = CGAL::ORIGIN;

  Point() = default;
  explicit Point(const typename K::Point_3& p) : rough(enclosure(p)), exact_(p) {}

  const typename K::Point_3& exact() const { return exact_; }

 private:
  static Rough::Point_3 enclosure(const typename K::Point_3& p) {
    return {enclosure(p.hx(), p.hw()), enclosure(p.hy(), p.hw()), enclosure(p.hz(), p.hw())};
  }
  // An enclosure of x / w. CGAL's own enclosures of these numbers are zero where doubles underflow.
  static CGAL::Interval_nt<false> enclosure(const Number& x, const Number& w) {
    if (CGAL::is_zero(x)) return 0;
    const auto [upper, upper_power] = x.to_interval_exp();
    const auto [lower, lower_power] = w.to_interval_exp();
    const CGAL::Protect_FPU_rounding<true> protection;
    const auto ratio = CGAL::Interval_nt<false>(upper) / CGAL::Interval_nt<false>(lower);
    const auto power = static_cast<int>(std::clamp(upper_power - lower_power, -5000L, 5000L));
    const double low = std::ldexp(ratio.inf(), power), high = std::ldexp(ratio.sup(), power);
    if (power > -1000) return {low, high};
    constexpr double kLeast = std::numeric_limits<double>::denorm_min();
    return {low - kLeast, high + kLeast};
  }

  typename K::Point_3 exact_;
};

// A point that few signs need exactly: `make` makes it each time.
template <class Make>
struct RarelyExact {
  Rough::Point_3 rough;
  Make make;

  auto exact() const { return make(); }
};
template <class Make>
RarelyExact(Rough::Point_3, Make) -> RarelyExact<Make>;

template <class K>
typename K::Point_3 place(const Number& x, const Number& y, const Number& z, const Number& w) {
  if constexpr (std::is_same_v<K, Whole>) {
    return {x, y, z};  // w is 1
  } else {
    return {x, y, z, w};
  }
}

// CGAL's intervals need the rounding mode set upwards, and tell when they are not certain.
template <class Predicate, class... Points>
CGAL::Sign decide(const Predicate& predicate, const Points&... points) {
  {
    const CGAL::Protect_FPU_rounding<true> protection;
    const auto rough = predicate(points.rough...);
    if (CGAL::is_certain(rough)) return CGAL::get_certain(rough);
  }
  return CGAL::make_certain(predicate(points.exact()...));
}

template <class A, class B, class C, class D>
CGAL::Sign orientation(const A& a, const B& b, const C& c, const D& d) {
  return decide([](const auto&... p) { return CGAL::orientation(p...); }, a, b, c, d);
}

// The sign of the cosine of the angle between the normal of abc and the direction from p to q.
template <class Corner, class P, class Q>
CGAL::Sign along_normal(const Corner& a, const Corner& b, const Corner& c, const P& p, const Q& q) {
  return decide(
      [](const auto& u, const auto& v, const auto& w, const auto& from, const auto& to) {
        return CGAL::sign(CGAL::cross_product(v - u, w - u) * (to - from));
      },
      a, b, c, p, q);
}

// The sign of the cosine of the angle between the normals of abc and pqr.
template <class Corner, class P, class Q, class R>
CGAL::Sign between_normals(const Corner& a, const Corner& b, const Corner& c, const P& p,
                           const Q& q, const R& r) {
  return decide(
      [](const auto& u, const auto& v, const auto& w, const auto& x, const auto& y, const auto& z) {
        return CGAL::sign(CGAL::cross_product(v - u, w - u) * CGAL::cross_product(y - x, z - x));
      },
      a, b, c, p, q, r);
}

// 2^exponent, beyond the range of doubles as well.
Number power_of_two(long exponent) {
  constexpr long kStep = 900;
  Number result(1);
  for (; exponent > kStep; exponent -= kStep) result *= Number(std::ldexp(1.0, kStep));
  for (; exponent < -kStep; exponent += kStep) result *= Number(std::ldexp(1.0, -kStep));
  return result * Number(std::ldexp(1.0, static_cast<int>(exponent)));
}

Number from_integer(const mpz_class& value) {
  return Number(CGAL::Gmpz(value.get_mpz_t()));
}

template <class K>
class SecondKernel {
  using Point = oracles::Point<K>;
  using Vector = typename K::Vector_3;
  using Place = typename K::Point_3;

 public:
  // The facets are those of the surface of the final mesh.
  SecondKernel(const Polyhedron& input, const InputSurface& surface, const ExactRecord& record,
               const std::vector<ExactRecord::Facet>& facets, const ExactPoints& points,
               Definitions definitions)
      : input_(input),
        triangles_(surface.triangles()),
        record_(record),
        facets_(facets),
        points_(points),
        definitions_(std::move(definitions)) {}

  OracleReport run() {
    for (std::size_t v = 0; v < input_.vertices.size(); ++v) {
      input_places_.push_back(place_of(static_cast<Index>(v)));
    }
    compare_points();
    for (std::size_t v = 0; v < input_.vertices.size(); ++v) {
      const Position& p = input_.vertices[v];
      const ExactPoint& own = definitions_.points[v];
      const bool moved = own.kind == ExactPoint::Kind::on_planes;
      const bool given = own.kind == ExactPoint::Kind::explicit_point && own.x == p[0] &&
                         own.y == p[1] && own.z == p[2];
      if (!moved && !given) {
        report_.fail("point " + std::to_string(v) + " is not the input's vertex");
      }
      corners_.push_back(moved ? expand(static_cast<Index>(v))
                               : Point(given ? input_places_[v] : place(p)));
    }
    check_tetrahedra();
    check_faces();
    check_volumes();
    return std::move(report_);
  }

 private:
  static std::size_t step(std::size_t elements, std::size_t most) {
    return elements <= most ? 1 : elements / std::max<std::size_t>(1, most);
  }

  static Place place(const std::array<double, 3>& x) {
    return {Number(x[0]), Number(x[1]), Number(x[2])};
  }
  // Nearly every point is given by input vertices: meeting points of planes are found once.
  Place corner(Index v) const { return v < input_places_.size() ? input_places_[v] : place_of(v); }
  Place place_of(Index v) const {
    const ExactPoint& p = definitions_.points[v];
    if (p.kind == ExactPoint::Kind::explicit_point) return place({p.x, p.y, p.z});
    if constexpr (std::is_same_v<K, Fractions>) {
      const auto plane = [&](Index n) -> typename K::Plane_3 {
        const ExactRecord::Plane& e = definitions_.planes[n];
        if (e.spanned) return {place(e.through[0]), place(e.through[1]), place(e.through[2])};
        return {place(e.through[0]), Vector(CGAL::ORIGIN, place(e.normal))};
      };
      const auto meeting = CGAL::intersection(plane(p.i), plane(p.j), plane(p.k));
      if (meeting) {
        if (const Place* found = point_in(*meeting)) return with_positive_weight(*found);
      }
    }
    return {Number(0), Number(0), Number(0)};  // other than the oracles' point
  }
  // The variants of CGAL 6 are those of the language, before they were Boost's.
  template <class... Kinds>
  static const Place* point_in(const std::variant<Kinds...>& meeting) {
    return std::get_if<Place>(&meeting);
  }
  template <class Variant>
  static const Place* point_in(const Variant& meeting) {
    return boost::get<Place>(&meeting);
  }
  // Signs of homogeneous polynomials are those of the points only so.
  static Place with_positive_weight(const Place& p) {
    if (CGAL::sign(p.hw()) != CGAL::NEGATIVE) return p;
    return oracles::place<K>(-p.hx(), -p.hy(), -p.hz(), -p.hw());
  }
  // The points that were asked for last, each in the slot that its number names: tetrahedra and
  // faces that follow each other have most of their corners in common.
  const Point& expand(Index v) {
    constexpr std::size_t kMost = 4096;
    if (recent_.empty()) {
      recent_.assign(std::min(kMost, definitions_.points.size()), {kNone, Point()});
    }
    auto& [number, point] = recent_[v % recent_.size()];
    if (number != v) {
      point = place_exactly(v);
      number = v;
    }
    return point;
  }
  // The enclosure that the comparison of points has found, if that is kept; exactly only when
  // asked, as few signs need it.
  struct Lazily {
    Rough::Point_3 rough;
    SecondKernel* kernel;
    Index vertex;

    Place exact() const { return kernel->expand(vertex).exact(); }
  };
  Lazily lazily(Index v) { return {rough_.empty() ? expand(v).rough : rough_[v], this, v}; }

  Point place_exactly(Index v) {
    const ExactPoint& p = definitions_.points[v];
    if (p.kind == ExactPoint::Kind::explicit_point || p.kind == ExactPoint::Kind::on_planes) {
      return Point(corner(v));
    }
    const bool triangle = p.kind == ExactPoint::Kind::on_triangle;
    const Corners& at = of_equal_weight({p.i, triangle ? p.j : kNone, triangle ? p.k : p.j});
    const Number first(p.x), second(triangle ? p.y : 0);
    const auto sum = [&](std::size_t axis) {
      const Number ends = at.places[2][axis] + at.places[0][axis] * first;
      return triangle ? ends + at.places[1][axis] * second : ends;
    };
    return Point(oracles::place<K>(sum(0), sum(1), sum(2), at.weight));
  }

  // The corners of a triangle or, without the second one, of a segment, relative to the last one;
  // their homogeneous coordinates are multiplied so that they have one weight. A point given on
  // them is a sum of products with short numbers then, and most have their corners in common with
  // others.
  struct Corners {
    std::array<Index, 3> vertices = {kNone, kNone, kNone};
    std::array<std::array<Number, 3>, 3> places;
    Number weight;
  };
  const Corners& of_equal_weight(const std::array<Index, 3>& vertices) {
    constexpr std::size_t kMost = 1024;
    if (recent_corners_.empty()) {
      recent_corners_.resize(std::min(kMost, definitions_.points.size()));
    }
    const auto& [i, j, k] = vertices;
    Corners& slot =
        recent_corners_[(i + 31 * std::size_t{j} + 1009 * std::size_t{k}) % recent_corners_.size()];
    if (slot.vertices == vertices) return slot;
    slot = {.vertices = vertices, .places = {}, .weight = Number(1)};
    for (std::size_t n = 0; n < 3; ++n) {
      if (vertices[n] == kNone) continue;
      const Place p = corner(vertices[n]);
      for (std::size_t m = 0; m < n; ++m) {
        for (Number& x : slot.places[m]) x = x * p.hw();
      }
      slot.places[n] = {p.hx() * slot.weight, p.hy() * slot.weight, p.hz() * slot.weight};
      slot.weight = slot.weight * p.hw();
    }
    for (std::size_t n = 0; n < 2; ++n) {
      if (vertices[n] == kNone) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        slot.places[n][axis] = slot.places[n][axis] - slot.places[2][axis];
      }
    }
    return slot;
  }

  // The sum of points times shares that add up to 1.
  template <std::size_t N>
  static Place combined(const std::array<Place, N>& points, const std::array<Number, N>& shares) {
    const Place& first = points[0];
    Number x = first.hx() * shares[0], y = first.hy() * shares[0], z = first.hz() * shares[0];
    Number w = first.hw();
    for (std::size_t i = 1; i < N; ++i) {
      const Place& p = points[i];
      const Number share = shares[i] * w;
      x = x * p.hw() + p.hx() * share;
      y = y * p.hw() + p.hy() * share;
      z = z * p.hw() + p.hz() * share;
      w = w * p.hw();
    }
    return oracles::place<K>(x, y, z, w);
  }

  void compare_points() {
    constexpr std::size_t kMost = 20000;
    const std::size_t every = step(definitions_.points.size(), kMost);
    const bool all = every == 1, kept = all && (sums_faces() || sums_tetrahedra());
    const Number unit = power_of_two(points_.exponent());
    std::size_t asked = 0;
    for (std::size_t v = 0; v < definitions_.points.size(); v += every, ++asked) {
      const Point& point = expand(static_cast<Index>(v));
      const Place& p = point.exact();
      if (all) rough_.push_back(point.rough);
      if (!is_at(p, points_.exact(static_cast<Index>(v)), unit)) {
        report_.fail("point " + std::to_string(v) + " is elsewhere to CGAL's kernel");
      }
      if (kept) terms_.push_back(terms(p));
    }
    report_.checked += asked;
    report_.figures.emplace_back("points", static_cast<double>(asked));
  }

  // Are these the coordinates of a point, in these units?
  static bool is_at(const Place& p, const ExactVector& x, const Number& unit) {
    const Number scaled = p.hw() * unit;
    const auto is = [&scaled](const Number& own, const ExactNumber& other, const Number& below) {
      return own * below == from_integer(other.numerator()) * scaled;
    };
    if (ExactNumber::uniform(x)) {
      const Number below = from_integer(x[0].denominator());
      return is(p.hx(), x[0], below) && is(p.hy(), x[1], below) && is(p.hz(), x[2], below);
    }
    return is(p.hx(), x[0], from_integer(x[0].denominator())) &&
           is(p.hy(), x[1], from_integer(x[1].denominator())) &&
           is(p.hz(), x[2], from_integer(x[2].denominator()));
  }

  void check_tetrahedra() {
    constexpr std::size_t kMost = 20000, kRays = 1000000;
    const std::size_t rays = std::max<std::size_t>(20, kRays / triangles_.size());
    const std::size_t every = step(record_.final.size(), kMost);
    const std::size_t every_ray = step(record_.final.size(), rays);
    std::size_t asked = 0, cast = 0;
    for (std::size_t t = 0; t < record_.final.size(); ++t) {
      if (t % every != 0 && t % every_ray != 0) continue;
      const ExactRecord::Tet& tet = record_.final[t];
      const std::array<Lazily, 4> p = {lazily(tet.vertices[0]), lazily(tet.vertices[1]),
                                       lazily(tet.vertices[2]), lazily(tet.vertices[3])};
      ++asked;
      if (orientation(p[0], p[1], p[2], p[3]) != CGAL::POSITIVE) {
        report_.fail("tetrahedron " + std::to_string(t) + " is not positive");
      }
      if (t % every_ray != 0) continue;
      ++cast;
      const int side = parity(RarelyExact{rough_centroid(p), [&p] { return centroid(p); }});
      if (side != (tet.inside ? 1 : 0)) {
        report_.fail("tetrahedron " + std::to_string(t) + " is recorded as " +
                     (tet.inside ? "inside" : "outside") + ", and is not");
      }
    }
    report_.checked += asked;
    report_.figures.emplace_back("tetrahedra", static_cast<double>(asked));
    report_.figures.emplace_back("rays", static_cast<double>(cast));
  }

  static Place centroid(const std::array<Lazily, 4>& p) {
    const Number quarter(0.25);
    return combined(std::array{p[0].exact(), p[1].exact(), p[2].exact(), p[3].exact()},
                    std::array{quarter, quarter, quarter, quarter});
  }
  static Rough::Point_3 rough_centroid(const std::array<Lazily, 4>& p) {
    const CGAL::Protect_FPU_rounding<true> protection;
    const auto mean = [&p](int axis) {
      return (p[0].rough[axis] + p[1].rough[axis] + p[2].rough[axis] + p[3].rough[axis]) *
             CGAL::Interval_nt<false>(0.25);
    };
    return {mean(0), mean(1), mean(2)};
  }

  // A direction of rays, and the shadows that the triangles cast along it into the plane z = 0.
  struct Direction {
    using Interval = CGAL::Interval_nt<false>;
    using Shadow = std::array<Interval, 2>;  // a box around it

    explicit Direction(int attempt)
        : x(0.2718281828 + 0.37 * attempt), y(0.5772156649 - 0.11 * attempt) {}
    // Rounding must be set upwards.
    Shadow of(const Rough::Point_3& p) const {
      return {p.x() - Interval(x) * p.z(), p.y() - Interval(y) * p.z()};
    }
    // Another point of the line through a point.
    Rough::Point_3 beyond(const Rough::Point_3& p) const {
      const CGAL::Protect_FPU_rounding<true> protection;
      return {p.x() + Interval(x), p.y() + Interval(y), p.z() + Interval(1)};
    }

    double x, y;
    std::vector<Shadow> shadows;
  };

  const Direction& direction(std::size_t attempt) {
    const CGAL::Protect_FPU_rounding<true> protection;
    while (directions_.size() <= attempt) {
      Direction d(static_cast<int>(directions_.size()));
      for (const auto& [i, j, k] : triangles_) {
        const std::array corners = {d.of(corners_[i].rough), d.of(corners_[j].rough),
                                    d.of(corners_[k].rough)};
        auto& shadow = d.shadows.emplace_back();
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const auto &a = corners[0][axis], &b = corners[1][axis], &c = corners[2][axis];
          shadow[axis] = {std::min({a.inf(), b.inf(), c.inf()}),
                          std::max({a.sup(), b.sup(), c.sup()})};
        }
      }
      directions_.push_back(std::move(d));
    }
    return directions_[attempt];
  }

  // The triangles that a line from the point may meet.
  std::vector<Index> near_line(const Direction& d, const Rough::Point_3& from) const {
    const CGAL::Protect_FPU_rounding<true> protection;
    const auto [x, y] = d.of(from);
    std::vector<Index> found;
    for (Index t = 0; t < d.shadows.size(); ++t) {
      const auto& [u, v] = d.shadows[t];
      const bool beside =
          u.sup() < x.inf() || u.inf() > x.sup() || v.sup() < y.inf() || v.inf() > y.sup();
      if (!beside) found.push_back(t);
    }
    return found;
  }

  // The parity along a ray. Tries rays in several directions until one meets no edge. -1: the point
  // is on the surface, or no ray was found.
  template <class Make>
  int parity(const RarelyExact<Make>& from) {
    for (std::size_t attempt = 0; attempt < 16; ++attempt) {
      const Direction& d = direction(attempt);
      const RarelyExact to{
          d.beyond(from.rough), [&from, &d] {
            return Place(from.exact() + Vector(Number(d.x), Number(d.y), Number(1)));
          }};
      int crossings = 0;
      bool sure = true;
      for (const Index t : near_line(d, from.rough)) {
        const auto& [i, j, k] = triangles_[t];
        const Point &a = corners_[i], &b = corners_[j], &c = corners_[k];
        const CGAL::Sign ab = orientation(from, to, a, b), bc = orientation(from, to, b, c);
        if (ab != CGAL::ZERO && bc != CGAL::ZERO && ab != bc) continue;
        const CGAL::Sign ca = orientation(from, to, c, a);
        if (ab == CGAL::ZERO || bc == CGAL::ZERO || ca == CGAL::ZERO) {
          const bool passes =
              (ab == CGAL::POSITIVE || bc == CGAL::POSITIVE || ca == CGAL::POSITIVE) &&
              (ab == CGAL::NEGATIVE || bc == CGAL::NEGATIVE || ca == CGAL::NEGATIVE);
          if (passes) continue;
          sure = false;
          break;
        }
        if (ca != ab) continue;
        const CGAL::Sign above = orientation(a, b, c, from);
        if (above == CGAL::ZERO) return -1;
        if (above != along_normal(a, b, c, from, to)) ++crossings;
      }
      if (sure) return crossings % 2;
    }
    return -1;
  }

  // What is in a plane or on a line by its definition needs no arithmetic: all others that are need
  // exact numbers to tell.
  bool is_on_line(Index v, Index a, Index b) const {
    const ExactPoint& p = definitions_.points[v];
    return v == a || v == b ||
           (p.kind == ExactPoint::Kind::on_segment && std::minmax(p.i, p.j) == std::minmax(a, b));
  }
  // Are a point and a triangle of the surface given by the corners of that alone, or on one plane?
  bool is_defined_in_plane(Index v, const std::array<Index, 3>& triangle) const {
    const ExactPoint& p = definitions_.points[v];
    std::array<Index, 3> by = {v, v, v};
    if (p.kind == ExactPoint::Kind::on_segment) by = {p.i, p.j, p.j};
    if (p.kind == ExactPoint::Kind::on_triangle) by = {p.i, p.j, p.k};
    const auto is_corner = [&triangle](Index c) {
      return std::find(triangle.begin(), triangle.end(), c) != triangle.end();
    };
    if (std::all_of(by.begin(), by.end(), is_corner)) return true;
    const ExactPoint& first = definitions_.points[triangle[0]];
    if (first.kind != ExactPoint::Kind::on_planes) return false;
    const std::array<Index, 3> planes = {first.i, first.j, first.k};
    return std::any_of(planes.begin(), planes.end(), [&](Index plane) {
      const auto on = [&](Index c) { return is_given_on(c, plane); };
      return std::all_of(by.begin(), by.end(), on) &&
             std::all_of(triangle.begin(), triangle.end(), on);
    });
  }
  bool is_given_on(Index v, Index plane) const {
    const ExactPoint& p = definitions_.points[v];
    return p.kind == ExactPoint::Kind::on_planes && (p.i == plane || p.j == plane || p.k == plane);
  }

  // Is the point certainly outside the box around a triangle?
  static bool is_beside(const Rough::Point_3& p, const std::array<const Point*, 3>& triangle) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = p[axis];
      const auto above = [&](const Point* q) { return q->rough[axis].inf() > x.sup(); };
      const auto below = [&](const Point* q) { return q->rough[axis].sup() < x.inf(); };
      if (std::all_of(triangle.begin(), triangle.end(), above)) return true;
      if (std::all_of(triangle.begin(), triangle.end(), below)) return true;
    }
    return false;
  }

  // Is a point of the facet's plane on one of its triangles?
  bool on_facet(const Lazily& p, const ExactRecord::Facet& facet) const {
    return std::any_of(facet.triangles.begin(), facet.triangles.end(), [&](Index t) {
      const auto& [i, j, k] = triangles_[t];
      const Point &a = corners_[i], &b = corners_[j], &c = corners_[k];
      if (is_beside(p.rough, {&a, &b, &c})) return false;
      const auto left = [&](Index from, Index to) {
        return is_on_line(p.vertex, from, to) ||
               between_normals(a, b, c, corners_[from], corners_[to], p) != CGAL::NEGATIVE;
      };
      return left(i, j) && left(j, k) && left(k, i);
    });
  }

  void check_faces() {
    constexpr std::size_t kMost = 5000;
    std::map<Index, const ExactRecord::Facet*> facets;
    for (const ExactRecord::Facet& facet : facets_) facets[facet.id] = &facet;
    const std::size_t every = step(record_.final_facets.size(), kMost);
    std::size_t asked = 0;
    enum class Where : std::uint8_t { on_facet, beside, off_plane };
    std::unordered_map<std::uint64_t, Where> known;  // of a vertex and a facet
    for (std::size_t n = 0; n < record_.final_facets.size(); n += every, ++asked) {
      const auto& [i, j, k, id] = record_.final_facets[n];
      const std::string name = "face " + std::to_string(n) + " on facet " + std::to_string(id);
      const auto facet = facets.find(id);
      if (facet == facets.end() || facet->second->triangles.empty()) {
        report_.fail(name + ": there is none");
        continue;
      }
      const auto& t = triangles_[facet->second->triangles[0]];
      const Point &a = corners_[t[0]], &b = corners_[t[1]], &c = corners_[t[2]];
      const std::array<Lazily, 3> p = {lazily(i), lazily(j), lazily(k)};
      if (between_normals(a, b, c, p[0], p[1], p[2]) != CGAL::POSITIVE) {
        report_.fail(name + " is not turned outwards");
      }
      for (const Lazily& corner : p) {
        const Index v = corner.vertex;
        if (std::find(t.begin(), t.end(), v) != t.end()) continue;
        const auto [where, fresh] =
            known.try_emplace(static_cast<std::uint64_t>(id) << 32 | v, Where::on_facet);
        if (!fresh) {
          // decided before
        } else if (!is_defined_in_plane(v, t) && orientation(a, b, c, corner) != CGAL::ZERO) {
          where->second = Where::off_plane;
        } else if (!on_facet(corner, *facet->second)) {
          where->second = Where::beside;
        }
        if (where->second == Where::off_plane) report_.fail(name + " is off its plane");
        if (where->second == Where::beside) report_.fail(name + " has a corner beside it");
      }
    }
    report_.checked += asked;
    report_.figures.emplace_back("faces", static_cast<double>(asked));
  }

  // Sums of coordinates: exact numbers, or residues of fractions. Two sums of these that are called
  // equal are so, except for a chance of 2^-120.
  using Term = std::conditional_t<std::is_same_v<K, Whole>, Number, Residue>;
  using Terms = std::array<Term, 3>;

  Terms terms(const Place& p) {
    if constexpr (std::is_same_v<K, Whole>) {
      return {p.hx(), p.hy(), p.hz()};
    } else {
      Terms result;
      const bool known = Residue::of({p.hx(), p.hy(), p.hz()}, p.hw(), result);
      if (!known) report_.fail("a prime divides a denominator");  // a chance of 2^-60
      return result;
    }
  }
  static Terms minus(const Terms& a, const Terms& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  }
  static Terms cross(const Terms& a, const Terms& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  // Six times the volume of a tetrahedron.
  static Term volume(const Terms& origin, const Terms& a, const Terms& b, const Terms& c) {
    const Terms u = minus(a, origin), n = cross(minus(b, origin), minus(c, origin));
    return u[0] * n[0] + u[1] * n[1] + u[2] * n[2];
  }

  static constexpr std::size_t kMostSummed = 20000;
  bool sums_faces() const { return record_.final_facets.size() <= kMostSummed; }
  bool sums_tetrahedra() const { return record_.final.size() <= kMostSummed; }

  void check_volumes() {
    const bool faces = sums_faces(), tetrahedra = sums_tetrahedra();
    report_.checked += (faces ? 1 : 0) + (tetrahedra ? 1 : 0);
    report_.figures.emplace_back("volumes and areas", (faces ? 1 : 0) + (tetrahedra ? 1 : 0));
    if (!faces && !tetrahedra) return;
    std::vector<Terms> corners;
    for (const Point& corner : corners_) corners.push_back(terms(corner.exact()));
    std::map<Index, Terms> known;
    const auto at = [&](Index v) -> const Terms& {
      if (!terms_.empty()) return terms_[v];
      const auto [found, fresh] = known.try_emplace(v);
      if (fresh) found->second = terms(expand(v).exact());
      return found->second;
    };
    Term solid{};
    for (const auto& [i, j, k] : triangles_) {
      solid = solid + volume(corners[0], corners[i], corners[j], corners[k]);
    }
    if (faces) {
      // Per facet, the areas of its faces and of its triangles.
      std::map<Index, std::array<Terms, 2>> areas;
      const auto add = [&](Terms& sum, const Terms& a, const Terms& b, const Terms& c) {
        const Terms n = cross(minus(b, a), minus(c, a));
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] = sum[axis] + n[axis];
      };
      Term sum{};
      for (const auto& [i, j, k, id] : record_.final_facets) {
        sum = sum + volume(corners[0], at(i), at(j), at(k));
        add(areas[id][0], at(i), at(j), at(k));
      }
      if (!(sum == solid)) report_.fail("the faces enclose another volume");
      for (const ExactRecord::Facet& facet : facets_) {
        for (const Index t : facet.triangles) {
          const auto& [i, j, k] = triangles_[t];
          add(areas[facet.id][1], corners[i], corners[j], corners[k]);
        }
      }
      for (const auto& [id, sums] : areas) {
        if (sums[0] == sums[1]) continue;
        report_.fail("the faces on facet " + std::to_string(id) + " have another area");
      }
    }
    if (tetrahedra) {
      Term sum{};
      for (const ExactRecord::Tet& tet : record_.final) {
        if (!tet.inside) continue;
        const auto& [i, j, k, l] = tet.vertices;
        sum = sum + volume(at(i), at(j), at(k), at(l));
      }
      if (!(sum == solid)) report_.fail("the tetrahedra inside have another volume");
    }
  }

  const Polyhedron& input_;
  const std::vector<std::array<Index, 3>>& triangles_;
  const ExactRecord& record_;
  const std::vector<ExactRecord::Facet>& facets_;
  const ExactPoints& points_;
  const Definitions definitions_;
  std::vector<Place> input_places_;              // by the definitions
  std::vector<Point> corners_;                   // of the surface whose facets are meshed
  std::vector<std::pair<Index, Point>> recent_;  // see expand; kNone: none yet
  std::vector<Corners> recent_corners_;          // see of_equal_weight
  std::vector<Direction> directions_;
  std::vector<Rough::Point_3> rough_;  // of all points, if all were compared
  std::vector<Terms> terms_;           // of all points, if all were compared and sums are needed
  OracleReport report_{"second-kernel", "points, tetrahedra, faces and sums"};
};

// The record lists those of the surface that was refined.
std::vector<ExactRecord::Facet> facets_of(const InputSurface& surface) {
  const InputSurface::Members members = surface.members();
  std::vector<ExactRecord::Facet> facets;
  for (Index f = 0; f < surface.facets().size(); ++f) {
    const std::span<const Index> triangles = members.of(f);
    facets.push_back({surface.facets()[f].id,
                      surface.facets()[f].label,
                      0,
                      {triangles.begin(), triangles.end()}});
  }
  return facets;
}

}  // namespace

OracleReport check_second_kernel(const Polyhedron& input, const InputSurface& surface,
                                 const ExactRecord& record, const ExactPoints& points,
                                 const std::string& sidecar, bool as_given, bool kept) {
  Definitions definitions;
  if (sidecar.empty()) {
    definitions = {record.points, record.planes};
  } else if (!read_definitions(sidecar, definitions) ||
             definitions.points.size() != record.points.size() ||
             definitions.planes.size() != record.planes.size()) {
    OracleReport report("second-kernel", "points");
    report.fail("the text of the points is not what the format says");
    return report;
  }
  if (as_given) {
    for (std::size_t v = 0; v < input.vertices.size(); ++v) {
      const auto& [x, y, z] = input.vertices[v];
      definitions.points[v] = {ExactPoint::Kind::explicit_point, 0, 0, 0, x, y, z};
    }
    definitions.planes.clear();
  }
  std::vector<ExactRecord::Facet> made;
  if (kept) {
    for (Index t = 0; t < surface.triangles().size(); ++t) made.push_back({t, 0, 0, {t}});
  } else if (as_given) {
    made = facets_of(surface);
  }
  const std::vector<ExactRecord::Facet>& facets = kept || as_given ? made : record.facets;
  if (definitions.planes.empty()) {
    return SecondKernel<Whole>(input, surface, record, facets, points, std::move(definitions))
        .run();
  }
  return SecondKernel<Fractions>(input, surface, record, facets, points, std::move(definitions))
      .run();
}

}  // namespace tetproof::oracles
