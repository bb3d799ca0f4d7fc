#include "mesher/geometry/triangulate.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/hole_links.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::geometry {
namespace {

bool triangulate_projected(const ProjectedFace& face, Polling& polling,
                           std::vector<Triangle>& triangles) {
  bool all_holes = false;
  const Loop outer = join_holes(face, polling, all_holes);
  const bool clipped = EarClipper(face.points, outer, polling).run(triangles);
  return clipped && face.oriented && all_holes;
}

void measure_planarity(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                       FaceTriangulation& out) {
  const Triangle& t = out.triangles.front();
  const Point3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
  const Point3 normal = cross(subtract(b, a), subtract(c, a));
  const double length = norm(normal);
  for (const Loop& loop : loops) {
    for (std::uint32_t v : loop) {
      if (v == t[0] || v == t[1] || v == t[2] || orient3d_sign(a, b, c, vertices[v]) == 0) continue;
      out.planar = false;
      const double distance = std::fabs(dot(normal, subtract(vertices[v], a))) / length;
      if (std::isfinite(distance)) out.deviation = std::max(out.deviation, distance);
    }
  }
}

}  // namespace

FaceTriangulation triangulate_face(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                                   Polling& polling) {
  FaceTriangulation best;
  if (loops.size() == 1 && loops[0].size() == 3) {
    best.triangles.push_back({loops[0][0], loops[0][1], loops[0][2]});
    return best;
  }
  const int axis = dominating_axis(vertices, loops[0]);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const ProjectedFace face = project_face(vertices, loops, (axis + attempt) % 3);
    std::vector<Triangle> triangles;
    const bool simple = triangulate_projected(face, polling, triangles);
    if (attempt > 0 && !simple) continue;
    for (Triangle& t : triangles) {
      if (face.mirrored) std::swap(t[1], t[2]);
      for (std::uint32_t& v : t) v = face.vertex[v];
    }
    best.triangles = std::move(triangles);
    best.simple = simple;
    if (simple) break;
  }
  measure_planarity(vertices, loops, best);
  return best;
}

}  // namespace delmesher::geometry
