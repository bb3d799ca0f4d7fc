// Removes a face: its two tetrahedra become three around a new edge (the 2-3 flip).
#pragma once

#include "mesher/improve/state.h"

namespace delmesher::improve {

class FaceRemoval {
 public:
  explicit FaceRemoval(State& state) : state_(state) {}

  // Removes face i of t if that makes the worse of its two tetrahedra better.
  bool run(TetId t, int i);

 private:
  State& state_;
};

}  // namespace delmesher::improve
