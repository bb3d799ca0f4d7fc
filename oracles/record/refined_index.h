// What the exact record says of the refined mesh, by the input's facets and edges.
//
// Law: nothing is taken on trust. A facet or an edge that the record names and the surface does not
// have is not found.
#pragma once

#include <string>
#include <vector>

#include "oracles/base/simplex_set.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// Finds facets of the surface by id, and says which of them the filter kept. The surface must
// outlive this.
class FacetIndex {
 public:
  FacetIndex(const InputSurface& surface, const delmesher::ExactRecord& record);
  Index find(Index id) const;  // kNone if there is no such facet
  bool kept(Index facet) const { return kept_[facet] != 0; }
  // Why the record's list of facets is not that of the surface; empty if it is, or if there is
  // none.
  const std::string& defect() const { return defect_; }

 private:
  const InputSurface& surface_;
  std::vector<std::uint8_t> kept_;
  std::string defect_;
};

// Finds edges of the input between two facets, and the one on which a chain of the record lies.
class InputEdges {
 public:
  explicit InputEdges(const InputSurface& surface);
  Index find(Index a, Index b) const;  // index into surface.edges(), or kNone
  // Judged by the chain's points alone: its first point on a segment names the edge, else its ends
  // do. kNone if there is no such edge.
  Index of_chain(const delmesher::ExactRecord& record, const std::vector<Index>& chain) const;

 private:
  SimplexSet<2> ends_;
  std::vector<Index> edge_;  // per pair of ends
};

// The sign of the cosine of the angle between an input edge and the way from p to q.
int along_edge(const ExactPoints& points, const InputSurface::Edge& edge, Index p, Index q);

// Visits the faces of tetrahedra that are in the set: tetrahedron, number of the opposite corner,
// number in the set. Few tetrahedra have three corners there, so most need no search.
template <class Visit>
void for_each_face_in(const SimplexSet<3>& set, const std::vector<Tet>& tetrahedra,
                      const Visit& visit) {
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const unsigned among = set.corners_among(tetrahedra[t]);
    for (int i = 0; i < 4; ++i) {
      if ((among | 1U << i) != 15) continue;
      const std::size_t face = set.find(face_of(tetrahedra[t], i));
      if (face < set.size()) visit(t, i, face);
    }
  }
}

// The edges of all chains, and the faces on all facets.
SimplexSet<2> edges_of_chains(const delmesher::ExactRecord& record);
SimplexSet<3> faces_on_facets(const delmesher::ExactRecord& record);

}  // namespace tetproof::oracles
