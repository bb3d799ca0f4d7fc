#include "oracles/cgal/second_kernel.h"

#include <CGAL/Gmpq.h>
#include <CGAL/Gmpzf.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;
using Rough = CGAL::Simple_cartesian<CGAL::Interval_nt<false>>;

// A point with a number type of CGAL's. Where no point is on three planes, all questions need ring
// operations only, and CGAL's exact floating-point numbers (Gmpzf) have them. With fractions, which
// are reduced again and again, they took most of the time of a verification.
template <class Number>
struct Point {
  using Kernel = CGAL::Simple_cartesian<Number>;
  typename Kernel::Point_3 exact;
  Rough::Point_3 rough;

  explicit Point(const typename Kernel::Point_3& p)
      : exact(p), rough(interval(p.x()), interval(p.y()), interval(p.z())) {}
  Point(const Number& x, const Number& y, const Number& z)
      : Point(typename Kernel::Point_3(x, y, z)) {}

 private:
  static CGAL::Interval_nt<false> interval(const Number& x) {
    return CGAL::Interval_nt<false>(CGAL::to_interval(x));
  }
};

// CGAL's intervals need the rounding mode set upwards, and tell when they are not certain.
template <class Predicate, class... Points>
CGAL::Sign decide(const Predicate& predicate, const Points&... points) {
  {
    const CGAL::Protect_FPU_rounding<true> protection;
    const auto rough = predicate(points.rough...);
    if (CGAL::is_certain(rough)) return CGAL::get_certain(rough);
  }
  return CGAL::make_certain(predicate(points.exact...));
}

template <class Number>
CGAL::Sign orientation(const Point<Number>& a, const Point<Number>& b, const Point<Number>& c,
                       const Point<Number>& d) {
  return decide([](const auto&... p) { return CGAL::orientation(p...); }, a, b, c, d);
}

// The sign of the cosine of the angle between the normal of abc and the direction from p to q.
template <class Number>
CGAL::Sign along_normal(const Point<Number>& a, const Point<Number>& b, const Point<Number>& c,
                        const Point<Number>& p, const Point<Number>& q) {
  return decide(
      [](const auto& u, const auto& v, const auto& w, const auto& from, const auto& to) {
        return CGAL::sign(CGAL::cross_product(v - u, w - u) * (to - from));
      },
      a, b, c, p, q);
}

// The sign of the cosine of the angle between the normals of abc and pqr.
template <class Number>
CGAL::Sign between_normals(const Point<Number>& a, const Point<Number>& b, const Point<Number>& c,
                           const Point<Number>& p, const Point<Number>& q, const Point<Number>& r) {
  return decide(
      [](const auto& u, const auto& v, const auto& w, const auto& x, const auto& y, const auto& z) {
        return CGAL::sign(CGAL::cross_product(v - u, w - u) * CGAL::cross_product(y - x, z - x));
      },
      a, b, c, p, q, r);
}

// --- the text

// "-0x1.8p+3", "0x0p+0", also decimal integers. Exact: at most 53 bits are written.
bool parse_hexadecimal(const std::string& word, double& value) {
  std::size_t at = 0;
  const bool negative = word.starts_with("-");
  if (negative || word.starts_with("+")) ++at;
  if (word.compare(at, 2, "0x") != 0 && word.compare(at, 2, "0X") != 0) return false;
  at += 2;
  double mantissa = 0;
  int exponent = 0, digits = 0;
  bool point = false;
  for (; at < word.size() && word[at] != 'p' && word[at] != 'P'; ++at) {
    if (word[at] == '.' && !point) {
      point = true;
      continue;
    }
    const std::string all = "0123456789abcdef";
    const auto digit = all.find(static_cast<char>(std::tolower(word[at])));
    if (digit == std::string::npos) return false;
    mantissa = mantissa * 16 + static_cast<double>(digit);
    if (point) exponent -= 4;
    ++digits;
  }
  if (digits == 0 || digits > 14) return false;
  if (at < word.size()) {
    try {
      exponent += std::stoi(word.substr(at + 1));
    } catch (const std::exception&) {
      return false;
    }
  }
  value = std::ldexp(negative ? -mantissa : mantissa, exponent);
  return true;
}

struct Definitions {
  std::vector<ExactPoint> points;
  std::vector<ExactRecord::Plane> planes;
};

