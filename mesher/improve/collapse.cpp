#include "mesher/improve/collapse.h"

#include <algorithm>
#include <cmath>

namespace delmesher::improve {

bool Collapse::run(VertexId v) {
  if (state_.mobility(v) == Mobility::fixed) return false;
  operation_.begin(v);
  return take_out(v, state_.to_be_acceptable(state_.worst_of(operation_.star())));
}

bool Collapse::run(VertexId v, const Quality& least) {
  if (state_.mobility(v) == Mobility::fixed) return false;
  operation_.begin(v);
  return take_out(v, least);
}

bool Collapse::take_out(VertexId v, const Quality& least) {
  Judge judge{state_, least};
  const VertexId target = operation_.find(0, judge, state_.mobility(v) == Mobility::free);
  if (target == kNone || !certain(v, target)) return false;
  state_.contract(v, target, operation_.star());
  return true;
}

bool Collapse::certain(VertexId v, VertexId w) {
  return std::ranges::all_of(operation_.star(), [&](TetId t) {
    if (state_.mesh.index_of(t, w) >= 0) return true;
    Tet tet = state_.mesh.tet(t);
    tet[state_.mesh.index_of(t, v)] = w;
    return state_.is_positive(tet);
  });
}

float Collapse::Judge::nothing() {
  return HUGE_VALF;
}

bool Collapse::Judge::add(TetId t, int i, VertexId w, float& score) const {
  const bool counts = state.counts(t);
  const Tet& tet = state.mesh.tet(t);
  const Quality q = state.quality_with(tet, i, state.position(w), counts ? least : Quality{});
  if (!counts || !(q.dihedral > 0)) return q.dihedral > 0;
  score = std::min(score, state.score(q));
  if (!State::reaches(q, least)) return false;
  for (int k = 0; k < 4; ++k) {
    if (k != i && state.too_long(state.position(w), state.position(tet[k]), state.mesh.region(t)))
      return false;
  }
  return true;
}

}  // namespace delmesher::improve
