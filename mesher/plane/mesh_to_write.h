// The part of an exact triangulation that is written.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/plane/refine.h"

namespace delmesher::plane {

// Triangles by vertex id, and the edges that tile the segments.
struct MeshToWrite {
  std::vector<std::array<VertexId, 3>> triangles;
  std::vector<std::uint8_t> inside;
  std::vector<double> attributes;
  std::vector<std::array<VertexId, 2>> edges;
  std::vector<PieceId> edge_pieces;
};

// Selects the triangles contained in the inside, or all for Region::hull.
MeshToWrite select(const Triangulation& mesh, const std::vector<Side>& side,
                   const std::vector<double>& attributes, Region region);

}  // namespace delmesher::plane
