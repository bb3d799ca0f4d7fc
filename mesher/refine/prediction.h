// How many tetrahedra refinement will take, before it begins: the integral of 1 / lfs^3, where
// lfs(x) is the local feature size at x, the radius of the smallest ball around x that meets two
// elements of the complex which share no point (Ruppert 1995). No mesh with angles bounded away
// from zero takes fewer than a fixed fraction of it, and Delaunay refinement takes no more than a
// fixed multiple.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/run.h"
#include "mesher/geometry/size_field.h"
#include "mesher/surface/plc.h"
#include "mesher/surface/topology.h"

namespace delmesher::refine {

// As measured: in a cube with edges of this length on average, or in a thin plate. `area`: of the
// whole surface.
double tetrahedra_of_size(double size, double volume, double area);
// The length with which there are so many.
double size_for(double tetrahedra, double volume, double area);

struct PredictionOptions {
  Region region = Region::interior;
  double max_edge = 0;               // of the mesh to come; 0: no bound
  const SizeField* sizes = nullptr;  // the same, from place to place
  double enough = HUGE_VAL;          // a larger prediction may be any number above this
};

// Tetrahedra of the final, improved mesh that refining the complex (without the outer box) will
// lead to: those inside the solid, or all down to the outer box with Region::hull. Without
// improvement there are half as many again. What a bound on edges takes is added, inside. An
// estimate, within a factor of 3 for most models (nine in ten); deterministic, and the same for a
// scaled model. `facet_kept`: per input facet, 0 if the filter dropped it; empty if it dropped
// none.
double predict_tetrahedra(const Plc& plc, const SurfaceTopology& topology,
                          const std::vector<std::uint8_t>& facet_kept, const PointStore& points,
                          const PredictionOptions& options, Control& control);

}  // namespace delmesher::refine
