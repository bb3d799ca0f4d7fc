// Repairs by changing the tetrahedra: flips and collapses that keep every boundary face.
#pragma once

#include "mesher/output/rounded_mesh.h"
#include "mesher/tetmesh/contract_edge.h"
#include "mesher/tetmesh/remove_edge.h"
#include "mesher/tetmesh/remove_faces.h"

namespace delmesher::output {

class LocalOperations {
 public:
  explicit LocalOperations(RoundedMesh& mesh)
      : mesh_(mesh), judge_{mesh}, edges_(mesh.mesh), faces_(mesh.mesh), vertices_(mesh.mesh) {}

  // Removes the bad tetrahedron t by an operation whose new tetrahedra are all positive on the
  // rounded coordinates; with `exact_too`, also on the exact ones, so that the result is valid in
  // both senses. Tries, in this order: removing one of its edges (3-2, 4-4 and longer rings), some
  // of its faces (2-3 and more), collapsing one of its volume vertices. False if none of these can
  // be done.
  bool fix(TetId t, bool exact_too);

 private:
  // All that counts is that tetrahedra are positive.
  struct Judge {
    using Value = bool;
    RoundedMesh& mesh;

    static bool nothing() { return true; }
    static bool impossible() { return false; }
    static bool both(bool a, bool b) { return a && b; }
    static bool is_possible(bool value) { return value; }
    static bool is_known(TetId) { return false; }
    static void begin(RegionId) {}
    static bool may_join(VertexId, VertexId) { return true; }
    bool add(const Tet& tet, bool&) const { return mesh.is_positive(tet); }
    bool add(TetId t, int i, VertexId w, bool&) const;
    bool value_of(const Tet& tet, RegionId) const { return mesh.is_positive(tet); }
    static bool is_worth(bool value, bool best) { return value && !best; }
    static bool is_better(bool value, bool best) { return value && !best; }
    static bool is_enough(bool value) { return value; }
  };

  bool remove_edge(TetId t, int i, int j);
  bool remove_face(TetId t, int i);
  bool collapse(VertexId v);

  RoundedMesh& mesh_;
  Judge judge_;
  RemoveEdge<Judge> edges_;
  RemoveFaces<Judge> faces_;
  ContractEdge<Judge> vertices_;
};

}  // namespace delmesher::output
