// Chamfering in the plane (section 3): segments are cut around acute vertices, and the cut points
// are left unconnected. Also the filter (section 7): where two segments run along each other so
// closely that only a swarm of triangles could fill the channel, one is left to the last step.
#pragma once

#include <vector>

#include "mesher/base/control.h"
#include "mesher/plane/graph.h"

namespace delmesher::plane {

struct ChamferOptions {
  double cosine_squared = 0.25;  // of the angle below which a corner is acute
  double max_radius = 0;         // in the units of the store; 0: no bound
  // A channel narrower than this fraction of its length loses one of its sides; 0: none does.
  double tau = 1e-4;
  bool everywhere = false;  // also corners whose acute side is outside
};

// The pieces and vertices that the refinement is spared, from the start or after it failed at them.
struct Spared {
  std::vector<std::uint8_t> piece, vertex;  // 1: left to the last step
  std::size_t count = 0;
};

// The missing part of a piece: all of it, or the part between an acute vertex a and its cut point
// b.
struct Gap {
  VertexId a, b;
  PieceId piece;
};

struct Chamfered {
  std::vector<std::array<VertexId, 2>> ends;  // of each piece, from a to b; kNone: dropped
  std::vector<std::uint8_t> vertex_kept;      // per input vertex
  std::vector<PlaneRecord::Corner> corners;   // distances in the units of the store
  std::vector<Gap> gaps;
  std::uint64_t cut_pieces = 0, rounds = 0;
  double channel_squares = 0;  // that fit into the narrow channels that are left; 0 if tau is
};

// Pieces that the filter drops are added to `spared`. Adds the cut points to the store.
Chamfered chamfer(const InputGraph& graph, PointStore& points, PlanePredicates& predicates,
                  const ChamferOptions& options, Spared& spared, Control& control);

// Distances below this fraction of the coordinates leave no room for points between doubles.
inline constexpr double kFloor = 0x1p-42;

// Largest distance of a point of the store from the axes.
inline double magnitude(const PointStore& points, VertexId v) {
  const Approximation& a = points.approximation(v);
  return predicates::filters::larger(std::fabs(a.x), std::fabs(a.y));
}

}  // namespace delmesher::plane
