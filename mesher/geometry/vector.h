// Small vector arithmetic in doubles. It places points and measures distances; it decides nothing
// exact.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "mesher/predicates/points.h"

namespace delmesher::geometry {

struct Vec2 {
  double x = 0, y = 0;
};

inline Vec2 operator+(Vec2 a, Vec2 b) {
  return {a.x + b.x, a.y + b.y};
}
inline Vec2 operator-(Vec2 a, Vec2 b) {
  return {a.x - b.x, a.y - b.y};
}
inline Vec2 operator*(double s, Vec2 a) {
  return {s * a.x, s * a.y};
}
inline double dot(Vec2 a, Vec2 b) {
  return a.x * b.x + a.y * b.y;
}
inline double cross(Vec2 a, Vec2 b) {
  return a.x * b.y - a.y * b.x;
}
inline double norm(Vec2 a) {
  return std::sqrt(dot(a, a));
}
inline Vec2 unit(Vec2 a) {
  return (1 / norm(a)) * a;
}
// Counter-clockwise by a right angle.
inline Vec2 turned(Vec2 a) {
  return {-a.y, a.x};
}

inline Vec3 add(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 subtract(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
// a + s b
inline Vec3 add_scaled(const Vec3& a, double s, const Vec3& b) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}
// (a - b) / scale.
inline Vec3 scaled_difference(const Vec3& a, const Vec3& b, double scale) {
  return {(a[0] - b[0]) / scale, (a[1] - b[1]) / scale, (a[2] - b[2]) / scale};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double squared_norm(const Vec3& a) {
  return dot(a, a);
}
inline double norm(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline double distance(const Vec3& a, const Vec3& b) {
  return norm(subtract(a, b));
}
inline double largest_component(const Vec3& a) {
  return std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])});
}
// a * 2^exponent, rounded only where it is subnormal.
inline Vec3 times_power_of_two(const Vec3& a, int exponent) {
  if (exponent > -1000 && exponent < 1000) {
    const auto biased = static_cast<std::uint64_t>(exponent + 1023);
    const double factor = std::bit_cast<double>(biased << 52U);
    return {a[0] * factor, a[1] * factor, a[2] * factor};
  }
  return {std::ldexp(a[0], exponent), std::ldexp(a[1], exponent), std::ldexp(a[2], exponent)};
}

}  // namespace delmesher::geometry
