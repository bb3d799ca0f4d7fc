// The changes of the constrained Delaunay mesh by local operations: the improvement, and repairs of
// rounding.
#pragma once

#include "oracles/record/enrichment.h"

namespace tetproof::oracles {

// How many edges away from a cause its effects may be: repairs take out points up to three edges
// away, and in turn repair the tetrahedra which that disturbs; operations of the improvement follow
// one on another.
inline constexpr int kOperationsReach = 8;

// Checks a mesh that was not improved (--improve off), after repairs of rounding: no vertex is new,
// and each changed tetrahedron is at most kOperationsReach edges away from one that is not positive
// on the nearest doubles. A record without a refined mesh will do.
OracleReport check_repairs(const delmesher::ExactRecord& record, const ExactPoints& points,
                           const Promise& promise);

// Checks an improved mesh (--improve), in the region: where a face angle is below the promised
// bound, or a dihedral angle flatter than kImprovedDihedral degrees (the angle or its rest to 180
// degrees, whichever is smaller), a tetrahedron at least as bad was there before, at most
// kOperationsReach edges away along edges of either mesh; so neither the smallest nor the flattest
// one becomes worse, and nothing bad is made where all was good. One that was not positive on the
// nearest doubles, or on those that are doubles in given coordinates, too, counts as flat, as
// repairs of rounding may follow there. Where all vertices have moved so far around, the edges are
// counted from a tetrahedron of the mesh before whose bounding box meets that of the bad one; how
// many need this is the figure kByPlace, which a report has only then. No edge longer than
// --max-edge or than --size-field allows is new.
//
// Measured on the nearest doubles, where the improvement weighs its steps, by doubles with a
// relative slack of 1e-6.
inline constexpr double kImprovedDihedral = 17;
inline constexpr char kByPlace[] = "explained by their place";
// `returned`: the vertices on edges of the surface that the mesh before did not have, because it
// was one of a stand-in; near them, as far as along as many edges, anything may be bad; as near
// edges that were too long before, which `mesh` halves.
OracleReport check_improvement(const delmesher::ExactRecord& record, const ExactPoints& points,
                               const Promise& promise, const std::vector<Index>& returned = {});

}  // namespace tetproof::oracles