bool read_plane(std::istringstream& words, ExactRecord::Plane& plane) {
  std::string kind;
  words >> kind;
  if (kind != "N" && kind != "T") return false;
  plane.spanned = kind == "T";
  std::vector<std::array<double, 3>*> wanted;
  if (!plane.spanned) wanted.push_back(&plane.normal);
  for (std::size_t i = 0; i < (plane.spanned ? 3U : 1U); ++i) wanted.push_back(&plane.through[i]);
  for (std::array<double, 3>* numbers : wanted) {
    for (double& x : *numbers) {
      std::string word;
      if (!(words >> word) || !parse_hexadecimal(word, x)) return false;
    }
  }
  return true;
}

// Reads the definitions of planes and points, as written. False if the text is not in the format.
bool read_definitions(const std::string& path, Definitions& definitions) {
  std::vector<ExactPoint>& points = definitions.points;
  std::ifstream in(path);
  std::string line, word;
  std::size_t count = 0, planes = 0;
  while (std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    if (definitions.planes.size() < planes) {
      if (!read_plane(words, definitions.planes.emplace_back())) return false;
      continue;
    }
    if (!(words >> word)) continue;
    if (word == "planes" && !(words >> planes)) return false;
    if (word == "points" && words >> count) break;
  }
  while (points.size() < count && std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string kind;
    if (!(words >> kind)) continue;
    ExactPoint p;
    std::array<double*, 3> numbers = {&p.x, &p.y, &p.z};
    std::size_t wanted = 3;
    if (kind == "S" || kind == "T" || kind == "P") {
      p.kind = kind == "S"   ? ExactPoint::Kind::on_segment
               : kind == "T" ? ExactPoint::Kind::on_triangle
                             : ExactPoint::Kind::on_planes;
      words >> p.i >> p.j;
      if (kind != "S") words >> p.k;
      wanted = kind == "S" ? 1 : kind == "T" ? 2 : 0;
    } else if (kind != "E") {
      return false;
    }
    for (std::size_t n = 0; n < wanted; ++n) {
      if (!(words >> word) || !parse_hexadecimal(word, *numbers[n])) return false;
    }
    points.push_back(p);
  }
  return count > 0 && points.size() == count;
}

// --- the mesh

// 2^exponent, beyond the range of doubles as well.
template <class Number>
Number power_of_two(long exponent) {
  constexpr long kStep = 900;
  Number result(1);
  for (; exponent > kStep; exponent -= kStep) result *= Number(std::ldexp(1.0, kStep));
  for (; exponent < -kStep; exponent += kStep) result *= Number(std::ldexp(1.0, -kStep));
  return result * Number(std::ldexp(1.0, static_cast<int>(exponent)));
}

template <class Number>
Number from_integer(const mpz_class& value, const Number& unit) {
  Number result(0), scale = unit;
  mpz_class rest = abs(value), part;
  while (rest != 0) {
    mpz_fdiv_r_2exp(part.get_mpz_t(), rest.get_mpz_t(), 52);
    mpz_fdiv_q_2exp(rest.get_mpz_t(), rest.get_mpz_t(), 52);
    result += Number(part.get_d()) * scale;
    scale *= Number(0x1p52);
  }
  return value < 0 ? -result : result;
}

// Is x the number in these units? Decided without division, which not all number types have.
template <class Number>
bool is_number(const Number& x, const ExactNumber& value, const Number& unit) {
  return x * from_integer<Number>(value.denominator(), Number(1)) ==
         from_integer<Number>(value.numerator(), unit);
}

template <class Number>
class SecondKernel {
  using Point = oracles::Point<Number>;
  using Kernel = typename Point::Kernel;
  using Vector = typename Kernel::Vector_3;
  using Place = typename Kernel::Point_3;

 public:
  SecondKernel(const Polyhedron& input, const InputSurface& surface, const ExactRecord& record,
               const ExactPoints& points, Definitions definitions)
      : input_(input),
        triangles_(surface.triangles()),
        record_(record),
        points_(points),
        definitions_(std::move(definitions)) {}

