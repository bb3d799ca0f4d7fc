// Policy: segments and vertices that are left out of the refinement because doubles leave no room
// for new points beside them, or for their own written coordinates. The last step restores them.
#pragma once

#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

// Deterministic: lengths decide what is crowded, never time.
class Sparing {
 public:
  // The filter adds the segments that it drops.
  Spared& spared() { return spared_; }

  // After a refinement that found no room: spares its crowded pieces and vertices. If these are
  // nothing new, or after several failures, spares all segments of the input; without them the
  // refinement always succeeds.
  void spare(const InputGraph& graph, const RefinedMesh& refined);
  // After a rounding that left triangles inverted or flat (`disturbed`: their corners): spares the
  // pieces that such a corner was put on, in the end all segments of the input, whose own vertices
  // are not rounded. False if all were spared before.
  bool spare_disturbed(const InputGraph& graph, const Chamfered& chamfered,
                       const RefinedMesh& refined, const std::vector<VertexId>& disturbed);

 private:
  void drop(std::uint8_t& flag);
  // Ends an attempt: spares the pieces of spared vertices, too. Spares everything if nothing was
  // added since `before`, or if there were too many attempts.
  void complete(const InputGraph& graph, std::size_t before);

  Spared spared_;
  int failures_ = 0;
  bool all_ = false;
};

}  // namespace delmesher::plane
