#include "mesher/policies/fallback.h"

#include <gtest/gtest.h>

#include "mesher/cdt/test_models.h"

namespace delmesher::policies {
namespace {

// A session on a ball with 1026 vertices, and a guard for it.
struct Guarded {
  explicit Guarded(const Options& wanted)
      : options(wanted), control(options), session(options, control), fallback(options) {
    session.surface.enter_given(
        build_topology(cdt::test_models::star(4, 1, 1), session.points, session.predicates));
    session.diagonal = 2;
  }
  std::uint64_t tight() const {
    const InForce force = fallback.in_force(0);
    std::uint64_t count = 0;
    for (VertexId v = 0; v < session.input_vertices(); ++v) count += force.tightened(v);
    return count;
  }

  Options options;
  Control control;
  Session session;
  Fallback fallback;
};

TEST(Fallback, BeginsWithEmptyBallsAlone) {
  Guarded g{Options{}};
  const InForce before = g.fallback.in_force(0);
  EXPECT_FALSE(before.gabriel);
  g.fallback.empty_balls();
  const InForce after = g.fallback.in_force(0);
  EXPECT_TRUE(after.gabriel);
  EXPECT_EQ(after.acute, g.options.acute);
  EXPECT_EQ(g.tight(), 0U);
}

// Where one place alone runs away, the rest of a large surface keeps its thresholds.
TEST(Fallback, TightensWhatIsNearestAndEndsWithEverything) {
  Options options;
  options.gabriel = true;
  Guarded g(options);
  const Vec3 place = {1, 0, 0};
  std::uint64_t before = 0;
  for (int step = 1; step <= 32; ++step) {
    g.fallback.tighten_nearby(place, g.session);
    const InForce force = g.fallback.in_force(0);
    EXPECT_GT(g.tight(), before) << step;
    if (step == 1) {
      EXPECT_LE(g.tight(), 7U);
    }
    if (step == Fallback::kSameReach) {
      EXPECT_LT(g.tight(), g.session.input_vertices() / 8);
    }
    EXPECT_EQ(force.acute, options.acute);
    EXPECT_GT(g.fallback.runaway_length(g.session, 1e-4), 0);
    before = g.tight();
    if (before == g.session.input_vertices()) break;
  }
  g.fallback.tighten_everywhere();
  const InForce end = g.fallback.in_force(0);
  EXPECT_EQ(end.acute, 90);
  EXPECT_EQ(end.corner, 90);
  EXPECT_EQ(g.fallback.runaway_length(g.session, 1e-4), 0);
}

TEST(Fallback, TightCornersAreNearThePlace) {
  Options options;
  options.gabriel = true;
  Guarded g(options);
  for (int step = 0; step < 4; ++step) g.fallback.tighten_nearby({1, 0, 0}, g.session);
  const InForce force = g.fallback.in_force(0);
  for (VertexId v = 0; v < g.session.input_vertices(); ++v) {
    if (!force.tightened(v)) continue;
    EXPECT_GT(g.session.points.nearest(v)[0], 0.5);
  }
}

// A record has one threshold of two edges for all corners that are not tightened above its `acute`.
TEST(Fallback, WithRightAnglesOnlyTwoEdgesBecomeStricterAndAllAtOnce) {
  Options options;
  options.gabriel = true;
  options.acute = 90;
  Guarded g(options);
  EXPECT_LT(g.fallback.in_force(0).corner, 90);
  EXPECT_FALSE(g.fallback.can_tighten_nearby());
  g.fallback.tighten_everywhere();
  EXPECT_EQ(g.fallback.in_force(0).corner, 90);
  EXPECT_EQ(g.tight(), 0U);
  EXPECT_EQ(g.fallback.runaway_length(g.session, 1e-4), 0);
}

TEST(Fallback, WithoutAGuardNothingRunsAway) {
  Options options;
  EXPECT_GT(Guarded(options).fallback.runaway_length(Guarded(options).session, 1e-4), 0);
  options.as_paper.no_guard = true;
  Guarded g(options);
  EXPECT_EQ(g.fallback.runaway_length(g.session, 1e-4), 0);
}

}  // namespace
}  // namespace delmesher::policies
