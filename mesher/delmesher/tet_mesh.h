// The meshes that are written, and that improve_mesh() takes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace delmesher {

// A tetrahedral mesh; every tetrahedron (a, b, c, d) has det(b-a, c-a, d-a) > 0, except for those
// that Statistics::rounding_inverted and rounding_flat count.
struct TetMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint8_t> inside;  // per tetrahedron: 1 if contained in the solid
  // Per tetrahedron, of meshes from elsewhere and with regions; empty: 1 inside the solid, 2
  // outside.
  std::vector<std::int32_t> regions;
  // Triangles tiling the input surface, counter-clockwise seen from outside the solid, with
  // regions as given; with the label of the input and the id of the facet they tile (its
  // smallest input triangle index).
  std::vector<std::array<std::uint32_t, 3>> boundary;
  std::vector<std::int32_t> boundary_labels;
  std::vector<std::uint32_t> boundary_facets;
  // How far the boundary may be from the input surface between the vertices and edges of that, as a
  // fraction of the diagonal of the bounding box: Options::planar in force. 0: as given.
  double planar_within = 0;
};

// A part of space that the surface bounds.
struct MeshRegion {
  double volume = 0;             // rounded
  std::uint64_t tetrahedra = 0;  // none if it is not written
  // Of the smallest solid that it lies in, by volume, of those that the triangles of one label
  // bound. None: it is in none.
  std::optional<std::int32_t> label = {};
  // By the region points in it: a name of its own, the longest edge (0: any); is it a hole?
  std::string name = {};
  double max_edge = 0;
  bool is_hole = false;
};

}  // namespace delmesher
