// Puts a new point into the volume, or on the surface, where nothing else helps: a cavity around a
// bad tetrahedron grows across the faces that the point would see badly, and is filled from the
// point (Klingner and Shewchuk 2007, "Aggressive tetrahedral mesh improvement").
//
// On the surface the cavity is on both sides of the point's facets: no face on them is left on its
// skin, and those within it are tiled anew from the point. It crosses no other facet, and swallows
// no vertex of the surface, so that the surface is the same.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "mesher/improve/cone.h"
#include "mesher/improve/site.h"
#include "mesher/improve/state.h"

namespace delmesher::improve {

class Insertion {
 public:
  explicit Insertion(State& state) : state_(state) {}

  // Replaces t and tetrahedra around it by the star of a new point, if the worst of that is clearly
  // better than the worst of these.
  bool run(TetId t);
  // The same with a point on an edge or a face that t has on the surface.
  bool run_on_surface(TetId t);

 private:
  struct Face {
    TetId tet;  // in the cavity
    int face;
    Quality quality;  // of its tetrahedron with the new point
  };

  bool try_from(TetId t, Vec3 x);
  Place place_at(const Vec3& x, double tolerance);
  float worth(const Quality& before) const;
  bool is_worth_it(const Quality& before) const;
  void put_in(const Place& place);
  Vec3 middle(TetId t) const;
  std::pair<double, double> extreme_edges(TetId t) const;
  bool is_too_unequal(TetId t) const;
  void grow(const Vec3& x);
  std::vector<Face>::const_iterator face_to_cross() const;
  void add(TetId t, const Vec3& x);
  Quality quality_from(TetId t, int i, const Vec3& x) const;
  bool keeps_surface();
  void find_patch();
  bool sees_outline(const Place& place);
  bool keeps_its_vertices() const;
  void measure(const Vec3& x);
  std::vector<Face>::const_iterator worst() const;
  void settle(Vec3& x);
  bool in_cone(const Face& face) const;
  void build_cone();
  bool is_better_at(const Vec3& x, float score);

  // An edge of a face that the point replaces, a tetrahedron at that face, and the index of the
  // corner there that is not on the edge.
  struct FaceEdge {
    std::array<VertexId, 2> ends;
    FacetId facet;
    TetId tet;
    int corner;
  };

  State& state_;
  Site site_;
  std::vector<TetId> cavity_;
  std::vector<Face> faces_;      // of its skin
  Cone cone_;                    // the point and these, but for those in its facets
  bool crosses_facets_ = false;  // other ones than the point's
  std::vector<CreatedTet> created_;
  std::vector<FaceEdge> patch_, outline_;  // edges within, and those that are there once
  std::vector<SurfaceFace> created_faces_;
};

}  // namespace delmesher::improve
