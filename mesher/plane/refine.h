// Ruppert's Delaunay refinement of the chamfered graph, by default with off-centres (Ruppert 1995;
// Uengoer 2004; Shewchuk 2002 for corners of 60 degrees and more).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/validating.h"
#include "mesher/plane/chamfer.h"
#include "mesher/plane/sides.h"

namespace delmesher::plane {

// Proven to end up to here.
inline constexpr double kProvenDelta = 20.7;

// The steps, in their order.
enum class RefineStep : std::uint8_t {
  delaunay,   // constrained Delaunay triangulation of the chamfered graph
  segments,   // until no vertex is in the open disc of an edge on a segment
  triangles,  // until none is bad
};

struct RefineOptions {
  double delta = kProvenDelta;
  double max_edge = 0;         // in the units of the store; 0: no bound
  bool everywhere = false;     // triangles outside count as well
  bool circumcentres = false;  // SteinerPoints
  // A piece that is split so often counts as crowded, and the refinement stops; 0: no bound.
  std::uint64_t most_splits = 0;
  std::function<void(RefineStep)> on_step;  // called when a step begins, unless empty
  bool validate = kValidating;  // check the invariants after each step (Refiner::validate)
};

struct RefinedMesh {
  Triangulation mesh;
  std::vector<Side> side;        // per triangle
  std::vector<PieceId> carrier;  // per vertex id: the piece of an on-segment point, or kNone
  std::uint64_t on_segments = 0, in_faces = 0;
  double delta = 0;  // that is kept: less than asked for if that did not end
  // Pieces and vertices of the input without room between doubles, to be spared in another attempt.
  // There may be none, although there was no room, if that was far from all of the input.
  std::vector<PieceId> crowded_pieces;
  std::vector<VertexId> crowded_vertices;
  bool crowded = false;  // if not, every triangle in the region keeps the bound
  // Only for a bound beyond the proven one: refine() then begins again without that.
  bool crowded_beyond = false;
};

// Adds points to the store. Where there is no room between doubles for angles above kProvenDelta,
// these are given up, and the mesh has none of the points that were made for them. Segments end at
// the outer box; no two kept segments may form a corner below 60 degrees on a side that is refined.
RefinedMesh refine(InputGraph& graph, const Chamfered& chamfered, PointStore& points,
                   PlanePredicates& predicates, const RefineOptions& options, Control& control);

}  // namespace delmesher::plane
