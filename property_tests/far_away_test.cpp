// Surfaces far from the origin, of few roundings of their coordinates: meshed beside it, written
// where they are (mesher/results/units.h), and verified with the record.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::far_away_test {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Options;
using delmesher::Result;
using delmesher::Surface;

using Position = std::array<double, 3>;

Surface moved(Surface surface, const Position& by) {
  for (Position& p : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double sum = p[i] + by[i];
      EXPECT_EQ(sum - by[i], p[i]) << "the test's own surface has no doubles there";
      p[i] = sum;
    }
  }
  return surface;
}

// The least corner at 0.
Surface cornered(const Surface& surface) {
  Position low = surface.vertices[0];
  for (const Position& p : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]);
  }
  return moved(surface, {-low[0], -low[1], -low[2]});
}

// All have coordinates that are multiples of 1/16.
std::vector<samples::NamedSurface> solids() {
  Surface wedge = samples::triangular_prism({{{0, 0}, {1, 0}, {1, 0.1875}}}, 0, 1);
  samples::add_box(wedge, {2, 0, 0}, {3, 1, 0.125});
  std::vector<samples::NamedSurface> all = {{"wedge", wedge}};
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    all.push_back({"voxels", samples::random_voxels(seed)});
    all.push_back({"star", samples::quantized_star(seed)});
  }
  for (samples::NamedSurface& solid : all) solid.surface = cornered(solid.surface);
  return all;
}

void expect_verified(const Surface& surface, const oracles::Promise& promise,
                     const Result& result) {
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  VerifyReport report;
  const Stage stage = promise.approximate         ? Stage::refined
                      : promise.task == Task::cdt ? Stage::final
                                                  : Stage::both;
  EXPECT_EQ(verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh), &result.exact,
                   {.stage = stage, .promised = promise}, report),
            "");
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
}

Options with_record() {
  Options options = samples::split_surface();
  options.want_exact = true;
  return options;
}

delmesher::CdtOptions cdt_with_record() {
  delmesher::CdtOptions options;
  options.want_exact = true;
  options.region = delmesher::Region::interior;
  return options;
}

constexpr Position kFar = {0x1p40, -0x1p41, 0x1.8p39};

// Nothing but the origin of the record, and the roundings, tells that it is far away: the same
// tetrahedra, the same points beside the origin. The planar bound is of the coordinates as given,
// so it is left out.
TEST(FarAway, IsMeshedLikeNearby) {
  const delmesher::CdtOptions options = cdt_with_record();
  for (const auto& [name, surface] : solids()) {
    SCOPED_TRACE(name);
    const Result near = delmesher::constrained_delaunay(surface, options);
    const Result far = delmesher::constrained_delaunay(moved(surface, kFar), options);
    ASSERT_TRUE(near.status.ok() && far.status.ok()) << far.status.message;
    EXPECT_EQ(near.exact.origin, Position{});
    for (std::size_t i = 0; i < 3; ++i) {
      double low = HUGE_VAL;
      for (const Position& p : surface.vertices) low = std::min(low, p[i] + kFar[i]);
      EXPECT_EQ(far.exact.origin[i], low);
    }
    ASSERT_EQ(near.exact.points.size(), far.exact.points.size());
    for (std::size_t v = 0; v < near.exact.points.size(); ++v) {
      const auto &p = near.exact.points[v], &q = far.exact.points[v];
      EXPECT_TRUE(p.kind == q.kind && p.x == q.x && p.y == q.y && p.z == q.z) << v;
    }
    EXPECT_EQ(near.mesh.tetrahedra, far.mesh.tetrahedra);
  }
}

