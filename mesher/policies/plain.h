// Policy: solids that are best left as they are.
#pragma once

#include <optional>

#include "mesher/cdt/cdt.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// May the mesh be that of the input alone? Not for the hull, with max_edge or a size field, with
// --as-paper enrichment, and above 1000 triangles.
bool may_be_plain(const Session& session);

// The plain constrained tetrahedrization, if it may be the mesh and needs no point besides the
// input's vertices.
std::optional<cdt::CdtResult> plain_without_points(Session& session);

// That, if it meets the bound and is at least as good as the enriched one: in smallest face angle,
// smallest dihedral angle and number of tetrahedra inside. (TetGen leaves such inputs as they are,
// too.)
std::optional<cdt::CdtResult> plain_if_better(const cdt::CdtResult& enriched, Session& session);

}  // namespace delmesher::policies
