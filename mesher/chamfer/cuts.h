// How far the surface is cut back: along the edges at acute vertices, and beside acute edges
// (sections 4.1 and 4.2). All lengths in the scaled coordinates of KeptSurface.
#pragma once

#include <vector>

#include "mesher/chamfer/acuteness.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// A part of a corner of an acute vertex, which gets one bridge: from the cut point A on one side
// over P and Q to the cut point B on the other, with |AP| = |PQ| = |QB| = step * distance. (With a
// bridge per triangle |AP| = |QB| may be less, beside acute edges of the triangle.)
struct CornerPart {
  Vec2 from, to;         // unit vectors along the sides, counter-clockwise
  double half_sine = 0;  // of half the angle between them
  double step = 0;
};

// The parts of a corner, counter-clockwise from its outgoing edge. Empty: the vertex is not acute.
using SplitCorner = std::vector<CornerPart>;

// 1, 2 or 4 equal parts of at most 120 degrees, from exact facts (the sign of the corner's sine)
// where doubles could err.
SplitCorner split_corner(const KeptSurface& surface, const Corner& corner, Predicates& predicates);

// One part for each triangle.
SplitCorner split_by_triangles(const KeptSurface& surface, const Corner& corner);

struct CutOptions {
  double max_radius = 0;  // in scaled coordinates; 0: no bound
  // Reach a third of the way to the link, not to the boundary of facets.
  bool to_link = false;
  bool per_triangle = false;  // split_by_triangles; needs to_link
};

struct Cuts {
  std::vector<SplitCorner> split;  // per corner of the surface
  std::vector<double> distance;    // per vertex, along its edges; 0: not acute
  // At index 2 e + k, for end k of edge e (0: its smaller vertex): the fraction of the edge cut
  // off; 0: not cut.
  std::vector<double> fraction;
  // Per half-edge of an acute edge: height of the strip removed from its facet; else 0.
  std::vector<double> height;

  // Fraction of half-edge h cut off at its tail.
  double fraction_at_tail(const SurfaceTopology& topology, std::uint32_t h) const {
    return fraction[2 * topology.edge_of[h] + (topology.from(h) > topology.to(h))];
  }
};

Cuts find_cuts(const KeptSurface& surface, const Acuteness& acute, Predicates& predicates,
               const CutOptions& options, Control& control);

// Positional accuracy wanted for the points of a bridge, in units of the chamfer distance.
double bridge_accuracy(const CornerPart& part);

}  // namespace delmesher::chamfer
