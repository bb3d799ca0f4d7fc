#include "mesher/policies/finer_planes.h"

#include <gtest/gtest.h>

namespace delmesher::policies {
namespace {

Result result_with(std::uint64_t inverted, std::uint64_t flat) {
  Result result;
  Statistics& s = result.statistics;
  s.planar_groups = 3;
  s.planar_bound = 0.5;
  s.bbox_diagonal = 4;
  s.rounding_inverted = inverted;
  s.rounding_flat = flat;
  return result;
}

TEST(FinerPlanes, NothingIsWantedAfterAGoodMesh) {
  EXPECT_FALSE(FinerPlanes({}).plan_run_after(result_with(0, 0)));
}

TEST(FinerPlanes, NothingIsWantedWherePlanesAreNotTheCause) {
  Result exact = result_with(1, 0);
  exact.statistics.planar_groups = 0;
  EXPECT_FALSE(FinerPlanes({}).plan_run_after(exact));
}

TEST(FinerPlanes, NothingIsWantedAfterAFailure) {
  Result failed = result_with(1, 0);
  failed.status = {StatusCode::limit_reached, "out of memory", Limit::memory};
  EXPECT_FALSE(FinerPlanes({}).plan_run_after(failed));
}

// A vertex may be 0.5 from its plane, so the surface 1, a quarter of the diagonal.
TEST(FinerPlanes, TheSurfaceAsGivenThenAThirtySecondThenNoPlanes) {
  Options options;
  options.tau = 0.25;
  FinerPlanes planes(options);
  const Result bad = result_with(0, 2);
  ASSERT_TRUE(planes.plan_run_after(bad));
  EXPECT_EQ(planes.options().planar, 0);
  EXPECT_FALSE(planes.directly());
  EXPECT_EQ(planes.options().tau, 0.25);
  // Of the first bound, even if another run was better.
  Result other = result_with(0, 1);
  other.statistics.planar_bound = 0.125;
  ASSERT_TRUE(planes.plan_run_after(other));
  EXPECT_EQ(planes.options().planar, 0.25 / 32);
  EXPECT_FALSE(planes.directly());
  ASSERT_TRUE(planes.plan_run_after(other));
  EXPECT_EQ(planes.options().planar, 0);
  EXPECT_TRUE(planes.directly());
  EXPECT_FALSE(planes.plan_run_after(other));
}

// Without the improvement no mesh goes back to the surface as given.
TEST(FinerPlanes, WithoutAWayBackThereIsOneRunLess) {
  Options unimproved, approximate;
  unimproved.improve = false;
  approximate.approximate = true;
  for (const Options& options : {unimproved, approximate}) {
    FinerPlanes planes(options);
    const Result bad = result_with(0, 2);
    ASSERT_TRUE(planes.plan_run_after(bad));
    EXPECT_EQ(planes.options().planar, 0.25 / 32);
    ASSERT_TRUE(planes.plan_run_after(bad));
    EXPECT_TRUE(planes.directly());
    EXPECT_FALSE(planes.plan_run_after(bad));
  }
}

// A run that did not come back to the surface as given has no mesh.
TEST(FinerPlanes, WhatWasGivenUpIsNotBetter) {
  Result best = result_with(0, 2), gave_up = result_with(0, 0);
  gave_up.statistics.planar_given_up = true;
  FinerPlanes::keep_better(gave_up, best);
  EXPECT_EQ(best.statistics.rounding_flat, 2U);
  EXPECT_FALSE(best.statistics.planar_given_up);
}

TEST(FinerPlanes, AllRunsShareTheTimeLimit) {
  Options options;
  options.time_limit_seconds = 1e6;
  FinerPlanes planes(options);
  ASSERT_TRUE(planes.plan_run_after(result_with(1, 0)));
  EXPECT_LT(planes.options().time_limit_seconds, 1e6);
  options.time_limit_seconds = 1e-300;
  FinerPlanes late(options);
  EXPECT_FALSE(late.plan_run_after(result_with(1, 0)));
}

TEST(FinerPlanes, TheBestResultCounts) {
  Result best = result_with(2, 1);
  FinerPlanes::keep_better(result_with(3, 0), best);
  EXPECT_EQ(best.statistics.rounding_inverted, 2U);
  EXPECT_EQ(best.statistics.planar_limit, Limit::none);
  Result failed = result_with(0, 0);
  failed.status = {StatusCode::limit_reached, "vertex limit reached", Limit::size};
  FinerPlanes::keep_better(failed, best);
  EXPECT_EQ(best.statistics.rounding_inverted, 2U);
  EXPECT_EQ(best.statistics.planar_limit, Limit::size);
  FinerPlanes::keep_better(result_with(1, 1), best);
  EXPECT_EQ(best.statistics.rounding_inverted, 1U);
}

// Written tetrahedra come first, then those on exact coordinates.
TEST(FinerPlanes, RepairsThatGiveUpExactCoordinatesAreADefect) {
  Result best = result_with(0, 0);
  best.statistics.rounding_inexact = 2;
  ASSERT_TRUE(FinerPlanes({}).plan_run_after(best));
  FinerPlanes::keep_better(result_with(1, 0), best);
  EXPECT_EQ(best.statistics.rounding_inexact, 2U);
  Result other = result_with(0, 0);
  other.statistics.rounding_inexact = 1;
  FinerPlanes::keep_better(other, best);
  EXPECT_EQ(best.statistics.rounding_inexact, 1U);
}

// With --planar 0: one more run, whatever comes of it, and it tells why.
TEST(FinerPlanes, WhatWasGivenUpIsMeshedDirectly) {
  Options options;
  options.planar = 0;
  FinerPlanes planes(options);
  Result best = result_with(0, 0);
  best.statistics.planar_given_up = true;
  best.statistics.diagonals = 9;
  best.statistics.diagonals_missing = 2;
  ASSERT_TRUE(planes.plan_run_after(best));
  EXPECT_TRUE(planes.directly());
  Result direct = result_with(1, 0);
  direct.statistics.planar_groups = 0;
  Result failed;
  failed.status = {StatusCode::limit_reached, "vertex limit reached", Limit::size};
  Result of_failure = best;
  FinerPlanes::keep_better(failed, of_failure);
  EXPECT_EQ(of_failure.status.code, StatusCode::limit_reached);
  FinerPlanes::keep_better(direct, best);
  EXPECT_EQ(best.statistics.rounding_inverted, 1U);
  EXPECT_TRUE(best.statistics.planar_given_up);
  EXPECT_EQ(best.statistics.diagonals, 9U);
  EXPECT_EQ(best.statistics.diagonals_missing, 2U);
  EXPECT_FALSE(planes.plan_run_after(best));
}

TEST(FinerPlanes, AnInterruptionIsReported) {
  Result best = result_with(1, 0), interrupted;
  interrupted.status = {StatusCode::interrupted, "interrupted"};
  FinerPlanes planes({});
  FinerPlanes::keep_better(interrupted, best);
  EXPECT_EQ(best.status.code, StatusCode::interrupted);
  EXPECT_FALSE(planes.plan_run_after(best));
}

}  // namespace
}  // namespace delmesher::policies
