#include "mesher/policies/budget_size.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "mesher/policies/default_size.h"
#include "mesher/refine/prediction.h"

namespace delmesher::policies {
namespace {

// A regular tetrahedron with edges of root 2, and flat ones.
Result solid(std::size_t tetrahedra) {
  Result result;
  result.mesh.vertices = {{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  result.mesh.boundary = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  result.mesh.tetrahedra.assign(tetrahedra, {0, 1, 2, 2});
  result.mesh.tetrahedra.front() = {0, 2, 1, 3};
  result.statistics.bbox_diagonal = std::numbers::sqrt3;
  return result;
}

Options with_budget(std::uint64_t budget) {
  Options options;
  options.budget = budget;
  return options;
}

// How many sizes are tried until a mesh is full; -1: not within eight.
int tries(double budget, double without, const std::function<double(double)>& made) {
  BudgetSize filling(with_budget(static_cast<std::uint64_t>(budget)),
                     solid(static_cast<std::size_t>(without)));
  double most = without;
  for (int n = 1; n <= 8; ++n) {
    const double tetrahedra = made(filling.size());
    if (tetrahedra > budget) {
      filling.is_too_much(tetrahedra);
    } else {
      most = std::max(most, tetrahedra);
      filling.fits(tetrahedra);
    }
    if (most >= 0.9 * budget) return filling.is_done() ? n : -1;
    if (filling.is_done()) return -1;
  }
  return -1;
}

TEST(BudgetSize, IsWantedWhereASizeMayBeChosenAndThereIsRoom) {
  const Result coarse = solid(899);
  EXPECT_TRUE(BudgetSize::is_wanted(with_budget(1000), coarse));
  EXPECT_FALSE(BudgetSize::is_wanted(with_budget(0), coarse));
  EXPECT_FALSE(BudgetSize::is_wanted(with_budget(998), coarse));
  const auto with = [&](const auto& change) {
    Options options = with_budget(1000);
    change(options);
    return BudgetSize::is_wanted(options, coarse);
  };
  EXPECT_FALSE(with([](Options& o) { o.size = 0; }));
  EXPECT_FALSE(with([](Options& o) { o.size = 1; }));
  EXPECT_FALSE(with([](Options& o) { o.planar = 0; }));
  EXPECT_FALSE(with([](Options& o) { o.approximate = true; }));
  EXPECT_TRUE(with([](Options& o) { o.max_edge = 1; }));
  EXPECT_TRUE(with([](Options& o) { o.surface = SurfaceChoice::keep; }));
  Result failed = coarse;
  failed.status.code = StatusCode::limit_reached;
  EXPECT_FALSE(BudgetSize::is_wanted(with_budget(1000), failed));
}

// What is expected at first may be off, and small features have tetrahedra without a size, which
// may be the same ones.
TEST(BudgetSize, FindsASizeInAFewRuns) {
  const Part part = part_of(solid(1).mesh);
  int most = 0, sum = 0, count = 0;
  for (const double budget : {200.0, 1e4, 1e6}) {
    for (const double without : {1.0, 0.3 * budget, 0.6 * budget, 0.85 * budget}) {
      for (const double factor : {0.3, 0.7, 1.0, 1.5, 3.0}) {
        for (const int power : {1, 2, 8}) {  // their sum, or about the larger of both
          SCOPED_TRACE(testing::Message()
                       << budget << ' ' << without << ' ' << factor << ' ' << power);
          const int n = tries(budget, without, [&](double size) {
            return std::floor(std::pow(
                std::pow(without, power) +
                    std::pow(factor * refine::tetrahedra_of_size(size, part.volume, part.area),
                             power),
                1.0 / power));
          });
          EXPECT_GE(n, 1);
          most = std::max(most, n);
          sum += n;
          ++count;
        }
      }
    }
  }
  EXPECT_LE(most, 6);
  EXPECT_LE(sum, 3 * count);
}

// Edges no longer than 0.1 are asked for.
TEST(BudgetSize, MakesNoEdgeLongerThanABound) {
  Options options = with_budget(1000);
  options.max_edge = 0.1;
  BudgetSize filling(options, solid(10));
  for (int n = 0; n < 6 && !filling.is_done(); ++n) {
    EXPECT_LT(kMostOfSize * filling.size(), 0.1);
    filling.is_too_much(0);
  }
}

// Of some parts no mesh has so many tetrahedra that are good enough: none of these densities fits.
TEST(BudgetSize, GivesUpWhereNothingFits) {
  BudgetSize filling(with_budget(1000), solid(10));
  int n = 0;
  for (double before = 0; n < 100 && !filling.is_done(); ++n) {
    EXPECT_GT(filling.size(), before);
    before = filling.size();
    filling.is_too_much(0);
  }
  EXPECT_LT(n, 100);
}

// Lengths are in any unit.
TEST(BudgetSize, ScalesWithThePart) {
  Result large = solid(10);
  for (auto& p : large.mesh.vertices) {
    for (double& x : p) x *= 0x1p40;
  }
  large.statistics.bbox_diagonal *= 0x1p40;
  EXPECT_EQ(BudgetSize(with_budget(1000), large).size(),
            0x1p40 * BudgetSize(with_budget(1000), solid(10)).size());
}

}  // namespace
}  // namespace delmesher::policies