  OracleReport run() {
    for (std::size_t v = 0; v < input_.vertices.size(); ++v) {
      input_places_.push_back(place_of(static_cast<Index>(v)));
    }
    compare_points();
    for (std::size_t v = 0; v < input_.vertices.size(); ++v) {
      const Position& p = input_.vertices[v];
      const bool moved = definitions_.points[v].kind == ExactPoint::Kind::on_planes;
      corners_.push_back(moved ? expand(static_cast<Index>(v))
                               : Point(Number(p[0]), Number(p[1]), Number(p[2])));
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
    if constexpr (std::is_same_v<Number, CGAL::Gmpq>) {
      const auto plane = [&](Index n) -> typename Kernel::Plane_3 {
        const ExactRecord::Plane& e = definitions_.planes[n];
        if (e.spanned) return {place(e.through[0]), place(e.through[1]), place(e.through[2])};
        return {place(e.through[0]), Vector(CGAL::ORIGIN, place(e.normal))};
      };
      const auto meeting = CGAL::intersection(plane(p.i), plane(p.j), plane(p.k));
      if (meeting) {
        if (const Place* found = boost::get<Place>(&*meeting)) return *found;
      }
    }
    return {Number(0), Number(0), Number(0)};  // other than the oracles' point
  }
  Point expand(Index v) const {
    const ExactPoint& p = definitions_.points[v];
    if (p.kind == ExactPoint::Kind::explicit_point || p.kind == ExactPoint::Kind::on_planes) {
      return Point(corner(v));
    }
    const Place a = corner(p.i), b = corner(p.j);
    const Number t(p.x);
    if (p.kind == ExactPoint::Kind::on_segment) {
      const Number rest = Number(1) - t;
      return {t * a.x() + rest * b.x(), t * a.y() + rest * b.y(), t * a.z() + rest * b.z()};
    }
    const Place c = corner(p.k);
    const Number u(p.y), rest = Number(1) - t - u;
    return {t * a.x() + u * b.x() + rest * c.x(), t * a.y() + u * b.y() + rest * c.y(),
            t * a.z() + u * b.z() + rest * c.z()};
  }

  void compare_points() {
    constexpr std::size_t kMost = 20000;
    const Number unit = power_of_two<Number>(points_.exponent());
    std::size_t asked = 0;
    for (std::size_t v = 0; v < definitions_.points.size();
         v += step(definitions_.points.size(), kMost), ++asked) {
      const Place p = expand(static_cast<Index>(v)).exact;
      const ExactVector& other = points_.exact(static_cast<Index>(v));
      if (!is_number(p.x(), other[0], unit) || !is_number(p.y(), other[1], unit) ||
          !is_number(p.z(), other[2], unit)) {
        report_.fail("point " + std::to_string(v) + " is elsewhere to CGAL's kernel");
      }
    }
    report_.checked += asked;
    report_.figures.emplace_back("points", static_cast<double>(asked));
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
      const std::array<Point, 4> p = {expand(tet.vertices[0]), expand(tet.vertices[1]),
                                      expand(tet.vertices[2]), expand(tet.vertices[3])};
      ++asked;
      if (orientation(p[0], p[1], p[2], p[3]) != CGAL::POSITIVE) {
        report_.fail("tetrahedron " + std::to_string(t) + " is not positive");
      }
      if (t % every_ray != 0) continue;
      ++cast;
      const int side = parity(centroid(p));
      if (side != (tet.inside ? 1 : 0)) {
        report_.fail("tetrahedron " + std::to_string(t) + " is said to be " +
                     (tet.inside ? "inside" : "outside") + ", and is not");
      }
    }
    report_.checked += asked;
    report_.figures.emplace_back("tetrahedra", static_cast<double>(asked));
    report_.figures.emplace_back("rays", static_cast<double>(cast));
  }

