#include "property_tests/lies/told.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tetproof::lies {

using namespace oracles;  // NOLINT
using delmesher::ExactRecord;
using delmesher::Options;

Options honest_options() {
  Options options = samples::split_surface();
  options.want_exact = true;
  options.gabriel = true;
  options.improve = false;
  options.tau = 0x1p-9;
  return options;
}

Told run_of(const Options& options, Task task, const delmesher::Surface& surface) {
  delmesher::CdtOptions plain;
  plain.region = options.region;
  plain.want_exact = options.want_exact;
  const delmesher::Result result = task == Task::cdt
                                       ? delmesher::constrained_delaunay(surface, plain)
                                       : delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return {{samples::to_polyhedron(surface), samples::to_mesh(result.mesh)},
          result.exact,
          task == Task::cdt ? promise_of(plain) : promise_of(options)};
}

const Told& honest() {
  static const Told told = run_of(honest_options());
  return told;
}

delmesher::Surface flat_wedge() {
  return {{{0, 0, 0}, {1, 0, 0}, {0.75, 0x1p-24, 0}, {0, 0, 2}, {1, 0, 2}, {0.75, 0x1p-24, 2}},
          {{0, 2, 1}, {3, 4, 5}, {0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {2, 5, 4}, {2, 0, 3}, {2, 3, 5}},
          {}};
}

std::size_t kept_facet(const ExactRecord& r) {
  for (std::size_t f = 0; f < r.facets.size(); ++f) {
    if (r.facets[f].filtered == 0) return f;
  }
  ADD_FAILURE() << "no facet was kept";
  return 0;
}

void dagger(Told& told) {
  Options options = honest_options();
  options.tau = 0.1 / std::hypot(200, 200, 0.5);
  told = run_of(options, Task::mesh,
                samples::triangular_prism({{{0, 0}, {200, 0}, {200, 0.5}}}, 0, 200));
}

void run_hull(Told& told, Task task) {
  Options options = honest_options();
  options.region = delmesher::Region::hull;
  told = run_of(options, task);
}

void run_approximate(Told& told, const delmesher::Surface& surface) {
  Options options = honest_options();
  options.approximate = true;
  told = run_of(options, Task::mesh, surface);
}

void run_far_away(Told& told) {
  delmesher::Surface surface = samples::wedge_and_slab();
  for (auto& p : surface.vertices) {
    p[0] += 0x1p40;
    p[1] -= 0x1p41;
  }
  told = run_of(honest_options(), Task::mesh, surface);
  ASSERT_EQ(told.record.origin[0], 0x1p40);
}

void run_cdt(Told& told) {
  run_hull(told, Task::cdt);
}

}  // namespace tetproof::lies
