// The outer boundary of a tetrahedrization that fills a convex region: the box or the hull.
#pragma once

#include <span>

#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

struct HullOptions {
  // Rounded vertices of the boundary leave it. An edge may then be reflex by this distance, in
  // input units, and the volume may be off by twice that times the area. 0: exact.
  double allowed = 0;
  // What is filled is the hull of these points; if there are none, any convex body.
  std::span<const Index> of = {};
};

// Hull oracle: the boundary faces close up to one sphere that is convex at every edge. The
// tetrahedra, which must be positively oriented, add up to exactly the volume of the convex hull
// of the boundary, which CGAL computes (a build without CGAL leaves this out, with a note). So they
// fill the hull once: at every point of it as many tetrahedra lie as the boundary winds around it,
// which is the same number everywhere.
OracleReport check_hull(const TetComplex& complex, const Neighbours& neighbours,
                        const HullOptions& options = {});

}  // namespace tetproof::oracles
