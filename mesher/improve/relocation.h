// Moves a Steiner point of an edge off the surface, into the volume below: the edge and the facets
// beside it are tiled without it, so that the surface is the same.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/improve/state.h"

namespace delmesher::improve {

class Relocation {
 public:
  explicit Relocation(State& state) : state_(state) {}

  // v is on an edge of the surface and no corner of it, with nothing beyond its faces. The point
  // goes to where the worst tetrahedron at it is best; what matters is that all are positive.
  // `fine`: also to where it is all but on the surface. False, and nothing changes, if no place is
  // found.
  bool run(VertexId v, bool fine = false);

 private:
  // A face of the surface at v, or a new one: counter-clockwise seen from outside.
  struct Face {
    std::array<VertexId, 3> vertices;
    TetId tet;  // at v, with a face of the same facet
    int face;   // that face
  };

  bool find_faces();
  static std::vector<VertexId> outline(std::span<const Face> fan);
  bool tile(FacetId facet);
  void put_on(const std::array<VertexId, 3>& face, const Face& model);
  std::size_t best_ear(const std::vector<VertexId>& polygon, const Vec3& normal) const;
  Vec3 inwards() const;
  void find_created();
  bool find_place(bool fine, Vec3& best) const;
  float worst_at(const Vec3& x) const;
  bool fits(const Place& place);

  State& state_;
  VertexId v_ = 0;
  std::vector<TetId> star_;
  std::vector<Face> old_faces_;
  std::vector<SurfaceFace> faces_;   // new ones
  std::vector<Vec3> normals_;        // of the facets
  std::vector<CreatedTet> created_;  // kNone: the point
};

}  // namespace delmesher::improve
