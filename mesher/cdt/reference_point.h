// The vertex that keeps a missing subsegment from being an edge.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Walks along missing subsegments. Between two calls it remembers nothing but memory.
class ReferenceFinder {
 public:
  ReferenceFinder(Tetrahedrization& mesh, const PointStore& points, Control& control)
      : mesh_(mesh), predicates_(mesh.predicates()), points_(points), control_(control) {}

  // Of the vertices of the tetrahedra that the segment ab crosses, and of these only the ones in
  // its diametral ball, the vertex with the largest circle through it, a and b; kNone without any.
  // In doubles: it only guides. The star of a is visited: a should be the end of lower degree.
  VertexId find(VertexId a, VertexId b);

 private:
  bool meets(VertexId a, VertexId b, VertexId p, VertexId q, VertexId r);
  void visit(TetId t);
  void consider(VertexId v, const Vec3& p, const Vec3& q, double length, VertexId& best,
                double& best_sine) const;

  Tetrahedrization& mesh_;
  Predicates& predicates_;
  const PointStore& points_;
  Control& control_;
  std::vector<std::uint32_t> mark_;  // by tetrahedron: epoch_ if the walk has been there
  std::uint32_t epoch_ = 0;
  std::vector<TetId> crossed_;
};

}  // namespace delmesher::cdt
