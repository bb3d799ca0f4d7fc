// Faces go where the tetrahedra beside them become better (tetmesh/remove_faces.h).
#pragma once

#include "mesher/improve/state.h"
#include "mesher/tetmesh/remove_faces.h"

namespace delmesher::improve {

class FaceRemoval {
 public:
  explicit FaceRemoval(State& state) : state_(state), operation_(state.mesh), judge_{state} {}

  // Removes face i of t, and the faces beside it with which the new tetrahedra are best, if the
  // worst of these is better than the worst of the tetrahedra that they replace.
  bool run(TetId t, int i);

 private:
  struct Judge {
    using Value = Quality;
    const State& state;
    RegionId region = kOutside;  // of the tetrahedra that are replaced

    Quality value_of(const Tet& tet, RegionId) const { return state.quality_of(tet); }
    static bool is_possible(const Quality& q) { return q.dihedral > 0; }
    bool is_enough(const Quality& q) const { return state.good(q); }
    bool is_better(const Quality& a, const Quality& b) const {
      return state.score(a) > state.score(b);
    }
    static Quality both(const Quality& a, const Quality& b) { return worse(a, b); }
    bool may_join(VertexId v, VertexId w) const {
      return !state.too_long(state.position(v), state.position(w), region);
    }
  };

  State& state_;
  RemoveFaces<Judge> operation_;
  Judge judge_;
};

}  // namespace delmesher::improve
