// A conforming tetrahedral mesh between the stages that make, change and write it: lists of
// tetrahedra and faces, on points of a store.
//
// Laws:
//  - Tetrahedra are positive on their exact points. Those of meshes from elsewhere may be flat.
//  - A face has one tetrahedron or two.
//  - The faces of the boundary tile the facets of the surface, each once, and different regions
//    meet at these alone. (Not in the refined mesh itself, --approximate: where a facet was
//    chamfered or dropped there are no faces of it, and the regions meet without.)
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/delmesher/run.h"
#include "mesher/surface/surface_face.h"

namespace delmesher::tetmesh {

using Tet = std::array<VertexId, 4>;

// Regions: the outside, and the parts of the inside, which are numbered from 1.
using RegionId = std::uint32_t;
inline constexpr RegionId kOutside = 0, kInside = 1;

struct ConformingMesh {
  std::vector<Tet> tetrahedra;
  std::vector<RegionId> region;  // of each tetrahedron
  std::vector<SurfaceFace> boundary;
  // Per tetrahedron: which faces earlier ones have too (bits 0 to 3), and which of these are on the
  // same side of the surface (bits 4 to 7). Empty if nobody has found out.
  std::vector<std::uint8_t> repeated_faces;
};

// Of the faces of a tetrahedron that earlier ones have too, those repeated within what is written.
inline std::uint8_t repeated_within(Region region, std::uint8_t repeated) {
  return static_cast<std::uint8_t>(region == Region::interior ? repeated >> 4U : repeated & 15U);
}

// Drops the tetrahedra outside the solid.
void keep_inside(ConformingMesh& mesh);

// Without the outside, would the tetrahedra at some vertex be in parts that share no face there? It
// is so where solids touch in an edge or a vertex.
bool touches_itself(const ConformingMesh& mesh);

// Per face of the boundary the regions on its two sides, the smaller one first; kOutside where
// there is no tetrahedron.
std::vector<std::array<RegionId, 2>> regions_beside(const ConformingMesh& mesh);

// Drops the faces of the boundary with the outside on both sides. How many?
std::size_t drop_bare_faces(ConformingMesh& mesh);

// The tetrahedra that are written of a mesh, and all of its boundary. The repeated faces are those
// within the region, in bits 0 to 3.
ConformingMesh part_within(Region region, const ConformingMesh& mesh);

}  // namespace delmesher::tetmesh