  static Point centroid(const std::array<Point, 4>& p) {
    std::array<Number, 3> sum;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Point& corner : p) sum[axis] += corner.exact[axis];
      sum[axis] *= Number(0.25);
    }
    return {sum[0], sum[1], sum[2]};
  }

  // The parity along a ray. Tries rays in several directions until one meets no edge. -1: the point
  // is on the surface, or no ray was found.
  int parity(const Point& from) const {
    for (int attempt = 0; attempt < 16; ++attempt) {
      const Vector along(Number(0.2718281828 + 0.37 * attempt),
                         Number(0.5772156649 - 0.11 * attempt), Number(1));
      const Point to(from.exact + along);
      int crossings = 0;
      bool sure = true;
      for (const auto& [i, j, k] : triangles_) {
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

  bool on_facet(const Point& p, const ExactRecord::Facet& facet) const {
    for (const Index t : facet.triangles) {
      const auto& [i, j, k] = triangles_[t];
      const Point &a = corners_[i], &b = corners_[j], &c = corners_[k];
      const auto left = [&](const Point& from, const Point& to) {
        return between_normals(a, b, c, from, to, p) != CGAL::NEGATIVE;
      };
      if (left(a, b) && left(b, c) && left(c, a)) return true;
    }
    return false;
  }

  void check_faces() {
    constexpr std::size_t kMost = 5000;
    std::map<Index, const ExactRecord::Facet*> facets;
    for (const ExactRecord::Facet& facet : record_.facets) facets[facet.id] = &facet;
    const std::size_t every = step(record_.final_facets.size(), kMost);
    std::size_t asked = 0;
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
      const std::array<Point, 3> p = {expand(i), expand(j), expand(k)};
      if (between_normals(a, b, c, p[0], p[1], p[2]) != CGAL::POSITIVE) {
        report_.fail(name + " is not turned outwards");
      }
      for (const Point& corner : p) {
        if (orientation(a, b, c, corner) != CGAL::ZERO) {
          report_.fail(name + " is off its plane");
        } else if (!on_facet(corner, *facet->second)) {
          report_.fail(name + " has a corner beside it");
        }
      }
    }
    report_.checked += asked;
    report_.figures.emplace_back("faces", static_cast<double>(asked));
  }

  // Six times the volume of a tetrahedron.
  static Number volume(const Point& origin, const Point& a, const Point& b, const Point& c) {
    return CGAL::determinant(a.exact - origin.exact, b.exact - origin.exact,
                             c.exact - origin.exact);
  }

  void check_volumes() {
    constexpr std::size_t kMostTetrahedra = 20000, kMostFaces = 20000;
    const Point origin = corners_[0];
    std::map<Index, std::array<Number, 3>> areas;
    const auto add_area = [&](Index id, const Point& a, const Point& b, const Point& c, int sign) {
      const Vector n = CGAL::cross_product(b.exact - a.exact, c.exact - a.exact);
      std::array<Number, 3>& sum = areas[id];
      for (int axis = 0; axis < 3; ++axis) sum[axis] += sign > 0 ? n[axis] : -n[axis];
    };
    Number solid(0);
    for (const auto& [i, j, k] : triangles_) {
      solid += volume(origin, corners_[i], corners_[j], corners_[k]);
    }
    const bool faces = record_.final_facets.size() <= kMostFaces;
    const bool tetrahedra = record_.final.size() <= kMostTetrahedra;
    if (faces) {
      Number sum(0);
      for (const auto& [i, j, k, id] : record_.final_facets) {
        const Point a = expand(i), b = expand(j), c = expand(k);
        sum += volume(origin, a, b, c);
        add_area(id, a, b, c, 1);
      }
      if (sum != solid) report_.fail("the faces enclose another volume");
      for (const ExactRecord::Facet& facet : record_.facets) {
        for (const Index t : facet.triangles) {
          const auto& [i, j, k] = triangles_[t];
          add_area(facet.id, corners_[i], corners_[j], corners_[k], -1);
        }
      }
      for (const auto& [id, sum_of_areas] : areas) {
        if (!CGAL::is_zero(sum_of_areas[0]) || !CGAL::is_zero(sum_of_areas[1]) ||
            !CGAL::is_zero(sum_of_areas[2])) {
          report_.fail("the faces on facet " + std::to_string(id) + " have another area");
        }
      }
    }
    if (tetrahedra) {
      Number sum(0);
      for (const ExactRecord::Tet& tet : record_.final) {
        if (!tet.inside) continue;
        sum += volume(expand(tet.vertices[0]), expand(tet.vertices[1]), expand(tet.vertices[2]),
                      expand(tet.vertices[3]));
      }
      if (sum != solid) report_.fail("the tetrahedra inside have another volume");
    }
    report_.checked += (faces ? 1 : 0) + (tetrahedra ? 1 : 0);
    report_.figures.emplace_back("volumes and areas", (faces ? 1 : 0) + (tetrahedra ? 1 : 0));
  }

  const Polyhedron& input_;
  const std::vector<std::array<Index, 3>>& triangles_;
  const ExactRecord& record_;
  const ExactPoints& points_;
  const Definitions definitions_;
  std::vector<Place> input_places_;  // by the definitions
  std::vector<Point> corners_;       // of the surface whose facets are meshed
  OracleReport report_{"second-kernel", "points, tetrahedra, faces and sums"};
};

}  // namespace

OracleReport check_second_kernel(const Polyhedron& input, const InputSurface& surface,
                                 const ExactRecord& record, const ExactPoints& points,
                                 const std::string& sidecar) {
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
  if (record.planes.empty()) {
    return SecondKernel<CGAL::Gmpzf>(input, surface, record, points, std::move(definitions)).run();
  }
  return SecondKernel<CGAL::Gmpq>(input, surface, record, points, std::move(definitions)).run();
}

}  // namespace tetproof::oracles
