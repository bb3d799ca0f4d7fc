// Gift wrapping: finds the tetrahedra of a constrained Delaunay tetrahedrization one by one.
#pragma once

#include "mesher/cdt/polyhedron.h"

namespace delmesher::cdt {

// As PolyhedronFiller::fill, by gift wrapping alone: quadratic or worse, for small polyhedra.
// `vertices` are the vertices of the faces and the isolated ones, without repetition.
bool gift_wrap(Predicates& predicates, Control& control, const std::vector<Triangle>& faces,
               const std::vector<VertexId>& vertices, std::vector<Tetrahedron>& tetrahedra,
               FillCounters& counters);

}  // namespace delmesher::cdt
