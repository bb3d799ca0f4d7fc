// Tests only: the predicates in plain rational arithmetic, from their definitions, by textbook
// formulas that share nothing with the code under test.
#pragma once

#include <gmpxx.h>

#include <array>
#include <vector>

#include "mesher/predicates/points.h"

namespace delmesher::predicates::reference {

using Point = std::array<mpq_class, 3>;

inline mpq_class rational(double x) {
  return mpq_class(x);
}

inline Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline mpq_class dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// By Laplace expansion along the first row.
inline mpq_class determinant(const std::vector<std::vector<mpq_class>>& m) {
  if (m.size() == 1) return m[0][0];
  mpq_class sum = 0;
  for (std::size_t column = 0; column < m.size(); ++column) {
    if (sgn(m[0][column]) == 0) continue;
    std::vector<std::vector<mpq_class>> minor;
    for (std::size_t row = 1; row < m.size(); ++row) {
      minor.emplace_back();
      for (std::size_t k = 0; k < m.size(); ++k) {
        if (k != column) minor.back().push_back(m[row][k]);
      }
    }
    const mpq_class term = m[0][column] * determinant(minor);
    sum += column % 2 == 0 ? term : mpq_class(-term);
  }
  return sum;
}

// As three linear equations.
struct Equations {
  std::vector<std::vector<mpq_class>> m;
  std::vector<mpq_class> height;
};
inline Equations equations(const std::array<PlaneEquation, 3>& planes) {
  Equations result;
  for (const PlaneEquation& plane : planes) {
    std::array<Point, 3> through;
    Point normal;
    for (std::size_t i = 0; i < 3; ++i) {
      normal[i] = rational(plane.normal[i]);
      for (std::size_t k = 0; k < 3; ++k) through[k][i] = rational(plane.through[k][i]);
    }
    if (plane.spanned) normal = cross(minus(through[1], through[0]), minus(through[2], through[0]));
    result.m.push_back({normal[0], normal[1], normal[2]});
    result.height.push_back(dot(normal, through[0]));
  }
  return result;
}

inline bool meet_in_a_point(const std::array<PlaneEquation, 3>& planes) {
  return determinant(equations(planes).m) != 0;
}

// The solution, by determinants.
inline Point meeting_point(const std::array<PlaneEquation, 3>& planes) {
  const auto [m, height] = equations(planes);
  Point result;
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<std::vector<mpq_class>> replaced = m;
    for (std::size_t row = 0; row < 3; ++row) replaced[row][i] = height[row];
    result[i] = determinant(replaced) / determinant(m);
  }
  return result;
}

inline Point point(const PointStore& points, VertexId v) {
  const PointDefinition d = points.definition(v);
  const auto corner = [&](std::size_t i) { return point(points, d.corner[i]); };
  if (d.kind == PointKind::explicit_point) {
    const Vec3 x = points.nearest(v);
    return {rational(x[0]), rational(x[1]), rational(x[2])};
  }
  if (d.kind == PointKind::on_planes) {
    return meeting_point(
        {points.plane(d.corner[0]), points.plane(d.corner[1]), points.plane(d.corner[2])});
  }
  const mpq_class u = rational(d.u);
  const mpq_class w = rational(d.v);
  Point result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (d.kind == PointKind::on_segment) {
      result[i] = u * corner(0)[i] + (1 - u) * corner(1)[i];
    } else {
      result[i] = u * corner(0)[i] + w * corner(1)[i] + (1 - u - w) * corner(2)[i];
    }
  }
  return result;
}

inline int orient3d(const Point* p) {
  std::vector<std::vector<mpq_class>> m;
  for (int i = 0; i < 4; ++i) m.push_back({1, p[i][0], p[i][1], p[i][2]});
  return sgn(determinant(m));
}

inline int orient2d(int axis, const Point* p) {
  return sgn(cross(minus(p[1], p[0]), minus(p[2], p[0]))[static_cast<std::size_t>(axis)]);
}

// Positive if e is inside the sphere of a positive abcd: then (1, x, y, z, |p|^2) has a negative
// determinant. That the sign is right is tested by a known case.
inline int insphere(const Point* p) {
  std::vector<std::vector<mpq_class>> m;
  for (int i = 0; i < 5; ++i) m.push_back({1, p[i][0], p[i][1], p[i][2], dot(p[i], p[i])});
  return -sgn(determinant(m));
}

// Solves for the centre in the plane of abc; abc must not be collinear.
inline int in_diametral_ball(const Point* p) {
  const Point u = minus(p[1], p[0]);
  const Point v = minus(p[2], p[0]);
  const mpq_class uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
  const mpq_class area = uu * vv - uv * uv;
  // centre = s u + t v with centre . u = uu / 2 and centre . v = vv / 2.
  const mpq_class s = (uu * vv - vv * uv) / (2 * area);
  const mpq_class t = (vv * uu - uu * uv) / (2 * area);
  Point to_p, radius;
  for (std::size_t i = 0; i < 3; ++i) {
    radius[i] = s * u[i] + t * v[i];
    to_p[i] = p[3][i] - p[0][i] - radius[i];
  }
  return sgn(mpq_class(dot(radius, radius) - dot(to_p, to_p)));
}

inline bool collinear(const Point& a, const Point& b, const Point& c) {
  const Point n = cross(minus(b, a), minus(c, a));
  return sgn(n[0]) == 0 && sgn(n[1]) == 0 && sgn(n[2]) == 0;
}

inline int dihedral_sign(const Point* p) {
  const Point edge = minus(p[2], p[3]);
  return sgn(dot(cross(minus(p[1], p[3]), edge), cross(minus(p[0], p[3]), edge)));
}

// Is the angle of two vectors below the angle with this squared cosine?
inline bool below(const Point& u, const Point& v, double cosine_squared) {
  const mpq_class c = dot(u, v);
  return sgn(c) > 0 && c * c > rational(cosine_squared) * dot(u, u) * dot(v, v);
}

inline bool dihedral_below(const Point* p, double cosine_squared) {
  const Point edge = minus(p[2], p[3]);
  return below(cross(minus(p[1], p[3]), edge), cross(minus(p[0], p[3]), edge), cosine_squared);
}

inline bool bends_below(const Point* p, double cosine_squared) {
  const Point edge = minus(p[2], p[3]);
  return below(cross(minus(p[1], p[3]), edge), cross(edge, minus(p[0], p[3])), cosine_squared);
}

// With the projection of q - a onto the plane of abc, where it exists.
inline bool edge_plane_angle_below(const Point* p, double cosine_squared) {
  const Point w = minus(p[0], p[1]);
  const Point n = cross(minus(p[2], p[1]), minus(p[3], p[1]));
  const mpq_class nn = dot(n, n);
  if (sgn(nn) == 0) return false;
  Point projection;
  for (std::size_t i = 0; i < 3; ++i) projection[i] = w[i] - dot(w, n) / nn * n[i];
  return below(w, projection, cosine_squared);
}

}  // namespace delmesher::predicates::reference
