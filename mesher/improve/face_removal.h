// Removes faces: those that are sandwiched between two vertices, one above them and one below, give
// way to an edge between the two (Shewchuk 2002, "Two discrete optimization algorithms for the
// topological improvement of tetrahedral meshes"). One face is the 2-3 flip; more are the inverse
// of edge removal.
#pragma once

#include <cstddef>
#include <vector>

#include "mesher/improve/state.h"

namespace delmesher::improve {

class FaceRemoval {
 public:
  explicit FaceRemoval(State& state) : state_(state) {}

  // Removes face i of t, and those beside it with which the new tetrahedra are best, if that makes
  // the worst of what they replace better.
  bool run(TetId t, int i);

 private:
  // A face x, y, z between the two vertices, by the tetrahedra above and below; x to y is
  // counter-clockwise seen from below.
  struct Side {
    TetId above, below;
    VertexId x, y, z;
  };

  Quality fill(const Side& side);
  bool beyond(const Side& side, Side& next) const;

  State& state_;
  VertexId above_ = 0, below_ = 0;
  std::vector<TetId> removed_;
  std::vector<CreatedTet> created_;
};

}  // namespace delmesher::improve
