// Policy: solids that are best left as they are.
#pragma once

#include <optional>

#include "mesher/cdt/cdt.h"
#include "mesher/run/session.h"

namespace delmesher::policies {

// A solid that meets the bound without any further point needs none: its plain constrained
// tetrahedrization, where that is better than the enriched one in every respect. (TetGen leaves
// such inputs as they are, too; large ones are never among them.)
std::optional<cdt::CdtResult> plain_if_better(const cdt::CdtResult& enriched, Session& session);

}  // namespace delmesher::policies
