// Checks the final mesh of a record once more, with CGAL's exact kernel on points of its own.
#pragma once

#include <string>

#include "oracles/surface/input_surface.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// Reads the points from the text of the sidecar (from the record itself if the path is empty) by
// code that nothing else uses, expands them with CGAL's exact numbers, and asks again:
// - Are they the points that the other oracles work on?
// - Is every tetrahedron positive, and on the side of the input that the record says, by the parity
//   of a ray?
// - Does every face on a facet lie in its plane, turned outwards, with its corners on the facet,
//   and do their areas add up to the facet's?
// - Have the tetrahedra inside the volume of the input? Do the faces enclose it, by the theorem of
//   Gauss?
// Checks all elements of small meshes, an evenly spread sample of large ones. Sums are complete
// or left out, and the figures say how many of each were asked. Triangles are oriented as in the
// surface. Coordinates of the input are those given, except for vertices that were moved, which the
// record defines; with `as_given` for those, too. With `kept` each triangle is a facet by itself.
OracleReport check_second_kernel(const Polyhedron& input, const InputSurface& surface,
                                 const delmesher::ExactRecord& record, const ExactPoints& points,
                                 const std::string& sidecar, bool as_given, bool kept);

}  // namespace tetproof::oracles
