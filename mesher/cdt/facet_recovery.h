// Facet recovery: makes the missing parts of the facets appear in the tetrahedrization.
//
// All subsegments are edges of the perturbed Delaunay tetrahedrization. Then the constrained
// Delaunay tetrahedrization of any set of facets exists (Shewchuk 2000), and facets can enter one
// patch at a time. A patch is a set of missing triangles that are connected through missing
// edges (a missing region in the literature).
//
// No edge of the tetrahedrization crosses the boundary of a patch or lies in its interior. So the
// tetrahedra that the patch crosses can be found from one of them: a walk through the faces that
// have vertices strictly on both sides of the plane reaches all of them and no others. These
// tetrahedra are the cavity. All other faces stay constrained Delaunay when the patch becomes a
// wall.
//
// The patch cuts the cavity into an upper and a lower polyhedron, which are filled independently.
// If all tetrahedra of a vertex reach through the patch, the vertex is on no face of either
// polyhedron and is isolated inside one of them. That is rare: it happened to one of 7649 vertices
// of a spiral squeezed flat.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/base/flat_map.h"
#include "mesher/cdt/facet_triangles.h"
#include "mesher/cdt/polyhedron.h"

namespace delmesher::cdt {

class FacetRecovery {
 public:
  FacetRecovery(Tetrahedrization& mesh, const SurfaceTopology& topology, const Chains& chains,
                Control& control);

  // Makes all triangles of the facet appear. False if that failed, which the theory excludes; the
  // mesh is still consistent then. Appends to `found` for each triangle the face of the mesh
  // that it was before, or none if it was missing.
  bool recover(FacetId facet, const PlanarTriangulation& triangles, std::vector<FaceHandle>& found);

  const CdtCounters& counters() const { return counters_; }

 private:
  // A face of the cavity's skin, counter-clockwise seen from outside the cavity.
  struct SkinFace {
    Triangle vertices;
    FaceHandle inner;  // of the cavity
  };

  int side(VertexId v);
  void collect_patch(const PlanarTriangulation& all, std::uint32_t start);
  bool recover_patch();
  bool seed(const std::array<VertexId, 2>& edge);
  bool grow_cavity();
  void collect_skin();
  void collect_isolated();
  // New tetrahedra for the cavity. `partner` and `outer` have an entry for each of their faces, at
  // its index(): what lies across the face. That is either a face of another new tetrahedron
  // (`partner`) or a face of the mesh outside the cavity (`outer`); the other entry is none.
  struct Filling {
    std::vector<Tetrahedron> tetrahedra;
    std::vector<FaceHandle> partner, outer;
  };
  bool match_faces(Filling& filling) const;
  bool match_skin(const FlatMap& owner, Filling& filling) const;
  void put_in(const Filling& filling);
  void number_vertices();
  bool keeps_all_vertices(const std::vector<Tetrahedron>& tetrahedra) const;
  std::uint64_t face_key(const Triangle& t) const;
  void add_to_cavity(TetId t);

  Tetrahedrization& mesh_;
  Predicates& predicates_;
  const SurfaceTopology& topology_;
  const Chains& chains_;
  Control& control_;
  PolyhedronFiller filler_;
  CdtCounters counters_;

  Triangle frame_{};  // explicit triangle of the facet in question
  std::uint32_t facet_epoch_ = 0;
  std::vector<std::uint32_t> side_mark_;  // per point: facet for which side_ was computed
  std::vector<std::int8_t> side_;

  std::vector<std::uint8_t> done_;  // per triangle of the facet in question
  std::vector<Triangle> patch_;
  std::vector<std::array<VertexId, 2>> patch_border_;  // directed, patch on the left
  std::vector<TetId> cavity_, ring_;
  std::vector<std::uint32_t> cavity_mark_;  // per tet
  std::uint32_t cavity_epoch_ = 0;
  std::vector<SkinFace> upper_skin_, lower_skin_;
  std::vector<VertexId> upper_isolated_, lower_isolated_;
  std::vector<std::uint32_t> skin_mark_;  // per point: cavity whose skin it is known to be on
  std::vector<VertexId> local_;           // vertices of the cavity and the patch, ascending
};

}  // namespace delmesher::cdt
