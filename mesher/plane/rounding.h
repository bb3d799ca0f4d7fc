// From exact points to the doubles that are written, with certified orientations.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/planar_graph.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/mesh_to_write.h"

namespace delmesher::plane {

// The nearest doubles to a point, in the units of the input.
std::array<double, 2> in_input_units(const InputGraph& graph, const PointStore& points, VertexId v);

struct RoundedPlane {
  PlaneMesh mesh;
  std::vector<VertexId> vertices;  // id of each vertex of the mesh
  std::uint64_t inverted = 0, flat = 0, repaired = 0;
  // Ids of the corners of triangles that are inverted or flat, each once, in order. Empty: all are
  // positive.
  std::vector<VertexId> disturbed;
  double max_deviation = 0;  // of points on segments, in input units
};

// Rounds to the doubles that will be written and moves Steiner points by a few units in the last
// place where a triangle would not be positive.
RoundedPlane round_plane(const InputGraph& graph, const MeshToWrite& exact,
                         const PointStore& points, Control& control);

}  // namespace delmesher::plane
