// Removes the faces that are sandwiched between two vertices, one above them and one below, in
// favour of an edge between the two (Shewchuk 2002, "Two discrete optimization algorithms for the
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

  // Removes face i of t, and the faces beside it with which the new tetrahedra are best, if the
  // worst of these is better than the worst of the tetrahedra that they replace.
  bool run(TetId t, int i);

 private:
  // A face x, y, z between the two vertices, by the tetrahedra above and below; x to y is
  // counter-clockwise seen from below.
  struct Side {
    TetId above, below;
    VertexId x, y, z;
  };

  Quality fill(const Side& side);
  void create(const CreatedTet& tet, const Quality& quality);
  bool beyond(const Side& side, Side& next) const;

  State& state_;
  VertexId above_ = 0, below_ = 0;
  std::vector<TetId> removed_;
  std::vector<CreatedTet> created_;
  std::vector<Quality> quality_;  // of the tetrahedra created
};

}  // namespace delmesher::improve
