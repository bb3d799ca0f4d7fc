// The chamfered surface as a piecewise linear complex.
#pragma once

#include "mesher/chamfer/bridges.h"
#include "mesher/chamfer/chamfer.h"

namespace delmesher::chamfer {

// Fills plc and plc_facet of the result, whose vertex_radius must be there. If `active` is not
// empty, leaves out isolated vertices, and facets none of whose vertices v has active[v] != 0.
void assemble_plc(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                  const Bridges& bridges, const std::vector<std::uint8_t>& active,
                  double isolated_clearance, ChamferResult& result);

}  // namespace delmesher::chamfer
