// Moves a vertex to the best of several candidates: places along a line, or doubles on a lattice.
//
// The operation only proposes a place. A judge says what the star of the vertex is worth:
//   bool value_at(const Vec3& x, const Value& best, Value& value)
//                              with the vertex at x; false if that is not better than `best`
//   bool is_enough(Value)      then no other candidate is tried
//   bool ends_with_failure()   is a candidate that fails the last one?
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "mesher/geometry/vector.h"
#include "mesher/tetmesh/placed_mesh.h"

namespace delmesher::tetmesh {

class MoveVertex {
 public:
  explicit MoveVertex(const PlacedMesh& mesh) : mesh_(mesh) {}

  // Considers v, and finds its star.
  void begin(VertexId v) {
    v_ = v;
    mesh_.mesh.star(v, star_);
  }
  VertexId vertex() const { return v_; }
  std::vector<TetId>& star() { return star_; }  // in any order
  const std::vector<TetId>& star() const { return star_; }
  int corner(TetId t) const { return mesh_.mesh.index_of(t, v_); }

  // The length of the shortest edge at the vertex.
  double shortest_edge() const {
    double squared = HUGE_VAL;
    for (const TetId t : star_) {
      for (const VertexId w : mesh_.mesh.tet(t)) {
        if (w == v_) continue;
        squared = std::min(squared, squared_norm(subtract(mesh_.position(w), mesh_.position(v_))));
      }
    }
    return std::sqrt(squared);
  }
  // Is its star positive with the vertex there?
  bool fits(const Place& place) const {
    return std::ranges::all_of(star_, [&](TetId t) {
      return mesh_.is_positive_with(mesh_.mesh.tet(t), corner(t), place);
    });
  }

  // The best candidate, and its value, if it is better than `best`; else null.
  template <class Judge>
  static const Vec3* find(std::span<const Vec3> candidates, Judge&& judge, auto& best) {
    const Vec3* found = nullptr;
    for (const Vec3& x : candidates) {
      auto value = best;
      if (judge.value_at(x, best, value)) {
        found = &x;
        best = value;
        if (judge.is_enough(best)) break;
      } else if (judge.ends_with_failure()) {
        break;
      }
    }
    return found;
  }

 private:
  const PlacedMesh& mesh_;
  VertexId v_ = 0;
  std::vector<TetId> star_;
};

}  // namespace delmesher::tetmesh
