// The chamfered surface as a piecewise linear complex.
#pragma once

#include "mesher/chamfer/bridges.h"
#include "mesher/chamfer/chamfer.h"

namespace delmesher::chamfer {

// Fills plc and plc_facet of the result; radii (in input units) must be there. If `active` is not
// empty, leaves out isolated vertices, and facets without a vertex v with active[v] != 0.
void assemble_plc(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                  const Bridges& bridges, const std::vector<std::uint8_t>& active,
                  double isolated_clearance, ChamferResult& result);

}  // namespace delmesher::chamfer
