// A surface as CGAL's packages take it.
#pragma once

#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>

#include <cstddef>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof::adapter {

template <class Polyhedron, class Point>
Polyhedron polyhedron_of(const delmesher::Surface& surface) {
  std::vector<Point> points;
  for (const auto& [x, y, z] : surface.vertices) points.emplace_back(x, y, z);
  std::vector<std::vector<std::size_t>> triangles;
  for (const auto& [a, b, c] : surface.triangles) triangles.push_back({a, b, c});
  Polyhedron polyhedron;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, polyhedron);
  return polyhedron;
}

}  // namespace tetproof::adapter
