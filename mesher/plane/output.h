// From exact triangulations to what callers get: doubles whose orientations are certified,
// statistics, records.
#pragma once

#include <span>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/planar_graph.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

// What is to be written: triangles by vertex id, the edges that tile the segments.
struct MeshToWrite {
  std::vector<std::array<VertexId, 3>> triangles;
  std::vector<std::uint8_t> inside;
  std::vector<double> attributes;
  std::vector<std::array<VertexId, 2>> edges;
  std::vector<PieceId> edge_pieces;
};

// Of a triangulation with sides: those contained in the inside, or all for Region::hull.
MeshToWrite select(const Triangulation& mesh, const std::vector<Side>& side,
                   const std::vector<double>& attributes, Region region);

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

PlaneMeshStatistics plane_statistics(std::span<const std::array<double, 2>> vertices,
                                     std::span<const std::array<std::uint32_t, 3>> triangles);

// The same for triangles given by ids, on nearest doubles.
PlaneMeshStatistics refined_statistics(const RefinedMesh& refined, const PointStore& points,
                                       Region region);

void record_points(const InputGraph& graph, const PointStore& points, PlaneRecord& record);
void record_triangles(const InputGraph& graph, const Triangulation& mesh,
                      const std::vector<Side>& side, std::vector<PlaneRecord::Triangle>& triangles,
                      std::vector<PlaneRecord::Edge>& edges);

// The chamfered graph with rounded coordinates.
PlanarGraph chamfered_graph(const InputGraph& graph, const Chamfered& chamfered,
                            const PointStore& points);

}  // namespace delmesher::plane
