// Policy: what the refinement is spared where doubles leave it no room. The last step restores it.
#pragma once

#include "mesher/plane/chamfer.h"
#include "mesher/plane/graph.h"
#include "mesher/plane/refine.h"

namespace delmesher::plane {

// Deterministic: lengths decide what is crowded, never time.
class Sparing {
 public:
  // The filter adds to it what it drops.
  Spared& spared() { return spared_; }
  const Spared& spared() const { return spared_; }

  // After a refinement that came to grief: its crowded pieces and vertices. Where it names nothing
  // new, or has failed several times, all segments of the input, with which it always succeeds.
  void spare(const InputGraph& graph, const RefinedMesh& refined);

 private:
  void drop(std::uint8_t& flag);

  Spared spared_;
  int failures_ = 0;
};

}  // namespace delmesher::plane
