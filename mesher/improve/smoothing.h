// Moves a vertex: in the volume anywhere, in its facet, or along its edge.
#pragma once

#include <vector>

#include "mesher/improve/cone.h"
#include "mesher/improve/state.h"
#include "mesher/tetmesh/move_vertex.h"

namespace delmesher::improve {

class Smoothing {
 public:
  explicit Smoothing(State& state) : state_(state), move_(state) {}

  // Moves v to where the worst tetrahedron at it is better.
  bool improve_worst(VertexId v);
  // Moves v to where its tetrahedra are rounder on average, if the worst ones stay good enough.
  bool round_off(VertexId v);

 private:
  struct Judge;

  bool begin(VertexId v);
  void find_center();
  bool find_axis();
  Vec3 allowed(const Vec3& offset) const;
  Vec3 towards_best_apex(TetId worst, const Vec3& x) const;
  Quality worst_at(const Vec3& x, const Quality& least);
  double roundness_at(const Vec3& x, const Quality& least);
  bool measure_at(const Vec3& x, const Quality& least);
  double sum_of_roundness() const;
  bool commit(VertexId v, const Vec3& offset, const Quality& least, double roundness);
  bool becomes_too_long(TetId t, int i, const Vec3& x) const;
  bool settle(VertexId v, const Place& place, bool ok);

  State& state_;
  MoveVertex move_;
  Cone cone_;                     // v and its star
  std::vector<Quality> quality_;  // of the star where v goes, by measure_at()
  std::size_t worst_ = 0;         // of the star at the place asked last
  Vec3 axis_{};    // normal of its facet, or direction of its edge; unused if it is free
  Vec3 center_{};  // of the neighbours, if it is asked for
};

}  // namespace delmesher::improve
