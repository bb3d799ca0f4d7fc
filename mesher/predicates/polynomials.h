// The polynomials whose signs the predicates are, written once for every kind of number: running
// error bounds, double-doubles, integers of fixed and of any size, rationals in tests. Degrees and
// intermediate sizes are noted because fixed integers rely on them: with all differences of
// coordinates below 2^B in magnitude, a value of degree d must stay below 2^(d (B + 2) - 1).
#pragma once

namespace delmesher::predicates::polynomials {

template <class T>
struct Triple {
  T x, y, z;
};

template <class T>
Triple<T> operator-(const Triple<T>& a, const Triple<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class T, class U>
auto dot(const Triple<T>& a, const Triple<U>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
auto cross(const Triple<T>& a, const Triple<T>& b) {
  using Product = decltype(a.x * b.y);
  return Triple<Product>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Degree 3, below 6 * 2^(3 B).
struct Orient3d {
  static constexpr int kPoints = 4;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    return dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
  }
};

// Degree 2, below 2 * 2^(2 B).
struct Orient2d {
  static constexpr int kPoints = 3;
  static constexpr bool kFixedSize = true;
  int axis;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    if (axis == 0) return area(p[0].y, p[0].z, p[1].y, p[1].z, p[2].y, p[2].z);
    if (axis == 1) return area(p[0].z, p[0].x, p[1].z, p[1].x, p[2].z, p[2].x);
    return area(p[0].x, p[0].y, p[1].x, p[1].y, p[2].x, p[2].y);
  }

 private:
  template <class T>
  static auto area(const T& ax, const T& ay, const T& bx, const T& by, const T& cx, const T& cy) {
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  }
};

// Degree 5: below 4 terms * 6 * 2^(3 B) * 3 * 2^(2 B) < 2^(5 B + 7).
//
// The determinant of rows (1, x, y, z, x^2 + y^2 + z^2) of a, b, c, d, e is positive if e is above
// the hyperplane through the lifted a, b, c, d, i.e. outside, when orient3d(a, b, c, d) > 0:
// this is its negative. Subtracting the last row leaves the 4 x 4 determinant of the differences
// and their squared lengths, here expanded along the lengths.
struct Insphere {
  static constexpr int kPoints = 5;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const Triple<T> a = p[0] - p[4];
    const Triple<T> b = p[1] - p[4];
    const Triple<T> c = p[2] - p[4];
    const Triple<T> d = p[3] - p[4];
    const auto ab = a.x * b.y - a.y * b.x;
    const auto ac = a.x * c.y - a.y * c.x;
    const auto ad = a.x * d.y - a.y * d.x;
    const auto bc = b.x * c.y - b.y * c.x;
    const auto bd = b.x * d.y - b.y * d.x;
    const auto cd = c.x * d.y - c.y * d.x;
    const auto abc = (a.z * bc - b.z * ac) + c.z * ab;
    const auto abd = (a.z * bd - b.z * ad) + d.z * ab;
    const auto acd = (a.z * cd - c.z * ad) + d.z * ac;
    const auto bcd = (b.z * cd - c.z * bd) + d.z * bc;
    return (dot(a, a) * bcd - dot(b, b) * acd) + (dot(c, c) * abd - dot(d, d) * abc);
  }
};

// (p - q) . (r - q)
struct Dot {
  static constexpr int kPoints = 3;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    return dot(p[0] - p[1], p[2] - p[1]);
  }
};

// (b - a) . (d - c)
struct DotDifference {
  static constexpr int kPoints = 4;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    return dot(p[1] - p[0], p[3] - p[2]);
  }
};

struct CompareCoordinate {
  static constexpr int kPoints = 2;
  static constexpr bool kFixedSize = true;
  int axis;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    if (axis == 0) return p[0].x - p[1].x;
    if (axis == 1) return p[0].y - p[1].y;
    return p[0].z - p[1].z;
  }
};

// With u = b - a, v = c - a, w = p - a, n = u x v, the centre of the smallest sphere is
//   m = a + (|u|^2 v x n + |v|^2 n x u) / (2 |n|^2)
//     = a + (|v|^2 (u . (u - v)) u + |u|^2 (v . (v - u)) v) / (2 |n|^2),
// and p is inside iff |w|^2 < 2 w . (m - a). Multiplied by |n|^2 = |u|^2 |v|^2 - (u . v)^2 this has
// degree 6; below 2 * (3 * 3 * 3 * 2^(6 B)) + 9 * 3 * 2^(6 B) < 2^(6 B + 7).
struct InDiametralBall {
  static constexpr int kPoints = 4;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const Triple<T> u = p[1] - p[0];
    const Triple<T> v = p[2] - p[0];
    const Triple<T> w = p[3] - p[0];
    const Triple<T> uv = p[1] - p[2];
    const auto n = cross(u, v);
    return (dot(v, v) * dot(u, uv)) * dot(w, u) - (dot(u, u) * dot(v, uv)) * dot(w, v) -
           dot(n, n) * dot(w, w);
  }
};

// [(b - d) x (c - d)] . [(a - d) x (c - d)], degree 4, below 3 * 4 * 2^(4 B).
struct Dihedral {
  static constexpr int kPoints = 4;
  static constexpr bool kFixedSize = true;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const Triple<T> edge = p[2] - p[3];
    return dot(cross(p[1] - p[3], edge), cross(p[0] - p[3], edge));
  }
};

// The squared cosine s / t of an angle, t >= 0, compared with a constant: signs of s - constant t
// together with the sign of the cosine. `minus_multiple(s, constant, t)` is a positive multiple of
// s - constant t and overloaded for every kind of number.

// Angle p q r; to be asked only if acute.
struct AngleExcess {
  static constexpr int kPoints = 3;
  static constexpr bool kFixedSize = false;
  double cosine_squared;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const Triple<T> u = p[0] - p[1];
    const Triple<T> v = p[2] - p[1];
    const auto c = dot(u, v);
    return minus_multiple(c * c, cosine_squared, dot(u, u) * dot(v, v));
  }
};

// Dihedral angle at cd; to be asked only if acute.
struct DihedralExcess {
  static constexpr int kPoints = 4;
  static constexpr bool kFixedSize = false;
  double cosine_squared;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const Triple<T> edge = p[2] - p[3];
    const auto m = cross(p[1] - p[3], edge);
    const auto n = cross(p[0] - p[3], edge);
    const auto c = dot(m, n);
    return minus_multiple(c * c, cosine_squared, dot(m, m) * dot(n, n));
  }
};

// Angle of w = q - a and the plane of abc with normal n: its squared sine is (w . n)^2 / (|w|^2
// |n|^2).
struct EdgePlaneExcess {
  static constexpr int kPoints = 4;  // q, a, b, c
  static constexpr bool kFixedSize = false;
  double cosine_squared;
  template <class T>
  auto operator()(const Triple<T>* p) const {
    const Triple<T> w = p[0] - p[1];
    const auto n = cross(p[2] - p[1], p[3] - p[1]);
    const auto s = dot(w, n);
    const auto all = dot(w, w) * dot(n, n);
    return minus_multiple(all - s * s, cosine_squared, all);
  }
};

}  // namespace delmesher::predicates::polynomials
