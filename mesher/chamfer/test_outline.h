// The outline of a facet of a chamfered surface, measured in its plane.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "mesher/chamfer/test_plc_angles.h"

namespace delmesher::chamfer {

inline std::array<double, 2> flat(const PlcFacet& facet, const plc_angles::QuadPoint& p) {
  const int x = (facet.axis + 1) % 3, y = (facet.axis + 2) % 3;
  return {static_cast<double>(p[x]), facet.axis_sign * static_cast<double>(p[y])};
}

inline double turn(const std::array<double, 2>& a, const std::array<double, 2>& b,
                   const std::array<double, 2>& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

struct Outline {
  double area = 0;
  int crossings = 0;
};

// Signed area inside a facet's boundary, and the number of pairs of sides that cross.
inline Outline outline(const Plc& plc, const PlcFacet& facet, const PointStore& points) {
  std::vector<std::array<std::array<double, 2>, 2>> sides;
  Outline result;
  const auto origin = plc_angles::position(points, facet.frame[0]);
  for (const PlcFacet::Side& side : facet.boundary) {
    auto v = plc.segments[side.segment].vertex;
    if (side.reversed) std::swap(v[0], v[1]);
    std::array<std::array<double, 2>, 2> ends;
    for (int k = 0; k < 2; ++k) {
      auto p = plc_angles::position(points, v[k]);
      for (int i = 0; i < 3; ++i) p[i] -= origin[i];
      ends[k] = flat(facet, p);
    }
    result.area += 0.5 * (ends[0][0] * ends[1][1] - ends[0][1] * ends[1][0]);
    sides.push_back(ends);
  }
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto &a = sides[i][0], &b = sides[i][1], &c = sides[j][0], &d = sides[j][1];
      if (a == c || a == d || b == c || b == d) continue;
      result.crossings += turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
    }
  }
  return result;
}

}  // namespace delmesher::chamfer
