// The chamfered surface as a piecewise linear complex.
#pragma once

#include "mesher/chamfer/bridges.h"
#include "mesher/chamfer/chamfer.h"

namespace delmesher {

// Fills plc and plc_facet of the result; radii (in input units) must be there.
void assemble_plc(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                  const Bridges& bridges, double isolated_clearance, ChamferResult& result);

}  // namespace delmesher
