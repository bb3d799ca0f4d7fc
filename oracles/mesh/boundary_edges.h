// The edges of a boundary of triangles, and the chains that are laid along them.
//
// Laws:
//  - every side of every face is a directed edge, with the face on its left. The edges are sorted
//    by start, end and face, so that those from one vertex to another follow each other;
//  - a facet can be put on the left of the edges from a to b once. The first of these knows it.
#pragma once

#include <cstddef>
#include <vector>

#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

class BoundaryEdges {
 public:
  struct Edge {
    Index to, face;
    Index chain_facet = kNone;
  };
  // Numbers of edges: from `first` to the one before `last`.
  struct Range {
    std::size_t first, last;
    bool empty() const { return first == last; }
    std::size_t size() const { return last - first; }
  };

  // The corners of the faces are below `points`.
  BoundaryEdges(const std::vector<Face>& faces, std::size_t points);

  std::size_t size() const { return edges_.size(); }
  const Edge& operator[](std::size_t edge) const { return edges_[edge]; }
  bool has_vertex(Index v) const { return first_[v] < first_[v + 1]; }
  // The edges from a vertex, and those from a to b.
  Range from(Index v) const { return {first_[v], first_[v + 1]}; }
  Range between(Index a, Index b) const;

  // The facet on the left of the chain through an edge; kNone if there is none.
  Index left_of(std::size_t edge) const { return edges_[edge].chain_facet; }
  bool in_chain(Index a, Index b) const {
    const Range edges = between(a, b);
    return !edges.empty() && left_of(edges.first) != kNone;
  }
  // Puts the facet on the left of the edges from a to b. False if there was one already. Where
  // there is no such edge, nothing is done.
  bool put_in_chain(Index a, Index b, Index facet);

 private:
  std::vector<Edge> edges_;
  std::vector<Index> first_;  // per point: its first edge; and the end of the last one
};

}  // namespace tetproof::oracles
