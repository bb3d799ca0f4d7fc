// Models far from the origin, seen from beside them.
#pragma once

#include <array>
#include <cmath>

#include "mesher/predicates/points.h"

namespace delmesher::geometry {

// Where a model is far from the origin, few doubles lie in it: none, perhaps, in a circumball whose
// tetrahedron is to be split. So its vertices are moved to the origin, which is exact, and meshed
// there, among as many doubles as anywhere else. What is written in the end are given coordinates
// again: of the doubles here, those that are doubles there, too.
struct LocalFrame {
  std::array<double, 3> origin{};  // 0: coordinates are the given ones

  bool moved() const { return origin != std::array<double, 3>{}; }
  // In given coordinates, rounded.
  Vec3 given(const Vec3& p) const { return {origin[0] + p[0], origin[1] + p[1], origin[2] + p[2]}; }
  // The nearest place that is exact in given coordinates. Differences of these from the origin are
  // exact within twice its distance from 0 (Sterbenz' lemma).
  Vec3 written(const Vec3& p) const {
    if (!moved()) return p;
    const Vec3 q = given(p);
    return {q[0] - origin[0], q[1] - origin[1], q[2] - origin[2]};
  }
};

}  // namespace delmesher::geometry
