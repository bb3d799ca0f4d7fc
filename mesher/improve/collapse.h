// Contracts an edge: one of its vertices goes, and its star is filled from the other. A vertex of a
// facet goes to another one of that facet, a vertex of an input edge along that edge, so that the
// surface is the same.
#pragma once

#include <utility>
#include <vector>

#include "mesher/improve/state.h"

namespace delmesher::improve {

class Collapse {
 public:
  explicit Collapse(State& state) : state_(state) {}

  // Takes v out, to the best of its neighbours, if all tetrahedra that change are good enough
  // afterwards (State::to_be_acceptable).
  bool run(VertexId v);
  // The same, if they reach this quality.
  bool run(VertexId v, const Quality& least);

 private:
  // A tetrahedron of the star without v: the corner that v has, and whether it counts.
  struct Around {
    TetId tet;
    int corner;
    bool counts;
  };

  bool take_out(VertexId v, const Quality& least);
  void look_around(VertexId v);
  void find_targets(VertexId v);
  void find_edges_on_surface(VertexId v);
  bool stays_on_surface(VertexId v, VertexId w) const;
  float score_after(VertexId w, const Quality& least, float enough);
  bool certain(VertexId v, VertexId w);

  State& state_;
  std::vector<TetId> star_;
  std::vector<Around> around_;  // those first that forbade targets
  std::vector<VertexId> targets_;
  std::vector<std::uint32_t> mark_;  // of find_targets()
  std::uint32_t epoch_ = 0;
  std::vector<std::pair<VertexId, FacetId>> edges_;  // of the surface
};

}  // namespace delmesher::improve
