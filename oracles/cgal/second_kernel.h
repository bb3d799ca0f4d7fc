// The final mesh of a record once more, with CGAL's exact kernel on points of its own.
#pragma once

#include <string>

#include "oracles/input_surface.h"
#include "oracles/report.h"

namespace tetproof::oracles {

// Reads the points from the text of the sidecar (from the record itself if the path is empty) by
// code that nothing else uses, expands them with CGAL's lazy exact numbers, and asks again:
// - are they the points that the other oracles work on?
// - is every tetrahedron positive, and on the side of the input (a ray's parity) that it is said to
//   be on?
// - does every face on a facet lie in its plane, turned outwards, with its corners on the facet,
// and
//   do their areas add up to the facet's?
// - have the tetrahedra inside the volume of the input? So do the faces, by the theorem of Gauss.
// Complete on small meshes, on a sample spread evenly over large ones; sums are complete or left
// out, and the figures say how many of each were asked.
// The input's triangles are taken as the surface has turned them; its coordinates from the input.
OracleReport check_second_kernel(const Polyhedron& input, const InputSurface& surface,
                                 const delmesher::ExactRecord& record, const ExactPoints& points,
                                 const std::string& sidecar);

}  // namespace tetproof::oracles
