#include "mesher/predicates/predicates.h"

#include <algorithm>
#include <array>

#include "mesher/predicates/dihedral_filter.h"
#include "mesher/predicates/stages.h"

namespace delmesher::predicates {
namespace {

// Is some id in all of the sorted lists?
template <std::size_t N>
bool shared(const std::array<std::span<const std::uint32_t>, N>& lists) {
  for (const std::uint32_t id : lists[0]) {
    bool everywhere = true;
    for (std::size_t i = 1; i < N && everywhere; ++i) {
      everywhere = std::find(lists[i].begin(), lists[i].end(), id) != lists[i].end();
    }
    if (everywhere) return true;
  }
  return false;
}

template <std::size_t N>
bool on_shared_plane(const PointStore& points, const std::array<VertexId, N>& v) {
  std::array<std::span<const std::uint32_t>, N> lists;
  for (std::size_t i = 0; i < N; ++i) {
    lists[i] = points.planes(v[i]);
    if (lists[i].empty()) return false;
  }
  return shared(lists);
}

bool on_shared_line(const PointStore& points, VertexId a, VertexId b, VertexId c) {
  const std::array<std::span<const std::uint32_t>, 3> lists = {points.lines(a), points.lines(b),
                                                               points.lines(c)};
  return !lists[0].empty() && !lists[1].empty() && !lists[2].empty() && shared(lists);
}

// Do all points have exactly the same x, or y, or z? Only exact approximations count.
template <std::size_t N>
bool on_shared_coordinate_plane(const PointStore& points, const std::array<VertexId, N>& v) {
  const Approximation& first = points.approximation(v[0]);
  bool x = true, y = true, z = true;
  for (const VertexId id : v) {
    const Approximation& a = points.approximation(id);
    if (a.error != 0) return false;
    x = x && a.x == first.x;
    y = y && a.y == first.y;
    z = z && a.z == first.z;
  }
  return x || y || z;
}

template <std::size_t N>
bool has_repetition(const std::array<VertexId, N>& v) {
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (v[i] == v[j]) return true;
    }
  }
  return false;
}

}  // namespace

template <class Polynomial>
int Predicates::sign(const Polynomial& polynomial, const VertexId* ids) {
  const int s = stages::filter(points_, polynomial, ids);
  if (s != kUnknownSign) {
    ++counters.filter;
    return s;
  }
  return sign_unfiltered(polynomial, ids);
}

// Integers of few limbs take less time than double-doubles with error bounds (measured: insphere
// 0.13 microseconds with one limb, 0.2 with two, 0.5 to 1.2 with three, against 0.7), and most
// signs that the filter does not decide are zeros, which only integers decide. So double-doubles
// are for long numbers.
template <class Polynomial>
int Predicates::sign_unfiltered(const Polynomial& polynomial, const VertexId* ids) {
  const stages::ExactArguments arguments(points_, ids, Polynomial::kPoints);
  if (!stages::exact_is_cheap<Polynomial>(arguments)) {
    const int s = stages::extended(points_, polynomial, ids);
    if (s != kUnknownSign) {
      ++counters.extended;
      return s;
    }
  }
  ++(stages::fits_fixed<Polynomial>(arguments) ? counters.fixed : counters.exact);
  return stages::exact(arguments, polynomial);
}

int Predicates::orient3d_unfiltered(VertexId a, VertexId b, VertexId c, VertexId d) {
  const std::array<VertexId, 4> v = {a, b, c, d};
  if (has_repetition(v) || on_shared_plane(points_, v) || on_shared_coordinate_plane(points_, v) ||
      on_shared_line(points_, a, b, c) || on_shared_line(points_, a, b, d) ||
      on_shared_line(points_, a, c, d) || on_shared_line(points_, b, c, d)) {
    ++counters.support;
    return 0;
  }
  return sign_unfiltered(polynomials::Orient3d{}, v.data());
}

int Predicates::orient2d(int axis, VertexId a, VertexId b, VertexId c) {
  const std::array<VertexId, 3> v = {a, b, c};
  const polynomials::Orient2d polynomial{axis};
  const int s = stages::filter(points_, polynomial, v.data());
  if (s != kUnknownSign) {
    ++counters.filter;
    return s;
  }
  if (has_repetition(v) || on_shared_line(points_, a, b, c)) {
    ++counters.support;
    return 0;
  }
  return sign_unfiltered(polynomial, v.data());
}

int Predicates::insphere_unfiltered(VertexId a, VertexId b, VertexId c, VertexId d, VertexId e) {
  const std::array<VertexId, 5> v = {a, b, c, d, e};
  if (has_repetition(v) || on_shared_plane(points_, v) || on_shared_coordinate_plane(points_, v)) {
    ++counters.support;
    return 0;
  }
  return sign_unfiltered(polynomials::Insphere{}, v.data());
}

