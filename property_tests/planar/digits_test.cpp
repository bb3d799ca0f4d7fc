// The digits of coordinates, as the mesher and the oracles count them on their own: what `auto` may
// do is never more than what it is held to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include "mesher/base/control.h"
#include "mesher/planar/flatness.h"
#include "mesher/planar/resolution.h"
#include "oracles/surface/input_digits.h"
#include "property_tests/planar/runs.h"

namespace tetproof::planar {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Surface;

// Numbers of a few digits, of a few places, of single precision, with a few that are special.
class Numbers {
 public:
  explicit Numbers(std::mt19937& random) : random_(random) {
    size_ = std::pow(10, below(9) - 4.0) * (below(2) == 0 ? 1 : 1 + 9 * share());
    offset_ = below(3) == 0 ? size_ * std::pow(10, below(5)) * share() : 0;
    digits_ = below(8);
    way_ = below(3);
    single_ = below(3) == 0;
  }

  double next() {
    const int special = below(40);
    if (special == 0) return below(2) == 0 ? 0.0 : -0.0;
    if (special == 1 && below(20) == 0) return below(2) == 0 ? 0x1p-1074 : 1e-42;
    double x = offset_ + (special < 6 ? 1 : 2 * share() - 1) * size_;
    char text[64];
    if (way_ == 0) std::snprintf(text, sizeof text, "%.*g", digits_ + 1, x);
    if (way_ == 1) {
      const int places = digits_ - 1 - static_cast<int>(std::floor(std::log10(size_)));
      std::snprintf(text, sizeof text, "%.*f", std::max(places, 0), x);
    }
    if (way_ == 2) std::snprintf(text, sizeof text, "%.17g", x);
    return single_ ? static_cast<double>(std::strtof(text, nullptr)) : std::strtod(text, nullptr);
  }

 private:
  int below(unsigned n) { return static_cast<int>(random_() % n); }
  double share() { return static_cast<double>(random_()) * 0x1p-32; }

  std::mt19937& random_;
  double size_, offset_;
  int digits_, way_;
  bool single_;
};

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

TEST(Digits, LetTheMesherDeviateByNoMoreThanTheOracles) {
  constexpr double kAlways = 0x1p-18, kMostRounded = 0x1p-14 / 1.5;  // flatness.h
  std::mt19937 random(18);
  int more = 0;
  for (int n = samples::iterations(20000); n > 0; --n) {
    Numbers numbers(random);
    Surface s;
    for (std::size_t v = 4 + random() % 6; v > 0; --v) {
      s.vertices.push_back({numbers.next(), numbers.next(), numbers.next()});
    }
    const double diagonal = diagonal_of(s);
    if (!(diagonal > 0)) continue;
    const double rounding = delmesher::planar::rounding_of_coordinates(s, kMostRounded * diagonal);
    const double mine = std::max(6 * rounding / diagonal, kAlways);
    const double theirs = automatic_planar_share(s.vertices);
    more += mine > kAlways ? 1 : 0;
    ASSERT_NEAR(mine, theirs, 1e-9 * theirs) << n;
  }
  EXPECT_GT(more, 1000);
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

// What a part says of its noise when it was rounded twice, each says on its own.
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
    const double theirs = automatic_planar_share(samples::to_polyhedron(s));
    more += mine > 1.01 * automatic_planar_share(s.vertices) ? 1 : 0;
    ASSERT_LE(mine, theirs * (1 + 1e-9)) << n;
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
