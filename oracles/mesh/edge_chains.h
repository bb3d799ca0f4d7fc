// The input edges along the edges of a boundary: which of its vertices the input vertices are, and
// the chain of edges that runs along an input edge. A chain proves nothing by itself: check_facets
// and check_border (conformity.cpp) decide whether the facets beside it are tiled.
#pragma once

#include <cstdint>
#include <vector>

#include "oracles/mesh/boundary_edges.h"
#include "oracles/mesh/conformity.h"

namespace tetproof::oracles {

// Which vertex of the boundary an input vertex is: one with equal coordinates or, with a tolerance,
// the nearest one within that.
class VertexMatch {
 public:
  VertexMatch(const ExactPoints& points, const BoundaryEdges& edges, const InputSurface& surface,
              const ConformityOptions& options);

  // kNone if there is none.
  Index of(Index input_vertex) const { return match_[input_vertex]; }
  // Is a vertex of the boundary that of an input vertex?
  bool is_matched(Index v) const { return matched_[v] != 0; }
  // The input vertices that have none with equal coordinates.
  const std::vector<Index>& moved() const { return moved_; }

 private:
  Index equal_vertex(Index input_vertex) const;
  Index nearest_vertex(Index input_vertex) const;
  void sort_by_position();

  const ExactPoints& points_;
  const BoundaryEdges& edges_;
  double tolerance_;                // in input units
  std::vector<Index> by_position_;  // vertices of the boundary, once these are needed
  std::vector<Index> match_;        // per input vertex
  std::vector<std::uint8_t> matched_;
  std::vector<Index> moved_;
};

// Laws:
//  - a chain leads from the match of one end of its input edge to that of the other along boundary
//    edges, over no match of another input vertex. None of its edges but the last is in another
//    chain; that one is for the caller to report;
//  - without a tolerance its vertices are on the input edge, exactly, each beyond the one before.
class EdgeChains {
 public:
  EdgeChains(const ExactPoints& points, const BoundaryEdges& edges, const InputSurface& surface,
             const VertexMatch& match, const ConformityOptions& options)
      : points_(points), edges_(edges), surface_(surface), match_(match), options_(options) {}

  // Both ends of the input edge must have a match. False if there is no chain: then `chain` is how
  // far it was followed.
  bool find(const InputSurface::Edge& edge, std::vector<Index>& chain) const;

 private:
  bool follow(const InputSurface::Edge& edge, double tolerance, std::vector<Index>& chain) const;
  bool is_chain(const InputSurface::Edge& edge, std::span<const Index> chain) const;
  double progress(const InputSurface::Edge& edge, Index v, double& distance) const;
  bool advances(const InputSurface::Edge& edge, Index here, Index next) const;

  const ExactPoints& points_;
  const BoundaryEdges& edges_;
  const InputSurface& surface_;
  const VertexMatch& match_;
  const ConformityOptions& options_;
};

}  // namespace tetproof::oracles
