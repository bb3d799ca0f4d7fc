// What `--planar auto` states by the digits and the noise of coordinates is at most what the
// oracles allow, and is kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesher/base/control.h"
#include "mesher/planar/flatness.h"
#include "property_tests/planar/runs.h"

namespace tetproof::planar {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Surface;

double diagonal_of(const Surface& surface) {
  Position low = surface.vertices[0], high = low;
  for (const Position& p : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], p[i]);
      high[i] = std::max(high[i], p[i]);
    }
  }
  return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
}

// Rounded first, scaled by a power of two then: the mesher works in units in which it sees the
// digits again.
TEST(Digits, OfModelsTimesPowersOfTwo) {
  for (const int power : {-300, 100}) {
    for (const bool single : {false, true}) {
      const auto round = [=](double x) {
        const double rounded = single ? to_single(x + 500) : std::round(x * 1e4) / 1e5;
        return std::ldexp(rounded, power);
      };
      const Told told = run_of(rotated(stairs(), round));
      EXPECT_GT(told.statistics.planar_groups, 0U);
      const VerifyReport report = verdict_on(told);
      EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
    }
  }
}

Surface beside(Surface s, const Surface& other, double shift) {
  const auto first = static_cast<std::uint32_t>(s.vertices.size());
  for (const Position& p : other.vertices) s.vertices.push_back({p[0] + shift, p[1], p[2]});
  for (const auto& [a, b, c] : other.triangles) {
    s.triangles.push_back({a + first, b + first, c + first});
  }
  return s;
}

// Parts that were rounded twice.
TEST(EdgeNoise, LetsTheMesherDeviateByNoMoreThanTheOracles) {
  std::mt19937 random(19);
  const auto share = [&] { return static_cast<double>(random()) * 0x1p-32; };
  int more = 0;
  for (int n = samples::iterations(300); n > 0; --n) {
    const double unit = std::exp2(-17 + 12 * share()), finer = unit * std::exp2(-8 * share());
    const auto to = [](double place) {
      return [place](double x) { return std::round(x / place) * place; };
    };
    const Surface part =
        n % 3 == 0 ? stairs() : samples::random_voxels(static_cast<std::uint32_t>(random() % 99));
    Surface twice = rotated(part, to(unit));
    // Of which more edges have the finer noise.
    for (int k = 1; k < n % 5; ++k) twice = beside(twice, rotated(stairs(), to(0x1p-50)), 12 * k);
    const Surface s = rotated(twice, n % 2 == 0 ? to(finer) : to(0x1p-50));
    delmesher::Limits limits;
    delmesher::base::Control control{limits};
    const double mine = 4 * delmesher::planar::flatness(s, control) / diagonal_of(s);
    more += mine > 1.01 * Promise::kAutomatic ? 1 : 0;
    ASSERT_LE(mine, Promise::kMostAutomatic * (1 + 1e-9)) << n;
  }
  // The noise of some is as small as what is flat for all, and some have few edges.
  EXPECT_GT(more, samples::iterations(300) / 10);
}

TEST(EdgeNoise, OfTwoRoundingsIsPromisedAndKept) {
  const auto coarse = [](double x) { return std::round(x * 3e4) / 3e4; };
  const auto to_double = [](double x) { return x; };
  const std::uint64_t facets = run_of(stairs()).statistics.facets;
  for (const Surface& s : {rotated(rotated(stairs(), coarse), to_single),
                           rotated(rotated(stairs(), coarse), to_double),
                           rotated(stairs(), [](double x) { return std::round(x * 3e4); })}) {
    const Told told = run_of(s);
    EXPECT_EQ(told.statistics.facets, facets);
    const VerifyReport report = verdict_on(told);
    EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
    Told strict = told;
    strict.promise.planar = 0x1p-18;  // what is always allowed
    EXPECT_FALSE(samples::as_promised(verdict_on(strict)));
  }
}

// Of five parts one was rounded before, so four of five edges are bent by single precision alone.
TEST(EdgeNoise, BelowAFinerRoundingIsPromisedAndKept) {
  const auto coarse = [](double x) { return std::round(x * 3e3) / 3e3; };
  const auto to_double = [](double x) { return x; };
  Surface parts = rotated(stairs(), coarse), straight = stairs();
  for (int k = 1; k < 5; ++k) {
    parts = beside(parts, rotated(stairs(), to_double), 12 * k);
    straight = beside(straight, stairs(), 12 * k);
  }
  const std::uint64_t facets = run_of(straight).statistics.facets;
  const Surface once = rotated(parts, to_single);
  for (const Surface& s : {once, rotated(once, to_double)}) {
    const Told told = run_of(s);
    EXPECT_EQ(told.statistics.facets, facets);
    const VerifyReport report = verdict_on(told);
    EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
    Told strict = told;
    strict.promise.planar = 0x1p-18;
    EXPECT_FALSE(samples::as_promised(verdict_on(strict)));
  }
}

}  // namespace
}  // namespace tetproof::planar
