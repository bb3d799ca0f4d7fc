// Puts a new point into the volume, or on the surface, where nothing else helps: a cavity around a
// bad tetrahedron grows across the faces that the point would see badly (tetmesh/insert_point.h).
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "mesher/improve/cone.h"
#include "mesher/improve/site.h"
#include "mesher/improve/state.h"
#include "mesher/tetmesh/insert_point.h"

namespace delmesher::improve {

class Insertion {
 public:
  explicit Insertion(State& state) : state_(state), operation_(state.mesh) {}

  // Replaces t and tetrahedra around it by the star of a new point, if the worst of that is clearly
  // better than the worst of these.
  bool run(TetId t);
  // The same with a point on an edge or a face that t has on the surface.
  bool run_on_surface(TetId t);

 private:
  struct Judge;
  using Operation = InsertPoint<Judge>;
  using Face = Operation::Face;
  struct Scored {
    Quality quality;
    float score;
  };
  struct Judge {
    using Value = Scored;
    const State& state;
    Vec3 x;  // where the point is

    static Scored in_plane() { return {kNotCounted, HUGE_VALF}; }
    Scored value_of(TetId t, int i) const;
  };

  Judge at(const Vec3& x) const { return {state_, x}; }
  bool try_from(TetId t, Vec3 x);
  Place place_at(const Vec3& x, double tolerance);
  float worth(const Quality& before) const;
  bool fits(const Place& place, const Quality& before);
  bool may_go(VertexId v) const;
  Vec3 middle(TetId t) const;
  std::pair<double, double> extreme_edges(TetId t) const;
  bool is_too_unequal(TetId t) const;
  void grow(const Vec3& x);
  std::vector<Face>::const_iterator face_to_cross();
  std::vector<Face>::const_iterator worst();
  bool settle(Vec3& x);
  bool in_cone(const Face& face) const;
  void build_cone();
  bool is_better_at(const Vec3& x, float score);

  State& state_;
  Site site_;
  Operation operation_;
  Cone cone_;  // the point and the skin, but for faces in its facets
};

}  // namespace delmesher::improve
