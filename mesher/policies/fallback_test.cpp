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

  Options options;
  Control control;
  Session session;
  Fallback fallback;
};

TEST(Fallback, EndsWhereTheProofHolds) {
  for (const double acute : {60.0, 90.0}) {
    Options options;
    options.acute = acute;
    Guarded g(options);
    const InForce before = g.fallback.in_force(0);
    EXPECT_FALSE(before.gabriel);
    EXPECT_EQ(before.acute, acute);
    EXPECT_LT(before.corner, 90);
    EXPECT_GT(g.fallback.runaway_length(g.session, 1e-4), 0);
    EXPECT_GT(g.fallback.runaway_length(g.session, 0), 0);
    g.fallback.tighten();
    const InForce end = g.fallback.in_force(0);
    EXPECT_TRUE(end.gabriel);
    EXPECT_EQ(end.acute, 90);
    EXPECT_EQ(end.corner, 90);
    EXPECT_EQ(g.fallback.chamfering().cosine_squared, 0);
    EXPECT_EQ(g.fallback.chamfering().corner_cosine_squared, 0);
    EXPECT_EQ(g.fallback.runaway_length(g.session, 1e-4), 0);
  }
}

TEST(Fallback, WithoutAGuardNothingRunsAway) {
  Options options;
  options.as_paper.no_guard = true;
  Guarded g(options);
  EXPECT_EQ(g.fallback.runaway_length(g.session, 1e-4), 0);
}

}  // namespace
}  // namespace delmesher::policies
