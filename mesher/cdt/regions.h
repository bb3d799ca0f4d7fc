// Facet recovery: makes the missing parts of the facets appear in the tetrahedrization.
//
// With all subsegments present in the perturbed Delaunay tetrahedrization, the constrained Delaunay
// tetrahedrization of any set of facets exists (Shewchuk 2000). So facets enter one region at a
// time: a region is a set of missing triangles connected through missing edges. No edge of the
// tetrahedrization crosses a region's boundary, and none lies in its interior; hence the
// tetrahedra whose interiors the region crosses are exactly those reached from one of them through
// faces with vertices strictly on both sides of the plane, and no face without keeps from being
// constrained Delaunay when the region becomes a wall. The region cuts their union in an upper and
// a lower polyhedron, which are filled independently. A vertex all of whose tetrahedra reach
// through the region is on no face of either (one of 7649, of a spiral squeezed flat): it is
// isolated inside.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/cdt/facet_triangles.h"
#include "mesher/cdt/polyhedron.h"

namespace delmesher::cdt {

class FacetRecovery {
 public:
  FacetRecovery(Tetrahedrization& mesh, const SurfaceTopology& topology, const Chains& chains,
                Control& control);

  // Makes all triangles of the facet appear. False if that failed, which the theory excludes; the
  // mesh is still consistent then. Appends to `found` for each triangle the face of the mesh (4 *
  // tetrahedron + face) that it was before, kNone if it was missing.
  bool recover(FacetId facet, const FacetTriangles& triangles, std::vector<std::uint32_t>& found);

  const CdtCounters& counters() const { return counters_; }

 private:
  // A face of the cavity's shell, counter-clockwise seen from outside the cavity.
  struct ShellFace {
    Triangle vertices;
    std::uint32_t inner;  // 4 * tet + face in the cavity
  };

  int side(VertexId v);
  void collect_region(const FacetTriangles& all, std::uint32_t start);
  bool recover_region();
  bool seed(const std::array<VertexId, 2>& edge);
  bool grow_cavity();
  void collect_shell();
  void collect_isolated();
  bool replace_cavity(const std::vector<Tetrahedron>& upper, const std::vector<Tetrahedron>& lower);
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

  Triangle frame_{};  // explicit triangle of the facet at hand
  std::uint32_t facet_epoch_ = 0;
  std::vector<std::uint32_t> side_mark_;  // per point: facet for which side_ was computed
  std::vector<std::int8_t> side_;

  std::vector<std::uint8_t> done_;  // per triangle of the facet at hand
  std::vector<Triangle> region_;
  std::vector<std::array<VertexId, 2>> region_border_;  // directed, region on the left
  std::vector<TetId> cavity_, ring_;
  std::vector<std::uint32_t> cavity_mark_;  // per tet
  std::uint32_t cavity_epoch_ = 0;
  std::vector<ShellFace> upper_shell_, lower_shell_;
  std::vector<VertexId> upper_isolated_, lower_isolated_;
  std::vector<std::uint32_t> shell_mark_;  // per point: cavity whose shell it is known to be on
  std::vector<VertexId> local_;            // vertices of the cavity, ascending
};

}  // namespace delmesher::cdt
