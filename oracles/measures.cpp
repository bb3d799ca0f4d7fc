#include "oracles/measures.h"

#include <algorithm>
#include <cmath>

namespace tetproof::oracles {
namespace {

// Certifies that angles are not below a bound: cos^2 <= c2 for acute ones.
class AngleBound {
 public:
  explicit AngleBound(double degrees) {
    const double cosine = std::cos(degrees * (3.14159265358979323846 / 180));
    bound_ = cosine * cosine * (1 + 1e-9);
    exact_bound_ = bound_;
  }

  // Is the angle of the triangle at `apex` below the bound?
  bool below(const ExactPoints& points, Index apex, Index b, Index c) const {
    const IntervalVector &p = points.enclosure(apex), &q = points.enclosure(b),
                         &r = points.enclosure(c);
    Interval uv(0), uu(0), vv(0);
    for (int axis = 0; axis < 3; ++axis) {
      const Interval u = q[axis] - p[axis], v = r[axis] - p[axis];
      uv = uv + u * v;
      uu = uu + u * u;
      vv = vv + v * v;
    }
    if (uv.sign() == -1) return false;
    if (uv.sign() == 1) {
      const int sign = (uu * vv * Interval(bound_) - uv * uv).sign();
      if (sign != 2) return sign < 0;
    }
    return below_exactly(points, apex, b, c);
  }

 private:
  bool below_exactly(const ExactPoints& points, Index apex, Index b, Index c) const {
    const IntegerVector u = exact::difference(points, apex, b);
    const IntegerVector v = exact::difference(points, apex, c);
    const mpz_class uv = exact::dot(u, v);
    if (uv <= 0) return exact::is_zero(u) || exact::is_zero(v);
    const mpq_class product = mpz_class(exact::dot(u, u) * exact::dot(v, v));
    return mpq_class(mpz_class(uv * uv)) > product * exact_bound_;
  }

  double bound_;
  mpq_class exact_bound_;
};

double angle_degrees(const ExactPoints& points, Index apex, Index b, Index c) {
  const Position p = points.nearest(apex), q = points.nearest(b), r = points.nearest(c);
  double u[3], v[3];
  for (int i = 0; i < 3; ++i) {
    u[i] = q[i] - p[i];
    v[i] = r[i] - p[i];
  }
  const double sine =
      std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
  return std::atan2(sine, u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) * (180 / 3.14159265358979323846);
}

// The first angle below the bound, as face and corner; false if there is none.
bool find_small_angle(const ExactPoints& points, const Tet& tet, const AngleBound& bound,
                      Face& corner_first) {
  for (int i = 0; i < 4; ++i) {
    const Face face = face_of(tet, i);
    for (int corner = 0; corner < 3; ++corner) {
      const Index a = face[corner], b = face[(corner + 1) % 3], c = face[(corner + 2) % 3];
      if (bound.below(points, a, b, c)) {
        corner_first = {a, b, c};
        return true;
      }
    }
  }
  return false;
}

double smallest_angle(const ExactPoints& points, const Tet& tet) {
  double smallest = 180;
  for (int i = 0; i < 4; ++i) {
    const Face f = face_of(tet, i);
    for (int corner = 0; corner < 3; ++corner) {
      smallest = std::min(
          smallest, angle_degrees(points, f[corner], f[(corner + 1) % 3], f[(corner + 2) % 3]));
    }
  }
  return smallest;
}

}  // namespace

double smallest_altitude(const ExactPoints& points, const Tet& tet) {
  const auto& [a, b, c, d] = tet;
  double largest = 0;
  for (int i = 0; i < 4; ++i) {
    const Face face = face_of(tet, i);
    const IntegerVector n = exact::area2(points, face[0], face[1], face[2]);
    const long exponent = 2 * points.exponent();
    largest = std::max(largest, std::hypot(to_double(n[0], exponent), to_double(n[1], exponent),
                                           to_double(n[2], exponent)));
  }
  const double volume =
      std::fabs(to_double(exact::volume6(points, a, b, c, d), 3 * points.exponent()));
  return volume > 0 ? volume / largest : 0;
}

OracleReport check_volume(const TetComplex& complex, const InputSurface& surface, double allowed) {
  OracleReport report("volume", "tetrahedra inside");
  mpz_class sum;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    if (!complex.inside[t]) continue;
    const auto& [a, b, c, d] = complex.tetrahedra[t];
    sum += exact::volume6(*complex.points, a, b, c, d);
    ++report.checked;
  }
  const long exponent = 3 * complex.points->exponent();
  const double volume = to_double(surface.volume6(), exponent) / 6;
  if (sum != surface.volume6()) {
    const mpz_class excess = sum - surface.volume6();
    const double difference = to_double(excess, exponent) / 6;
    char text[128];
    std::snprintf(
        text, sizeof text,
        "the tetrahedra inside have a volume that differs by %.3g from the surface's %.6g",
        difference, volume);
    if (allowed == 0 || !(std::fabs(difference) <= allowed)) report.fail(text);
    report.figures.emplace_back("difference", difference);
    report.figures.emplace_back("allowed", allowed);
  }
  report.figures.emplace_back("volume", volume);
  return report;
}

std::vector<std::uint8_t> inside_by_parity(const TetComplex& complex, const InputSurface& surface) {
  std::vector<std::uint8_t> inside(complex.tetrahedra.size());
  for (std::size_t t = 0; t < inside.size(); ++t) {
    inside[t] = surface.inside(*complex.points, complex.tetrahedra[t]) == 1;
  }
  return inside;
}

OracleReport check_interior(const TetComplex& complex, const InputSurface& surface) {
  OracleReport report("interior", "tetrahedra");
  std::uint64_t inside = 0;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const int parity = surface.inside(*complex.points, complex.tetrahedra[t]);
    ++report.checked;
    inside += complex.inside[t];
    if (parity == -1) {
      report.fail(complex.tet_name(t) + " has its centroid on the surface");
    } else if (parity != complex.inside[t]) {
      report.fail(complex.tet_name(t) + " is called " + (complex.inside[t] ? "inside" : "outside") +
                  " but its centroid is not");
    }
  }
  report.figures.emplace_back("inside", inside);
  return report;
}

OracleReport check_angles(const TetComplex& complex, const InputSurface& surface, double delta,
                          AngleScope scope) {
  OracleReport report("angles", "tetrahedra");
  const AngleBound bound(delta);
  std::uint64_t left_alone = 0;
  double smallest = 180;
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const Tet& tet = complex.tetrahedra[t];
    Face at;
    const bool bad = find_small_angle(*complex.points, tet, bound, at);
    if (bad && scope == AngleScope::solid && surface.inside(*complex.points, tet) == 0 &&
        !surface.meets_interior(*complex.points, tet)) {
      ++left_alone;
      continue;
    }
    ++report.checked;
    smallest = std::min(smallest, smallest_angle(*complex.points, tet));
    if (bad) {
      char text[64];
      std::snprintf(text, sizeof text, " has an angle of %.6g degrees at ",
                    angle_degrees(*complex.points, at[0], at[1], at[2]));
      report.fail(complex.tet_name(t) + text + complex.vertex_name(at[0]) + " in " +
                  complex.face_name(at));
    }
  }
  report.figures.emplace_back("bound", delta);
  report.figures.emplace_back("smallest angle", smallest);
  report.figures.emplace_back("bad tetrahedra outside the solid", left_alone);
  return report;
}

}  // namespace tetproof::oracles