TEST(FarAway, PassesTheOraclesWithEveryOption) {
  std::vector<Options> choices(7, with_record());
  choices[1].planar = 0;
  choices[2].region = delmesher::Region::hull;
  choices[3].approximate = true;
  choices[4].max_edge = 0.5;
  choices[5].size_field = {{{0x1p40 + 0.5, -0x1p41 + 0.5, 0x1.8p39}, 0.25}};
  choices[6].improve = false;
  for (const auto& [name, surface] : solids()) {
    const Surface far = moved(surface, kFar);
    for (std::size_t n = 0; n < choices.size(); ++n) {
      const bool fine = !choices[n].size_field.empty() || choices[n].max_edge > 0;
      if (fine && name != "wedge") continue;  // the others are large: many tetrahedra
      SCOPED_TRACE(name + ", choice " + std::to_string(n));
      expect_verified(far, promise_of(choices[n]), delmesher::tetrahedralize(far, choices[n]));
    }
    SCOPED_TRACE(name + ", cdt");
    const delmesher::CdtOptions plain = cdt_with_record();
    expect_verified(far, promise_of(plain), delmesher::constrained_delaunay(far, plain));
  }
}

// As many tetrahedra as nearby, except for what the filter does at roundings: before, circumballs
// had no double in them here, and the run ended.
TEST(FarAway, OfFewRoundingsIsMeshed) {
  for (const auto& [name, surface] : solids()) {
    if (name == "wedge") continue;  // it has no doubles there
    for (const double away : {0x1p44, 0x1p49}) {
      SCOPED_TRACE(name + " at " + std::to_string(std::log2(away)));
      const Surface far = moved(surface, {away, -away, 0});
      expect_verified(far, promise_of(with_record()),
                      delmesher::tetrahedralize(far, with_record()));
    }
  }
}

// A prism of seven by twelve by eight roundings, skew: the points that are added have too few
// doubles, the eight of the input have theirs.
TEST(FarAway, WithoutRoomForPointsIsMeshedWithoutThem) {
  const Surface solid = {{{756955.7841794551, 16384.000000000255, 16777216},
                          {756955.7841794548, 16384.000000000564, 16777216},
                          {756955.7841794546, 16384.000000000255, 16777216},
                          {756955.7841794548, 16384, 16777216},
                          {756955.7841794554, 16384.000000000255, 16777216.00000003},
                          {756955.7841794551, 16384.000000000564, 16777216.00000003},
                          {756955.7841794547, 16384.000000000255, 16777216.00000003},
                          {756955.7841794544, 16384, 16777216.00000003}},
                         {{3, 1, 0},
                          {1, 3, 2},
                          {7, 4, 5},
                          {5, 6, 7},
                          {0, 1, 5},
                          {0, 5, 4},
                          {1, 2, 6},
                          {1, 6, 5},
                          {2, 3, 7},
                          {2, 7, 6},
                          {3, 0, 4},
                          {3, 4, 7}},
                         {}};
  const Result result = delmesher::tetrahedralize(solid, with_record());
  expect_verified(solid, promise_of(with_record()), result);
  EXPECT_EQ(result.statistics.rounding_inverted + result.statistics.rounding_flat, 0U);
}

// In units of 2^-300 too, and on one axis alone.
TEST(FarAway, InExtremeUnits) {
  for (const int exponent : {-300, 300}) {
    Surface far = moved(solids()[1].surface, {0, 0x1p40, 0});
    for (Position& p : far.vertices) {
      for (double& x : p) x = std::ldexp(x, exponent);
    }
    const Result result = delmesher::tetrahedralize(far, with_record());
    expect_verified(far, promise_of(with_record()), result);
    EXPECT_EQ(result.exact.origin, (Position{0, std::ldexp(0x1p40, exponent), 0}));
  }
}

TEST(FarAway, DefectsAreToldInGivenCoordinates) {
  Surface open = moved(solids()[1].surface, kFar);
  open.triangles.pop_back();
  const Result result = delmesher::tetrahedralize(open, {});
  EXPECT_EQ(result.status.code, delmesher::StatusCode::invalid_surface);
  // The check goes on to the other defects.
  EXPECT_TRUE(
      delmesher::check_surface(open).status.message.starts_with(result.status.message + ";"))
      << result.status.message;
}

}  // namespace
}  // namespace tetproof::far_away_test
