// The final mesh on its way through the improvement, and back.
#pragma once

#include <span>

#include "mesher/cdt/cdt.h"
#include "mesher/improve/improve.h"

namespace delmesher::results {

// Takes the tetrahedra and the boundary out of the final mesh, to be improved.
improve::ImproveMesh improvable(cdt::CdtResult& cdt);

// Puts them back. They are other tetrahedra now, so repeated_faces is emptied.
void put_in(improve::ImproveMesh mesh, cdt::CdtResult& cdt);

// The chains and Steiner points of the final mesh after its points have become others.
void follow(std::span<const VertexId> became, cdt::CdtResult& cdt);

// Drops the tetrahedra outside the solid.
void keep_inside(cdt::CdtResult& cdt);

}  // namespace delmesher::results
