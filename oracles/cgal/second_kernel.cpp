#include "oracles/cgal/second_kernel.h"

#include <CGAL/Gmpzf.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>

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
// All that is asked needs ring operations only. CGAL's exact floating-point numbers have them; in
// its lazy kernel, whose fractions are reduced again and again, the same took most of a
// verification.
using Number = CGAL::Gmpzf;
using Kernel = CGAL::Simple_cartesian<Number>;
using Vector = Kernel::Vector_3;
using Rough = CGAL::Simple_cartesian<CGAL::Interval_nt<false>>;

struct Point {
  Kernel::Point_3 exact;
  Rough::Point_3 rough;

  explicit Point(const Kernel::Point_3& p)
      : exact(p), rough(interval(p.x()), interval(p.y()), interval(p.z())) {}
  Point(const Number& x, const Number& y, const Number& z) : Point(Kernel::Point_3(x, y, z)) {}

 private:
  static CGAL::Interval_nt<false> interval(const Number& x) {
    return CGAL::Interval_nt<false>(CGAL::to_interval(x));
  }
};

// CGAL's intervals work with the rounding mode set upwards, and say when they are not certain.
template <class Predicate, class... Points>
CGAL::Sign decide(const Predicate& predicate, const Points&... points) {
  {
    const CGAL::Protect_FPU_rounding<true> protection;
    const auto rough = predicate(points.rough...);
    if (CGAL::is_certain(rough)) return CGAL::get_certain(rough);
  }
  return CGAL::make_certain(predicate(points.exact...));
}

CGAL::Sign orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  return decide([](const auto&... p) { return CGAL::orientation(p...); }, a, b, c, d);
}

// Of the angle between the normal of abc and the direction from p to q, cosine's sign.
CGAL::Sign along_normal(const Point& a, const Point& b, const Point& c, const Point& p,
                        const Point& q) {
  return decide(
      [](const auto& u, const auto& v, const auto& w, const auto& from, const auto& to) {
        return CGAL::sign(CGAL::cross_product(v - u, w - u) * (to - from));
      },
      a, b, c, p, q);
}

// Of the angle between the normals of abc and pqr.
CGAL::Sign between_normals(const Point& a, const Point& b, const Point& c, const Point& p,
                           const Point& q, const Point& r) {
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

// The definitions of points, as written. False if the text is not what it should be.
bool read_points(const std::string& path, std::vector<ExactPoint>& points) {
  std::ifstream in(path);
  std::string line, word;
  std::size_t count = 0;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    if (words >> word && word == "points" && words >> count) break;
  }
  while (points.size() < count && std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string kind;
    if (!(words >> kind)) continue;
    ExactPoint p;
    std::array<double*, 3> numbers = {&p.x, &p.y, &p.z};
    std::size_t wanted = 3;
    if (kind == "S" || kind == "T") {
      p.kind = kind == "S" ? ExactPoint::Kind::on_segment : ExactPoint::Kind::on_triangle;
      words >> p.i >> p.j;
      if (kind == "T") words >> p.k;
      wanted = kind == "S" ? 1 : 2;
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
Number power_of_two(long exponent) {
  constexpr long kStep = 900;
  Number result(1);
  for (; exponent > kStep; exponent -= kStep) result *= Number(std::ldexp(1.0, kStep));
  for (; exponent < -kStep; exponent += kStep) result *= Number(std::ldexp(1.0, -kStep));
  return result * Number(std::ldexp(1.0, static_cast<int>(exponent)));
}

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

class SecondKernel {
 public:
  SecondKernel(const Polyhedron& input, const InputSurface& surface, const ExactRecord& record,
               const ExactPoints& points, std::vector<ExactPoint> definitions)
      : input_(input),
        triangles_(surface.triangles()),
        record_(record),
        points_(points),
        definitions_(std::move(definitions)) {}

  OracleReport run() {
    compare_points();
    for (const Position& p : input_.vertices) {
      corners_.emplace_back(Number(p[0]), Number(p[1]), Number(p[2]));
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

  Kernel::Point_3 corner(Index v) const {
    const ExactPoint& p = definitions_[v];
    return {Number(p.x), Number(p.y), Number(p.z)};
  }
  Point expand(Index v) const {
    const ExactPoint& p = definitions_[v];
    if (p.kind == ExactPoint::Kind::explicit_point) return Point(corner(v));
    const Kernel::Point_3 a = corner(p.i), b = corner(p.j);
    const Number t(p.x);
    if (p.kind == ExactPoint::Kind::on_segment) {
      const Number rest = Number(1) - t;
      return {t * a.x() + rest * b.x(), t * a.y() + rest * b.y(), t * a.z() + rest * b.z()};
    }
    const Kernel::Point_3 c = corner(p.k);
    const Number u(p.y), rest = Number(1) - t - u;
    return {t * a.x() + u * b.x() + rest * c.x(), t * a.y() + u * b.y() + rest * c.y(),
            t * a.z() + u * b.z() + rest * c.z()};
  }

  void compare_points() {
    constexpr std::size_t kMost = 20000;
    const Number unit = power_of_two(points_.exponent());
    std::size_t asked = 0;
    for (std::size_t v = 0; v < definitions_.size();
         v += step(definitions_.size(), kMost), ++asked) {
      const Kernel::Point_3 p = expand(static_cast<Index>(v)).exact;
      const IntegerVector& other = points_.integer(static_cast<Index>(v));
      if (p.x() != from_integer(other[0], unit) || p.y() != from_integer(other[1], unit) ||
          p.z() != from_integer(other[2], unit)) {
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

  // Along rays in several directions, until one meets no edge. -1: the point is on the surface.
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
  const std::vector<ExactPoint> definitions_;
  std::vector<Point> corners_;
  OracleReport report_{"second-kernel", "points, tetrahedra, faces and sums"};
};

}  // namespace

OracleReport check_second_kernel(const Polyhedron& input, const InputSurface& surface,
                                 const ExactRecord& record, const ExactPoints& points,
                                 const std::string& sidecar) {
  std::vector<ExactPoint> definitions;
  if (sidecar.empty()) {
    definitions = record.points;
  } else if (!read_points(sidecar, definitions) || definitions.size() != record.points.size()) {
    OracleReport report("second-kernel", "points");
    report.fail("the text of the points is not what the format says");
    return report;
  }
  return SecondKernel(input, surface, record, points, std::move(definitions)).run();
}

}  // namespace tetproof::oracles
