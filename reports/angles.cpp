#include "reports/angles.h"

#include <gmpxx.h>

#include <algorithm>
#include <cmath>

namespace tetproof {
namespace {

constexpr double kDegrees = 57.29577951308232;  // per radian
constexpr int kEdges[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                              {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
// A dihedral angle's rounding error is about 16 eps over the product of the sines of the two face
// angles beside the edge; below this product it could exceed 1e-10 radians.
constexpr double kNeedle = 4e-5;

template <typename T>
using Vector = std::array<T, 3>;

template <typename T>
Vector<T> cross(const Vector<T>& u, const Vector<T>& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

template <typename T>
T dot(const Vector<T>& u, const Vector<T>& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

double angle(double sine, double cosine) {
  return std::clamp(std::atan2(sine, cosine) * kDegrees, 0.0, 180.0);
}

// Half the differences q - p, scaled by a power of two if the largest component is far from 1, so
// that products of four of them neither overflow nor underflow. Differences of doubles are
// correctly rounded, so each component is right to half an ulp.
template <std::size_t N>
std::array<Vector<double>, N> scaled_differences(const std::array<const Point*, N>& from,
                                                 const std::array<const Point*, N>& to) {
  std::array<Vector<double>, N> edges;
  double largest = 0;
  for (std::size_t i = 0; i < N; ++i) {
    for (int c = 0; c < 3; ++c) {
      edges[i][c] = 0.5 * (*to[i])[c] - 0.5 * (*from[i])[c];
      largest = std::max(largest, std::fabs(edges[i][c]));
    }
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  if (exponent < -60 || exponent > 60) {
    for (auto& edge : edges) {
      for (double& x : edge) x = std::ldexp(x, -exponent);
    }
  }
  return edges;
}

Vector<mpq_class> exact_difference(const Point& a, const Point& b) {
  Vector<mpq_class> result;
  for (int c = 0; c < 3; ++c) result[c] = mpq_class(b[c]) - mpq_class(a[c]);
  return result;
}

// atan2 of sqrt(squared_sine) and cosine, whatever their size.
double exact_angle(const mpq_class& squared_sine, const mpq_class& cosine) {
  mpf_class s(squared_sine, 192), c(cosine, 192);
  s = sqrt(s);
  const mpf_class size(abs(c) > s ? abs(c) : s, 192);
  if (size == 0) return 0;
  s /= size;
  c /= size;
  return angle(s.get_d(), c.get_d());
}

double exact_dihedral(const Corners& p, const int (&e)[4]) {
  const auto edge = exact_difference(p[e[0]], p[e[1]]);
  const auto u = exact_difference(p[e[0]], p[e[2]]);
  const auto v = exact_difference(p[e[0]], p[e[3]]);
  const auto n1 = cross(edge, u), n2 = cross(edge, v);
  const mpq_class volume = dot(n1, v);
  return exact_angle(dot(edge, edge) * volume * volume, dot(n1, n2));
}

double root(const mpq_class& square) {
  const mpf_class result(sqrt(mpf_class(square, 192)), 192);
  return result.get_d();
}

// Six times the volume as `det`, twice the areas as `normals`, squared edges: then the radius of
// the inscribed sphere is det over the sum of the areas, that of the circumsphere |centre| / (2
// det), and the squared norms of S and of its inverse are half the sum of the squared edges, and
// the sum of the squared areas over 2 det^2.
constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

TetrahedronShape exact_shape(const Corners& p) {
  const auto u = exact_difference(p[0], p[1]);
  const auto v = exact_difference(p[0], p[2]);
  const auto w = exact_difference(p[0], p[3]);
  const mpq_class det = dot(cross(u, v), w);
  if (det == 0) return {};
  const auto vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  Vector<mpq_class> centre;
  for (int c = 0; c < 3; ++c) centre[c] = dot(u, u) * vw[c] + dot(v, v) * wu[c] + dot(w, w) * uv[c];
  mpf_class areas(0, 192);
  mpq_class squared_areas = 0, squared_edges = 0;
  for (const auto& f : kFaces) {
    const auto n = cross(exact_difference(p[f[0]], p[f[1]]), exact_difference(p[f[0]], p[f[2]]));
    squared_areas += dot(n, n);
    areas += sqrt(mpf_class(dot(n, n), 192));
  }
  for (const auto& e : kEdges) {
    const auto edge = exact_difference(p[e[0]], p[e[1]]);
    squared_edges += dot(edge, edge);
  }
  const mpf_class radii = areas * sqrt(mpf_class(dot(centre, centre), 192));
  const mpf_class gamma(6 * mpf_class(det * det, 192) / radii, 192);
  return {gamma.get_d(), 6 * root(mpq_class(det * det / (squared_edges * squared_areas)))};
}

bool finite(const Corners& p) {
  return std::all_of(p.begin(), p.end(), [](const Point& q) {
    return std::isfinite(q[0]) && std::isfinite(q[1]) && std::isfinite(q[2]);
  });
}

int exact_orientation(const Corners& p) {
  const auto u = exact_difference(p[0], p[1]);
  const auto v = exact_difference(p[0], p[2]);
  const auto w = exact_difference(p[0], p[3]);
  return sgn(dot(cross(u, v), w));
}

}  // namespace

int orientation(const Corners& p) {
  Vector<double> u, v, w;
  for (int c = 0; c < 3; ++c) {
    u[c] = p[1][c] - p[0][c];
    v[c] = p[2][c] - p[0][c];
    w[c] = p[3][c] - p[0][c];
  }
  double determinant = 0, permanent = 0;
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    const double left = u[d] * v[e], right = u[e] * v[d];
    determinant += (left - right) * w[c];
    permanent += (std::fabs(left) + std::fabs(right)) * std::fabs(w[c]);
  }
  // Shewchuk's first bound for orient3d, (7 + 56 eps) eps with eps = 2^-53, rounded up. Products
  // near underflow are decided exactly, as are overflows.
  constexpr double kBound = 7.8e-16;
  if (permanent > 1e-250 && std::isfinite(permanent)) {
    if (determinant > kBound * permanent) return 1;
    if (-determinant > kBound * permanent) return -1;
  }
  return finite(p) ? exact_orientation(p) : 0;
}

std::array<double, 3> triangle_angles(const Point& a, const Point& b, const Point& c) {
  const auto e = scaled_differences<3>({&a, &b, &c}, {&b, &c, &a});
  std::array<double, 3> angles;
  for (int i = 0; i < 3; ++i) {
    const auto& out = e[i];
    const auto& in = e[(i + 2) % 3];
    const auto n = cross(in, out);
    angles[i] = angle(std::sqrt(dot(n, n)), -dot(in, out));
  }
  return angles;
}

std::array<double, 6> dihedral_angles(const Corners& p) {
  const auto d = scaled_differences<6>({&p[0], &p[0], &p[0], &p[1], &p[1], &p[2]},
                                       {&p[1], &p[2], &p[3], &p[2], &p[3], &p[3]});
  constexpr int kIndex[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  const auto between = [&](int i, int j) {
    const auto& e = d[kIndex[i][j]];
    return i < j ? e : Vector<double>{-e[0], -e[1], -e[2]};
  };
  std::array<double, 6> angles;
  for (int k = 0; k < 6; ++k) {
    const auto& e = kEdges[k];
    const auto edge = between(e[0], e[1]), u = between(e[0], e[2]), v = between(e[0], e[3]);
    const auto n1 = cross(edge, u), n2 = cross(edge, v);
    const double squared = dot(edge, edge);
    const double areas = std::sqrt(dot(n1, n1)) * std::sqrt(dot(n2, n2));
    const double lengths = squared * std::sqrt(dot(u, u)) * std::sqrt(dot(v, v));
    if (areas > kNeedle * lengths) {
      angles[k] = angle(std::sqrt(squared) * std::fabs(dot(n1, v)), dot(n1, n2));
    } else {
      angles[k] = finite(p) ? exact_dihedral(p, e) : 0;
    }
  }
  return angles;
}

TetrahedronShape tetrahedron_shape(const Corners& p) {
  const auto d = scaled_differences<6>({&p[0], &p[0], &p[0], &p[1], &p[1], &p[2]},
                                       {&p[1], &p[2], &p[3], &p[2], &p[3], &p[3]});
  const auto &u = d[0], &v = d[1], &w = d[2];
  const auto vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
  const double det = std::fabs(dot(u, vw));
  const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  double squared_edges = 0;
  for (const auto& edge : d) squared_edges += dot(edge, edge);
  // A tetrahedron far from flat loses nothing to rounding.
  constexpr double kFlat = 1e-5;
  const double size = squared_edges * std::sqrt(squared_edges);
  if (!(det > kFlat * size)) return finite(p) ? exact_shape(p) : TetrahedronShape{};
  double areas = 0, squared_areas = 0;
  for (const auto& n : {cross(d[3], d[4]), vw, wu, uv}) {
    const double squared = dot(n, n);
    squared_areas += squared;
    areas += std::sqrt(squared);
  }
  Vector<double> centre;
  for (int c = 0; c < 3; ++c) centre[c] = uu * vw[c] + vv * wu[c] + ww * uv[c];
  const double radii = areas * std::sqrt(dot(centre, centre));
  return {6 * det * det / radii, 6 * det / std::sqrt(squared_edges * squared_areas)};
}

}  // namespace tetproof
