// Exact checks of a run in the plane. Shares no code with the mesher: rationals decide, a plain
// floating-point bound only skips what is obvious.
//
// What is checked of a PlaneRecord:
//  - points: the input vertices come first, unchanged; points on segments lie between their ends;
//  - both meshes: triangles are counter-clockwise, form a complex whose border is a rectangle, and
//    have its area; marked edges are edges of the mesh on their segment;
//  - refined: segments are covered except around chamfered corners and where they were dropped;
//    edges without segment are Delaunay; no segment that bounds a triangle in the region is
//    encroached from there (open discs); the angle bound holds for every triangle that is not
//    outside; triangles that are not mixed are met by no segment and lie where they claim;
//  - chamfer distances are at most a third of the local feature size;
//  - final: the segments are tiled completely; edges without segment are Delaunay; the sides agree
//    with a flood of its own; all vertices of the input and of the refined mesh are there;
//  - the area of the inside, and a ray from every triangle (inputs of closed rings);
// and of a PlaneMesh: vertices are the nearest doubles, or a few units in the last place away;
// triangles are counter-clockwise, exactly, as written.
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof {

struct PlaneVerdict {
  std::vector<std::string> failures;  // at most a few of each kind
  std::uint64_t checks = 0;           // signs that were decided
  bool ok() const { return failures.empty(); }
  std::string text() const;
};

// For a result with status ok and an exact record.
PlaneVerdict verify_plane(const delmesher::PlanarGraph& graph, const delmesher::Options& options,
                          const delmesher::PlaneResult& result);

}  // namespace tetproof
