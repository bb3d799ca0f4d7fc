// Chamfering of a part of the surface, as the filter repeats it.
#pragma once

#include <vector>

#include "mesher/chamfer/acuteness.h"
#include "mesher/chamfer/chamfer.h"
#include "mesher/chamfer/kept_surface.h"

namespace delmesher::chamfer {

// As chamfer(); options.facet_kept must be that of the surface, and `acute` found for it. If
// `active` is not empty, vertices v with active[v] == 0 are taken not to be acute, and facets
// without active vertices are left out of the Plc. At vertices whose neighbours are all active the
// result is that of the whole surface.
ChamferResult chamfer_surface(const KeptSurface& surface, const Acuteness& acute,
                              PointStore& points, Predicates& predicates,
                              const ChamferOptions& options,
                              const std::vector<std::uint8_t>& active, Control& control);

}  // namespace delmesher::chamfer
