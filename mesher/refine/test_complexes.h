// Small surfaces and their complexes, for the tests of the refinement and of its parts.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/test_complaints.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/refine/refine.h"

namespace delmesher::refine {

inline constexpr double kDegree = 3.14159265358979323846 / 180;

inline Surface prism(const std::vector<std::array<double, 2>>& outline, double height) {
  Surface s;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0.0, height}) {
    for (const auto& p : outline) s.vertices.push_back({p[0], p[1], z});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    s.triangles.push_back({i, j, n + j});
    s.triangles.push_back({i, n + j, n + i});
  }
  // Fans from vertex 0, which must see the whole outline.
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    s.triangles.push_back({0, i + 1, i});
    s.triangles.push_back({n, n + i, n + i + 1});
  }
  return s;
}

inline Surface box() {
  return prism({{0, 0}, {3, 0}, {3, 2}, {0, 2}}, 1);
}
// The reflex corner comes first, so that the fans are inside.
inline Surface ell() {
  return prism({{1, 1}, {0, 1}, {0, 0}, {2, 0}, {2, 1}}, 0.5);
}
inline Surface wedge() {
  return prism({{0, 0}, {4, 0}, {4, 0.5}}, 1);
}

// A decagonal prism with a shallow conical roof: ten facets have corners of about 35 degrees at its
// apex, vertex 20; nothing else is below 60 degrees.
inline Surface tent() {
  std::vector<std::array<double, 2>> outline;
  for (int i = 0; i < 10; ++i) {
    outline.push_back({std::cos(36 * i * kDegree), std::sin(36 * i * kDegree)});
  }
  Surface s = prism(outline, 1);
  std::erase_if(s.triangles, [](const auto& t) { return std::ranges::min(t) >= 10; });
  s.vertices.push_back({0, 0, 1.25});
  for (std::uint32_t i = 0; i < 10; ++i) s.triangles.push_back({10 + i, 10 + (i + 1) % 10, 20});
  return s;
}

// The complex of a surface, with an outer box.
struct Complex {
  PointStore points;
  Predicates predicates{points};
  Limits limits;
  Control control{limits};
  SurfaceTopology topology;
  chamfer::ChamferResult chamfered;

  explicit Complex(const Surface& surface, double corner = 60) {
    topology = build_topology(surface, points, predicates);
    chamfer::ChamferOptions chamfering;
    chamfering.corner_cosine_squared = chamfer::cosine_squared(corner);
    chamfered = chamfer::chamfer(topology, points, predicates, chamfering, control);
    add_outer_box(topology, points, chamfered.plc);
  }

  const Plc& plc() const { return chamfered.plc; }
  // The vertices of all its segments and facets.
  std::vector<VertexId> vertices() const {
    std::vector<VertexId> all;
    for (const PlcSegment& s : plc().segments)
      all.insert(all.end(), s.vertex.begin(), s.vertex.end());
    for (const PlcFacet& f : plc().facets)
      all.insert(all.end(), f.isolated.begin(), f.isolated.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }
};

}  // namespace delmesher::refine
