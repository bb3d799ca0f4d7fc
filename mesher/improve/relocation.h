// Moves a Steiner point of an edge off the surface, into the volume beside it: the edge and the
// facets at it are tiled without it, so that the surface is the same. A point goes into each wedge
// between two facets that has tetrahedra.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "mesher/improve/state.h"

namespace delmesher::improve {

class Relocation {
 public:
  explicit Relocation(State& state) : state_(state) {}

  // v is on an edge of the surface and no corner of it. A point goes to where the worst tetrahedron
  // at it is best; what matters is that all are positive. `fine`: also to where it is all but on
  // the surface. False, and nothing changes, if a wedge has no place, or is all around a free edge.
  bool run(VertexId v, bool fine = false);

 private:
  // A face of the surface at v, or a new one: counter-clockwise seen from outside its wedge.
  struct Face {
    std::array<VertexId, 3> vertices;
    TetId tet;  // at v, with a face of the same facet
    int face;   // that face
  };
  // What is between two facets.
  struct Wedge {
    std::vector<TetId> star;          // at v
    std::vector<Face> old_faces;      // of both facets
    std::vector<Vec3> normals;        // of the facets
    std::vector<CreatedTet> created;  // `point` is the new point
    VertexId point = kNone;           // kNone, kNone - 1, ...
  };
  // A facet at v, as it is tiled without it.
  struct Tiling {
    FacetId facet;
    std::vector<std::array<VertexId, 3>> triangles;  // seen from outside the wedge that was first
  };

  void find_wedges();
  bool fill(Wedge& wedge);
  FacetId facet_of(const Face& face) const { return state_.mesh.facet(face.tet, face.face); }
  static std::vector<VertexId> outline(std::span<const Face> fan);
  bool tile(FacetId facet, Wedge& wedge);
  bool cut_ears(std::vector<VertexId> polygon, const Vec3& normal, RegionId region, Tiling& tiling);
  void put_on(const std::array<VertexId, 3>& face, const Face& model, Wedge& wedge);
  std::size_t best_ear(const std::vector<VertexId>& polygon, const Vec3& normal) const;
  static Vec3 inwards(const Wedge& wedge);
  bool find_place(const Wedge& wedge, bool fine, Vec3& best) const;
  float worst_at(std::span<std::pair<Tet, int>> around, const Vec3& x, float best) const;
  bool fits(const Wedge& wedge, const Place& place);
  bool place_all(bool fine);
  bool place(const Wedge& wedge, bool fine);

  State& state_;
  VertexId v_ = 0;
  std::vector<TetId> star_;
  std::vector<Wedge> wedges_;
  std::vector<Tiling> tilings_;
  std::vector<SurfaceFace> faces_;  // new ones
  std::vector<Place> places_;       // of the wedges
};

}  // namespace delmesher::improve