// The insphere polynomial is minus the determinant of rows (1, x, y, z, h), h the lifted height
// (polynomials.h). Expanded along the last column it is the sum over i of
//   -(-1)^(i + 5) h_i orient3d(the others in order),  i = 1..5 for a..e.
// Raising h_i by eps_i, with eps of smaller ids infinitely larger, the sign of a vanishing
// determinant is that of the coefficient of the smallest id whose coefficient is not zero.
int Predicates::perturbed_sign(VertexId a, VertexId b, VertexId c, VertexId d, VertexId e) {
  const std::array<VertexId, 5> v = {a, b, c, d, e};
  if (has_repetition(v)) return 0;  // two equal rows, also after perturbation
  ++counters.symbolic;
  std::array<std::size_t, 5> order = {0, 1, 2, 3, 4};
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return v[i] < v[j]; });
  for (const std::size_t i : order) {
    std::array<VertexId, 4> others;
    std::copy(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(i), others.begin());
    std::copy(v.begin() + static_cast<std::ptrdiff_t>(i) + 1, v.end(),
              others.begin() + static_cast<std::ptrdiff_t>(i));
    const int s = orient3d(others[0], others[1], others[2], others[3]);
    if (s != 0) return i % 2 == 0 ? -s : s;
  }
  return 0;
}

int Predicates::dot_sign_unfiltered(VertexId p, VertexId q, VertexId r) {
  const VertexId v[] = {p, q, r};
  return sign_unfiltered(polynomials::Dot{}, v);
}

int Predicates::dot_difference_sign(VertexId a, VertexId b, VertexId c, VertexId d) {
  const VertexId v[] = {a, b, c, d};
  return sign(polynomials::DotDifference{}, v);
}

int Predicates::in_diametral_ball(VertexId a, VertexId b, VertexId c, VertexId p) {
  const int s = filters::in_diametral_ball(points_.approximation(a), points_.approximation(b),
                                           points_.approximation(c), points_.approximation(p));
  if (s != 0) {
    ++counters.filter;
    return s;
  }
  const VertexId v[] = {a, b, c, p};
  return sign_unfiltered(polynomials::InDiametralBall{}, v);
}

int Predicates::dihedral_sign(VertexId a, VertexId b, VertexId c, VertexId d) {
  const int s = filters::dihedral(points_.approximation(a), points_.approximation(b),
                                  points_.approximation(c), points_.approximation(d));
  if (s != 0) {
    ++counters.filter;
    return s;
  }
  const VertexId v[] = {a, b, c, d};
  return sign(polynomials::Dihedral{}, v);
}

int Predicates::compare_coordinate(int axis, VertexId a, VertexId b) {
  const VertexId v[] = {a, b};
  return sign(polynomials::CompareCoordinate{axis}, v);
}

int Predicates::compare_xyz(VertexId a, VertexId b) {
  for (int axis = 0; axis < 3; ++axis) {
    const int s = compare_coordinate(axis, a, b);
    if (s != 0) return s;
  }
  return 0;
}

bool Predicates::angle_below(VertexId p, VertexId q, VertexId r, double cosine_squared) {
  const VertexId v[] = {p, q, r};
  return dot_sign(p, q, r) > 0 && sign(polynomials::AngleExcess{cosine_squared}, v) > 0;
}

bool Predicates::dihedral_below(VertexId a, VertexId b, VertexId c, VertexId d,
                                double cosine_squared) {
  const VertexId v[] = {a, b, c, d};
  return dihedral_sign(a, b, c, d) > 0 && sign(polynomials::DihedralExcess{cosine_squared}, v) > 0;
}

bool Predicates::bends_below(VertexId a, VertexId b, VertexId c, VertexId d,
                             double cosine_squared) {
  const VertexId v[] = {a, b, c, d};
  return dihedral_sign(a, b, c, d) < 0 && sign(polynomials::DihedralExcess{cosine_squared}, v) > 0;
}

bool Predicates::edge_plane_angle_below(VertexId q, VertexId a, VertexId b, VertexId c,
                                        double cosine_squared) {
  const VertexId v[] = {q, a, b, c};
  return sign(polynomials::EdgePlaneExcess{cosine_squared}, v) > 0;
}

// Horner's scheme of Taylor's series in a fixed order; the error is below 1e-16 of one.
double cosine_squared(double degrees) {
  if (degrees <= 0) return 1;
  if (degrees >= 90) return 0;
  if (degrees == 60) return 0.25;
  if (degrees == 45) return 0.5;
  if (degrees == 30) return 0.75;
  const auto sine = [](double angle) {  // of at most 45 degrees
    constexpr double kRadian = 0.017453292519943295;
    const double x = angle * kRadian;
    const double xx = x * x;
    double sum = 1;
    for (int n = 18; n >= 2; n -= 2) sum = 1 - sum * xx / (n * (n + 1));
    return x * sum;
  };
  if (degrees > 45) {
    const double s = sine(90 - degrees);
    return s * s;
  }
  const double s = sine(degrees);
  return 1 - s * s;
}

}  // namespace delmesher::predicates
