// Halves edges that are longer than wanted, the longest first: those in the volume, and those on
// the surface if it need not be kept.
//
// Only where that makes them shorter: next to an edge of a kept surface longer than twice the bound
// no vertex is near both of its ends.
//
// It ends: an edge gives way to such as are at most kShorter of it, or within the bound.
#pragma once

#include <cstddef>
#include <optional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/improve/state.h"

namespace delmesher::improve {

class Shortening {
 public:
  Shortening(State& state, bool on_surface, Control& control)
      : state_(state), on_surface_(on_surface), control_(control) {}

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
  // Near the middle; nothing where its points are given by two parameters.
  std::optional<Place> middle(const Edge& edge) const;
  Mobility mobility() const;
  bool split(const Edge& edge);

  State& state_;
  const bool on_surface_;
  Control& control_;
  std::priority_queue<Edge> queue_;
  std::vector<TetId> star_, ring_;
  std::vector<CreatedTet> created_;
  // Faces of the surface at the edge, each once: its third vertex, and the facet.
  std::vector<std::pair<VertexId, FacetId>> walls_;
  std::vector<SurfaceFace> faces_;
};

}  // namespace delmesher::improve
