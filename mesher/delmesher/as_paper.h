// The choices in which the default departs from the paper, each of which can be undone alone.
#pragma once

namespace delmesher {

// Where the default departs from what the paper says: true takes the paper's way. Each is a choice
// of its own (docs/paper.md). The angle bound of the refined mesh and the conformity of the final
// one hold with any of them.
struct AsPaper {
  // Section 4.1: chamfers reach at most a third of the way to the link, that is, to the opposite
  // edges of the triangles at a vertex and to the opposite vertices of those at an edge. Otherwise
  // to the boundary of the facets there, which is farther away.
  bool link = false;
  // Section 4.2: every triangle at a chamfered vertex has a bridge of its own, as wide as it is.
  // Otherwise every corner of a facet has one, and one for each part of at most 120 degrees of a
  // wider corner. Implies `link`, which keeps the bridges of narrow triangles apart.
  bool bridges = false;
  // Section 5.4: the bad tetrahedron with the largest radius-edge ratio is split first. Otherwise
  // the last one found within a fourth of a doubling of the squared ratio.
  bool order = false;
  // Section 5.6: bad tetrahedra are split at their circumcentre. Otherwise at an off-centre, nearer
  // to the shortest edge, where that is inside the circumball.
  bool steiner_point = false;
  // Section 6: all vertices of the refined mesh outside the chamfers are vertices of the final one,
  // those on artificial segments and those close to dropped facets, too.
  bool kept_points = false;
  // Section 6: the surface is always enriched. Otherwise a small solid that meets the bound without
  // any further point gets none.
  bool enrichment = false;
  // Section 7, first step: both sides of every pair that is too close are dropped. Otherwise, pair
  // by pair, the side that costs less.
  bool filter_pairs = false;
  // Section 7, second step: features that chamfering made smaller than tau, and both sides of them.
  // Otherwise below a 16th of tau, or in long gaps below tau, and the side that costs less.
  bool filter_chamfered = false;
  // Sections 4 and 5 as the options say, even where the refinement may not end; without limits it
  // may then run for ever. Otherwise a guard makes them stricter there.
  bool no_guard = false;

  bool operator==(const AsPaper&) const = default;
};

// Of these, those that there are in the plane (section 3).
struct PlaneAsPaper {
  bool steiner_point = false;  // triangles are split at their circumcentre
  // All vertices of the refined mesh are vertices of the final one. Otherwise those in faces that
  // encroach on what was cut off of a segment are not.
  bool kept_points = false;

  bool operator==(const PlaneAsPaper&) const = default;
};

}  // namespace delmesher
