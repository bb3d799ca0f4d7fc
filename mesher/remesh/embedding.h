// Does a surface stay embedded while a patch of it changes?
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/predicates/predicates.h"
#include "mesher/remesh/changing_box_tree.h"
#include "mesher/remesh/triangle_mesh.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::remesh {

// Law: two triangles of the mesh meet in common vertices and edges alone, and nothing else of the
// mesh is in the space that a change sweeps. So components stay what they are, none passes through
// another, and what was inside or outside of the rest stays there. Exact.
class Embedding {
 public:
  // `boxes` are those of the triangles.
  Embedding(const TriangleMesh& mesh, const ChangingBoxTree& boxes, const PointStore& points,
            Predicates& predicates);

  bool allows(const Patch& patch);
  // To be called after the patch was applied.
  void commit() { see_new(); }

 private:
  bool is_free(const Triangle& face, const Patch& patch, const surface::Projection& projection);
  bool is_empty(const std::array<VertexId, 4>& tetrahedron, const Patch& patch);
  bool contains(const std::array<VertexId, 4>& tetrahedron, int sign, VertexId v);
  void see_new();

  const TriangleMesh& mesh_;
  const ChangingBoxTree& boxes_;
  const PointStore& points_;
  Predicates& predicates_;
  std::vector<surface::Projection> projection_;  // by triangle
};

}  // namespace delmesher::remesh
