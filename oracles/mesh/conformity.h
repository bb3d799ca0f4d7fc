// Conformity: the boundary of the tetrahedra inside tiles the input surface, facet by facet.
//
// The check proves tiling without a single point-in-polygon test. Every input edge between two
// facets is followed along mesh edges. These chains cut the boundary faces into patches, each
// belonging to the facet on its side of the chains. If every face of a patch lies in its facet's
// plane with the facet's orientation, and the patch is bounded by exactly the facet's chains, then
// patch and facet are chains of triangles in one plane with the same boundary, hence equal. As no
// face is turned over there is no overlap.
//
// With a tolerance, rounding may turn faces over, but only where they are about as thin as it moves
// points, and near their facet. As chains with the same boundary, patch and facet differ by what
// faces turned over cover as often as others do. So if all that are turned over are thin and near
// the facet, nothing of the patch is anywhere else, and it covers the facet twice only there.
#pragma once

#include <span>
#include <vector>

#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

// Chains of vertices, one for each edge of a surface. They follow each other in one array: most are
// of two vertices, and an array for each takes several times the memory.
class Chains {
 public:
  void add(std::span<const Index> chain) {
    vertices_.insert(vertices_.end(), chain.begin(), chain.end());
    ends_.push_back(vertices_.size());
  }
  // Empty if none was added.
  std::span<const Index> of(std::size_t edge) const {
    if (edge >= ends_.size()) return {};
    const std::size_t first = edge == 0 ? 0 : ends_[edge - 1];
    return std::span(vertices_).subspan(first, ends_[edge] - first);
  }

 private:
  std::vector<Index> vertices_;
  std::vector<std::size_t> ends_;
};

struct ConformityOptions {
  // If false, there is a tolerance: vertices may be off their facets and edges, as in files whose
  // Steiner points are rounded. The same combinatorial structure is demanded, and the largest
  // deviation measured.
  bool exact = true;
  double largest_tolerance = 1e-5;  // fraction of the diagonal
  // The largest coordinate as given, where that is larger than those here.
  double largest_given = 0;
  // The tolerance for the planes of facets alone, in input units, beyond the slab of each; 0:
  // largest_tolerance.
  double off_plane = 0;
  // So wide a slab, too, may contain a facet and one beside it (InputSurface::is_flat_with_another)
  // that count as two only because the mesh has their edge: a point of one may be in the plane of
  // the other. In input units; with off_plane.
  double planar = 0;
  // The first failure ends the check, for a caller who only asks whether there is one.
  bool first_failure_ends = false;
  bool want_chains = false;
  // With a tolerance: chains to try first, one per edge of the surface, from a record. Where edges
  // are less than the tolerance apart, positions alone do not tell to which of them a mesh edge
  // belongs. Given chains prove no less than found ones, because their structure is checked.
  const Chains* chains = nullptr;
};

struct ConformityResult {
  OracleReport report{"conformity", "boundary faces"};
  // Width of the widest slab that contains a facet made of several (InputSurface::unite_facets), in
  // input units. Set by the caller who united them.
  double slab = 0;
  // The largest distance of a vertex from its vertex, edge or facet of the surface, rounded up: in
  // input units, and in ulp of the largest coordinate of the facet, or of the smallest one there.
  double deviation = 0, ulps = 0;
  double off_edges = 0, off_edges_ulps = 0;  // the same of the vertices of the surface's edges
  std::vector<Face> faces;    // boundary faces of the solid, counter-clockwise from outside
  std::vector<Index> facets;  // per face: the input facet that it tiles, or kNone
  std::uint64_t chain_edges = 0;
  Chains chains;  // per edge of the surface, if wanted; empty: not found
  // Where the check failed: at which edges of the surface, at which facets, and how often at
  // neither.
  std::vector<Index> failed_edges, failed_facets;
  std::uint64_t failed_elsewhere = 0;
};

// `surface` and `complex` use the same points. The solid is defined by the flags complex.inside
// alone.
ConformityResult check_conformity(const TetComplex& complex, const Neighbours& neighbours,
                                  const InputSurface& surface, const ConformityOptions& options);

// Does the check, without chains from a record, fail only where the input's own edges are closer
// together than the doubles of a file can tell? Positions do not say then to which of them a mesh
// edge belongs. For this each face of the boundary is within `ulps` (as ConformityResult::ulps) of
// one facet. Each edge that failed, and some edge of each facet that failed, has a vertex of the
// boundary so near to it, not at its ends, that is as near to another edge of the input.
bool undecidable(const TetComplex& complex, const InputSurface& surface,
                 const ConformityResult& conformity, double ulps,
                 double largest_given);  // undecidable.cpp

// The triangles that a file lists as the boundary are exactly conformity.faces, in any order, and
// each carries the label of its facet (labels may be empty). Faces of the hull may be listed too.
// If `oriented`, all are counter-clockwise from outside. How many are not is told otherwise (a
// figure): no format says which, and TetGen lists all of them the other way round.
inline constexpr const char* kTurned = "turned";
OracleReport check_boundary_list(const TetComplex& complex, const Neighbours& neighbours,
                                 const InputSurface& surface, const ConformityResult& conformity,
                                 const std::vector<Face>& listed,
                                 const std::vector<std::int32_t>& labels,
                                 bool oriented);  // boundary_list.cpp

}  // namespace tetproof::oracles
