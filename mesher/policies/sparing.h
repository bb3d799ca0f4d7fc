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
  const Spared& spared() const { return spared_; }

  // After a refinement that came to grief: its crowded pieces and vertices. Where it names nothing
  // new, or has failed several times, all segments of the input, with which it always succeeds.
  void spare(const InputGraph& graph, const RefinedMesh& refined);
  // After a rounding that left triangles inverted or flat: the pieces on which points were made
  // that are corners of these. In the end all, again: triangles of the input's vertices alone are
  // not rounded. False if all were spared before.
  bool spare_disturbed(const InputGraph& graph, const Chamfered& chamfered,
                       const RefinedMesh& refined, const std::vector<VertexId>& disturbed);

 private:
  void drop(std::uint8_t& flag);
  // Also the pieces of spared vertices; all, unless more is spared than `before`, and not too
  // often.
  void complete(const InputGraph& graph, std::size_t before);

  Spared spared_;
  int failures_ = 0;
  bool all_ = false;
};

}  // namespace delmesher::plane
