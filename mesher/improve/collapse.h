// Vertices go where the tetrahedra around them stay good enough without (tetmesh/contract_edge.h).
#pragma once

#include "mesher/improve/state.h"
#include "mesher/tetmesh/contract_edge.h"

namespace delmesher::improve {

class Collapse {
 public:
  explicit Collapse(State& state) : state_(state), operation_(state.mesh) {}

  // Takes v out, to the best of its neighbours, if all tetrahedra that change are good enough
  // afterwards (State::to_be_acceptable).
  bool run(VertexId v);
  // The same, if they reach this quality.
  bool run(VertexId v, const Quality& least);

 private:
  struct Judge {
    using Value = float;  // the score of the worst
    const State& state;
    const Quality& least;

    static float nothing();
    bool add(TetId t, int i, VertexId w, float& score) const;
    static bool is_better(float score, float best) { return score > best; }
  };

  bool take_out(VertexId v, const Quality& least);
  bool certain(VertexId v, VertexId w);

  State& state_;
  ContractEdge<Judge> operation_;
};

}  // namespace delmesher::improve
