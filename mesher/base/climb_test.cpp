#include "mesher/base/climb.h"

#include <gtest/gtest.h>

#include <string>

namespace delmesher::base {
namespace {

// Good enough once it has come so far.
struct Walk {
  std::size_t far_enough;
  std::string steps;
  bool may_untangle = true;

  bool good_enough() const { return steps.size() >= far_enough; }
};

constexpr Step<Walk> kSteps[] = {
    {Rung::other_orders, [](const Walk&) { return true; }, [](Walk& w) { w.steps += 'o'; }},
    {Rung::untangle, [](const Walk& w) { return w.may_untangle; }, [](Walk& w) { w.steps += 'u'; }},
    {Rung::no_planes, [](const Walk& w) { return w.steps.ends_with('u'); },
     [](Walk& w) { w.steps += 'n'; }},
};

struct Climbed {
  explicit Climbed(Walk begin) : walk(begin) { climb(walk, kSteps, counts); }

  Walk walk;
  RungCounts counts;
};

TEST(Climb, NothingIsDoneWhereTheFirstAttemptIsGoodEnough) {
  EXPECT_EQ(Climbed({0, ""}).walk.steps, "");
}

TEST(Climb, StepsAreTakenInOrderAndCountedUntilTheAttemptIsGoodEnough) {
  const Climbed c({5, ""});
  EXPECT_EQ(c.walk.steps, "ooouu");
  EXPECT_EQ(c.counts[Rung::other_orders], 3U);
  EXPECT_EQ(c.counts[Rung::untangle], 2U);
  EXPECT_EQ(c.counts[Rung::no_planes], 0U);
}

TEST(Climb, NoStepIsTakenMoreOftenThanItsRowAllows) {
  EXPECT_EQ(Climbed({1000, ""}).walk.steps, "ooouuuuuuuun");
}

TEST(Climb, StepsThatDoNotApplyAreLeftOut) {
  EXPECT_EQ(Climbed({1000, "", false}).walk.steps, "ooo");
}

}  // namespace
}  // namespace delmesher::base
