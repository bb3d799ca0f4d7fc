// Conformity: the boundary of the tetrahedra inside tiles the input surface, facet by facet.
//
// What is checked proves tiling without a single point-in-polygon test. Every input edge between
// two facets is followed along mesh edges; these chains cut the boundary faces into patches, each
// belonging to the facet on its side of the chains. If every face of a patch lies in its facet's
// plane with the facet's orientation, and the patch is bounded by exactly the facet's chains, then
// patch and facet are chains of triangles in one plane with the same boundary, hence equal, and as
// no face is turned over there is no overlap.
#pragma once

#include <vector>

#include "oracles/input_surface.h"
#include "oracles/tet_complex.h"

namespace tetproof::oracles {

struct ConformityOptions {
  // With a tolerance, vertices may be off their facets and edges: for files whose Steiner points
  // are rounded. The same combinatorial structure is demanded, and the largest deviation measured.
  bool exact = true;
  double largest_tolerance = 1e-5;  // fraction of the diagonal
  // The same for the planes of facets alone, absolute; 0: largest_tolerance.
  double off_plane = 0;
  // Whether the first failure ends it: for a caller who only asks whether there is one.
  bool first_failure_ends = false;
  // With a tolerance: chains to try first, one per edge of the surface, as a record says. Where
  // edges are less than the tolerance apart, positions alone do not tell which mesh edge is whose.
  // They prove no less than chains that are found: what is demanded of a chain is checked.
  const std::vector<std::vector<Index>>* chains = nullptr;
};

struct ConformityResult {
  OracleReport report{"conformity", "boundary faces"};
  // Of the slab that contains each facet that was made of several (InputSurface::unite_facets).
  double slab = 0;
  double deviation = 0;  // largest distance of a surface vertex from where it belongs, rounded up
  std::vector<Face> faces;    // boundary faces of the solid, seen from outside
  std::vector<Index> facets;  // the input facet that each tiles, or kNone
  std::uint64_t chain_edges = 0;
  std::vector<std::vector<Index>> chains;  // per edge of the surface; empty: not found
  // Where it failed: edges of the surface and facets; and failures that belong to neither.
  std::vector<Index> failed_edges, failed_facets;
  std::uint64_t failed_elsewhere = 0;
};

// `surface` and `complex` use the same points. Only the flags complex.inside say what the solid is.
ConformityResult check_conformity(const TetComplex& complex, const Neighbours& neighbours,
                                  const InputSurface& surface, const ConformityOptions& options);

// Of a failure without chains from a record: does it lie only where the input's own edges are
// closer than the doubles of a file can tell? So if the whole boundary is within `distance` of the
// surface, each face of one facet, and beside each edge that failed, and some edge of
// each facet that failed, there is a vertex of the boundary, not an end of that edge, within
// `distance` of it and of another edge of the input. Positions do not say then which mesh edge is
// whose.
bool undecidable(const TetComplex& complex, const InputSurface& surface,
                 const ConformityResult& conformity, double distance);

// The triangles listed in a file as the boundary are those faces, in any order and orientation
// (faces of the hull may be listed too), and each carries the label of its facet (labels may be
// empty).
OracleReport check_boundary_list(const TetComplex& complex, const Neighbours& neighbours,
                                 const InputSurface& surface, const ConformityResult& conformity,
                                 const std::vector<Face>& listed,
                                 const std::vector<std::int32_t>& labels);

}  // namespace tetproof::oracles
