// Surfaces that are planar except for rounding, and runs on them with all that verification wants.
#pragma once

#include <functional>

#include "mesher/delmesher.h"
#include "mesher/surface/test_surfaces.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::planar {

// In doubles; then applies `round` to every coordinate.
delmesher::Surface rotated(const delmesher::Surface& surface,
                           const std::function<double(double)>& round);

using delmesher::surface::test_surfaces::to_single;

// Stairs of four steps with a square hole through the second: flat faces of many triangles, concave
// edges.
delmesher::Surface stairs();

struct Told {
  samples::Sample sample;
  delmesher::ExactRecord record;
  oracles::Promise promise;
  unsigned version = oracles::kRecordVersion;
  delmesher::Statistics statistics;
};

// The run must succeed.
Told run_with(const delmesher::Surface& surface, delmesher::Options options);
Told run_of(const delmesher::Surface& surface, double planar = delmesher::kPlanarAuto);

oracles::VerifyReport verdict_on(const Told& told, bool with_record = true);

}  // namespace tetproof::planar
