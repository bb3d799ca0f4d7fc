#include "mesher/policies/planar_runs.h"

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

TEST(PlanarRuns, NothingIsWantedAfterAGoodMesh) {
  EXPECT_TRUE(PlanarRuns::good_enough(result_with(0, 0)));
}

TEST(PlanarRuns, NothingIsWantedWherePlanesAreNotTheCause) {
  Result exact = result_with(1, 0);
  exact.statistics.planar_groups = 0;
  EXPECT_TRUE(PlanarRuns::good_enough(exact));
}

TEST(PlanarRuns, NothingIsWantedAfterAFailure) {
  Result failed = result_with(1, 0);
  failed.status = {StatusCode::limit_reached, "out of memory", Limit::memory};
  EXPECT_TRUE(PlanarRuns::good_enough(failed));
}

TEST(PlanarRuns, TheSurfaceAsGivenThenNoPlanes) {
  Options options;
  options.tau = 0.25;
  const PlanarRuns planes(options);
  ASSERT_FALSE(PlanarRuns::good_enough(result_with(0, 2)));
  EXPECT_TRUE(planes.applies(Rung::back_to_given));
  EXPECT_TRUE(planes.applies(Rung::no_planes));
  EXPECT_EQ(planes.options().planar, 0);
  EXPECT_EQ(planes.options().tau, 0.25);
}

// Without the improvement no mesh goes back to the surface as given.
TEST(PlanarRuns, WithoutAWayBackThereIsOneRunLess) {
  Options unimproved, approximate;
  unimproved.improve = false;
  approximate.approximate = true;
  for (const Options& options : {unimproved, approximate}) {
    const PlanarRuns planes(options);
    EXPECT_FALSE(planes.applies(Rung::back_to_given));
    EXPECT_TRUE(planes.applies(Rung::no_planes));
  }
}

Result without_a_way_back() {
  Result result = result_with(0, 0);
  result.status = {StatusCode::limit_reached, "no way back", Limit::precision};
  result.statistics.planar_given_up = true;
  return result;
}

TEST(PlanarRuns, WhatDidNotComeBackIsNotBetter) {
  Result best = result_with(0, 2);
  PlanarRuns::keep_better(without_a_way_back(), best);
  EXPECT_TRUE(best.status.ok());
  EXPECT_EQ(best.statistics.rounding_flat, 2U);
  EXPECT_FALSE(best.statistics.planar_given_up);
  EXPECT_EQ(best.statistics.planar_limit, Limit::none);
}

TEST(PlanarRuns, AllRunsShareTheTimeLimit) {
  Options options;
  options.time_limit_seconds = 1e6;
  PlanarRuns planes(options);
  ASSERT_TRUE(planes.applies(Rung::no_planes));
  EXPECT_LT(planes.options().time_limit_seconds, 1e6);
  options.time_limit_seconds = 1e-300;
  const PlanarRuns late(options);
  EXPECT_FALSE(late.applies(Rung::no_planes));
}

TEST(PlanarRuns, TheBestResultCounts) {
  Result best = result_with(2, 1);
  PlanarRuns::keep_better(result_with(3, 0), best);
  EXPECT_EQ(best.statistics.rounding_inverted, 2U);
  EXPECT_EQ(best.statistics.planar_limit, Limit::none);
  Result failed = result_with(0, 0);
  failed.status = {StatusCode::limit_reached, "vertex limit reached", Limit::size};
  PlanarRuns::keep_better(failed, best);
  EXPECT_EQ(best.statistics.rounding_inverted, 2U);
  EXPECT_EQ(best.statistics.planar_limit, Limit::size);
  PlanarRuns::keep_better(result_with(1, 1), best);
  EXPECT_EQ(best.statistics.rounding_inverted, 1U);
}

// Written tetrahedra come first, then those on exact coordinates.
TEST(PlanarRuns, RepairsThatGiveUpExactCoordinatesAreADefect) {
  Result best = result_with(0, 0);
  best.statistics.rounding_inexact = 2;
  ASSERT_FALSE(PlanarRuns::good_enough(best));
  PlanarRuns::keep_better(result_with(1, 0), best);
  EXPECT_EQ(best.statistics.rounding_inexact, 2U);
  Result other = result_with(0, 0);
  other.statistics.rounding_inexact = 1;
  PlanarRuns::keep_better(other, best);
  EXPECT_EQ(best.statistics.rounding_inexact, 1U);
}

// With --planar 0: one more run, whatever comes of it, and it tells why.
TEST(PlanarRuns, WhatWasGivenUpIsMeshedDirectly) {
  Options options;
  options.planar = 0;
  PlanarRuns planes(options);
  Result best = without_a_way_back();
  best.statistics.diagonals = 9;
  best.statistics.diagonals_missing = 2;
  ASSERT_FALSE(PlanarRuns::good_enough(best));
  EXPECT_FALSE(planes.applies(Rung::back_to_given));
  ASSERT_TRUE(planes.applies(Rung::no_planes));
  Result direct = result_with(1, 0);
  direct.statistics.planar_groups = 0;
  Result failed;
  failed.status = {StatusCode::limit_reached, "vertex limit reached", Limit::size};
  Result of_failure = best;
  PlanarRuns::keep_better(failed, of_failure);
  EXPECT_EQ(of_failure.status.code, StatusCode::limit_reached);
  PlanarRuns::keep_better(direct, best);
  EXPECT_EQ(best.statistics.rounding_inverted, 1U);
  EXPECT_TRUE(best.statistics.planar_given_up);
  EXPECT_EQ(best.statistics.diagonals, 9U);
  EXPECT_EQ(best.statistics.diagonals_missing, 2U);
  EXPECT_TRUE(PlanarRuns::good_enough(best));
}

// Whichever run counts, what was tried is told.
TEST(PlanarRuns, RungsOfAllRunsAreCounted) {
  Result best = result_with(2, 1), worse = result_with(3, 0), better = result_with(0, 0);
  best.statistics.ladder[Rung::thin_out] = 1;
  worse.statistics.ladder[Rung::thin_out] = 4;
  better.statistics.ladder[Rung::untangle] = 8;
  PlanarRuns::keep_better(worse, best);
  PlanarRuns::keep_better(better, best);
  EXPECT_EQ(best.statistics.rounding_inverted, 0U);
  EXPECT_EQ(best.statistics.ladder[Rung::thin_out], 5U);
  EXPECT_EQ(best.statistics.ladder[Rung::untangle], 8U);
}

TEST(PlanarRuns, AnInterruptionIsReported) {
  Result best = result_with(1, 0), interrupted;
  interrupted.status = {StatusCode::interrupted, "interrupted"};
  PlanarRuns::keep_better(interrupted, best);
  EXPECT_EQ(best.status.code, StatusCode::interrupted);
  EXPECT_TRUE(PlanarRuns::good_enough(best));
}

}  // namespace
}  // namespace delmesher::policies
