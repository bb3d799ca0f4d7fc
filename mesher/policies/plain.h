// Policy: solids that are best left as they are.
#pragma once

#include <optional>

#include "mesher/cdt/cdt.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// The plain constrained tetrahedrization, if it needs no point besides the input's vertices.
// Nothing for the hull, with max_edge or a size field, with --as-paper enrichment, and above 1000
// triangles, where it is not tried.
std::optional<cdt::CdtResult> plain_without_points(Session& session);

// That, if it meets the bound and is at least as good as the enriched one: in smallest face angle,
// smallest dihedral angle and number of tetrahedra inside. (TetGen leaves such inputs as they are,
// too.)
std::optional<cdt::CdtResult> plain_if_better(const cdt::CdtResult& enriched, Session& session);

}  // namespace delmesher::policies
