// Halves edges in the volume that are longer than wanted, the longest first.
//
// Only where that makes them shorter: next to an edge of the surface longer than twice the bound
// no vertex is near both of its ends.
//
// It ends: an edge gives way to such as are at most kShorter of it, or within the bound.
#pragma once

#include <cstddef>
#include <queue>
#include <tuple>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/improve/state.h"

namespace delmesher::improve {

class Shortening {
 public:
  Shortening(State& state, Control& control) : state_(state), control_(control) {}

  // Returns the number of new points.
  std::size_t run();

 private:
  struct Edge {
    double squared;
    VertexId a, b;
    bool operator<(const Edge& o) const {
      return std::tie(squared, o.a, o.b) < std::tie(o.squared, a, b);
    }
  };

  void note(TetId t);
  bool find_ring(const Edge& edge);
  bool split(const Edge& edge);

  State& state_;
  Control& control_;
  std::priority_queue<Edge> queue_;
  std::vector<TetId> star_, ring_;
  std::vector<CreatedTet> created_;
};

}  // namespace delmesher::improve
