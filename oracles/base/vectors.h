// Vectors and places in doubles.
#pragma once

#include <algorithm>
#include <cmath>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

inline Position minus(const Position& p, const Position& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

inline double dot(const Position& u, const Position& v) {
  return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

inline Position cross(const Position& u, const Position& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

inline double length(const Position& u) {
  return std::sqrt(dot(u, u));
}

inline bool is_finite(const Position& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

inline double distance(const Position& p, const Position& q) {
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

inline double largest_component(const Position& p) {
  return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
}

// The unit in the last place of a double, which need not be 1.0 or larger.
inline double unit_in_last_place(double x) {
  return x == 0 ? 0x1p-1074 : std::max(std::ldexp(1.0, std::ilogb(x) - 52), 0x1p-1074);
}

// Not by hypot, for frequent use.
inline double quick_distance(const Position& p, const Position& q) {
  return length(minus(p, q));
}

inline Position between(const Position& a, const Position& b, double share) {
  Position p;
  for (std::size_t i = 0; i < 3; ++i) p[i] = a[i] + share * (b[i] - a[i]);
  return p;
}

}  // namespace tetproof::oracles
