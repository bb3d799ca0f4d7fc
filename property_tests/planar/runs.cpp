#include "property_tests/planar/runs.h"

#include <gtest/gtest.h>

namespace tetproof::planar {

using namespace oracles;  // NOLINT
using delmesher::Options;
using delmesher::Surface;

// In doubles; then applies `round` to every coordinate.
Surface rotated(const Surface& surface, const std::function<double(double)>& round) {
  Surface s = delmesher::surface::test_surfaces::rotated(surface);
  for (Position& p : s.vertices) {
    for (double& x : p) x = round(x);
  }
  return s;
}

Surface stairs() {
  return samples::to_surface(samples::grid_sample(4, 1, [](int x, int y, int z) {
                               return (x != 1 || y != 1) && z <= x;
                             }).input);
}

Told run_with(const Surface& surface, Options options) {
  options.want_exact = true;
  const delmesher::Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return {{samples::to_polyhedron(surface), samples::to_mesh(result.mesh)},
          result.exact,
          promise_of(options),
          kRecordVersion,
          result.statistics};
}

Told run_of(const Surface& surface, double planar) {
  Options options = samples::split_surface();
  options.planar = planar;
  return run_with(surface, options);
}

VerifyReport verdict_on(const Told& told, bool with_record) {
  VerifyReport report;
  EXPECT_EQ(verify(told.sample.input, told.sample.mesh, with_record ? &told.record : nullptr,
                   {.stage = told.promise.approximate ? Stage::refined
                             : with_record            ? Stage::both
                                                      : Stage::final,
                    .promised = told.promise,
                    .record_version = told.version},
                   report),
            "");
  return report;
}

}  // namespace tetproof::planar
