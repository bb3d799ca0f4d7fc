// Statistics of exact meshes, on nearest doubles.
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/delmesher/statistics.h"
#include "mesher/refine/refine.h"

namespace delmesher {

MeshStatistics refined_statistics(const RefineResult& refined, const PointStore& points,
                                  Region region, Control& control);

// Of a final mesh's inside, before rounding.
MeshStatistics interior_statistics(const CdtResult& cdt, const PointStore& points,
                                   Control& control);

}  // namespace delmesher
