// Statistics of exact meshes, on nearest doubles.
#pragma once

#include "mesher/cdt/cdt.h"
#include "mesher/delmesher/statistics.h"
#include "mesher/refine/refine.h"

namespace delmesher::results {

MeshStatistics refined_statistics(const refine::RefineResult& refined, const PointStore& points,
                                  Region region, Control& control);

// Of a final mesh's inside, before rounding.
MeshStatistics interior_statistics(const cdt::CdtResult& cdt, const PointStore& points,
                                   Control& control);

}  // namespace delmesher::results
