// The vertex that keeps a missing subsegment from being an edge.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Finds that vertex by a walk along the missing subsegment. Calls do not depend on each other; the
// object only keeps allocated memory.
class ReferenceFinder {
 public:
  ReferenceFinder(Tetrahedrization& mesh, const PointStore& points, Control& control)
      : mesh_(mesh), predicates_(mesh.predicates()), points_(points), control_(control) {}

  // Looks at the vertices of the tetrahedra around a and of those that the segment ab crosses, as
  // far as they are in its diametral ball, or all but on its sphere. Gives the vertex with the
  // largest circle through it, a and b, or kNone. Computed in doubles, because it only guides. As
  // it visits the star of a, let a be the end of lower degree.
  VertexId find(VertexId a, VertexId b);

 private:
  class Passing;
  bool meets(Passing& passing, int face);
  void visit(TetId t);
  void consider(VertexId v, VertexId a, VertexId b, double length, VertexId& best,
                double& best_sine) const;

  Tetrahedrization& mesh_;
  Predicates& predicates_;
  const PointStore& points_;
  Control& control_;
  std::vector<std::uint32_t> mark_;        // by tetrahedron: epoch_ if the walk has been there
  std::vector<std::uint32_t> considered_;  // by vertex: epoch_ if it has been
  std::uint32_t epoch_ = 0;
  std::vector<TetId> crossed_;
};

}  // namespace delmesher::cdt
