#include "mesher/output/local_operations.h"

namespace delmesher::output {

bool LocalOperations::fix(TetId t, bool exact_too) {
  mesh_.ask_exact_points(exact_too);
  for (int i = 0; i < 4; ++i) {
    for (int j = i + 1; j < 4; ++j) {
      if (remove_edge(t, i, j)) return true;
    }
  }
  for (int i = 0; i < 4; ++i) {
    if (remove_face(t, i)) return true;
  }
  for (int i = 0; i < 4; ++i) {
    if (collapse(mesh_.mesh.tet(t)[i])) return true;
  }
  return false;
}

bool LocalOperations::Judge::add(TetId t, int i, VertexId w, bool&) const {
  Tet moved = mesh.mesh.tet(t);
  moved[i] = w;
  return mesh.is_positive(moved);
}

bool LocalOperations::remove_edge(TetId t, int i, int j) {
  return edges_.find(t, i, j, RemoveEdge<Judge>::kLongest, judge_) && !edges_.is_in_facet() &&
         edges_.refill(judge_) && mesh_.accept(edges_.change());
}

bool LocalOperations::remove_face(TetId t, int i) {
  if (!faces_.find(t, i, judge_)) return false;
  return mesh_.accept(faces_.change());
}

// The neighbours of a vertex of the volume are a sphere, so positive tetrahedra fill exactly the
// space of the star.
bool LocalOperations::collapse(VertexId v) {
  if (mesh_.fixed(v) || mesh_.on_surface(v) || !mesh_.is_enclosed(v)) return false;
  vertices_.begin(v);
  const VertexId w = vertices_.find(false, judge_, true);
  if (w == kNone) return false;
  Change change{vertices_.star(), {}, {}};
  for (const TetId t : vertices_.star()) {
    if (mesh_.mesh.index_of(t, w) >= 0) continue;
    CreatedTet tet{mesh_.mesh.tet(t), mesh_.mesh.region(t)};
    tet.vertices[mesh_.mesh.index_of(t, v)] = w;
    change.created.push_back(tet);
  }
  return mesh_.accept(change);
}

}  // namespace delmesher::output
