#include "reports/poisson.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tetproof::poisson_test {
namespace {

using oracles::Index;
using oracles::MeshFile;

// The unit cube, n cells along each edge, each cut into six tetrahedra around its diagonal: the
// stiffness matrix of linear elements is that of finite differences then, with seven entries a row.
MeshFile cube(Index n) {
  MeshFile mesh;
  const auto at = [&](Index x, Index y, Index z) { return (z * (n + 1) + y) * (n + 1) + x; };
  for (Index z = 0; z <= n; ++z) {
    for (Index y = 0; y <= n; ++y) {
      for (Index x = 0; x <= n; ++x) {
        mesh.vertices.push_back(
            {static_cast<double>(x) / n, static_cast<double>(y) / n, static_cast<double>(z) / n});
      }
    }
  }
  for (Index cell = 0; cell < n * n * n; ++cell) {
    const std::array<Index, 3> corner = {cell % n, cell / n % n, cell / n / n};
    std::array<int, 3> order = {0, 1, 2};
    do {
      std::array<Index, 3> p = corner;
      std::array<Index, 4> tet{at(p[0], p[1], p[2])};
      for (int i = 0; i < 3; ++i) {
        ++p[order[i]];
        tet[i + 1] = at(p[0], p[1], p[2]);
      }
      mesh.tetrahedra.push_back(tet);
      mesh.regions.push_back(1);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return mesh;
}

TEST(Poisson, ConditionOfFiniteDifferences) {
  for (const Index n : {6U, 12U}) {
    const PoissonRun run = solve_poisson(cube(n));
    EXPECT_TRUE(run.converged);
    EXPECT_EQ(run.unknowns, (n - 1) * (n - 1) * (n - 1));
    EXPECT_EQ(run.tetrahedra, 6 * n * n * n);
    // The eigenvalues are 2 (3 - cos a - cos b - cos c) for multiples of pi / n.
    const double cosine = std::cos(std::numbers::pi / n);
    const double condition = (1 + cosine) / (1 - cosine);
    EXPECT_LE(run.condition, condition * (1 + 1e-9));
    EXPECT_GE(run.condition, condition * 0.9);
  }
}

TEST(Poisson, TheErrorFallsWithTheSquareOfTheSize) {
  const PoissonRun coarse = solve_poisson(cube(6)), fine = solve_poisson(cube(12));
  EXPECT_NEAR(coarse.mean_error / fine.mean_error, 4, 0.4);
  EXPECT_GT(coarse.largest_error, coarse.mean_error);
}

TEST(Poisson, GivenUpAtTheLimit) {
  const PoissonRun run = solve_poisson(cube(12), 3);
  EXPECT_FALSE(run.converged);
  EXPECT_EQ(run.iterations, 3U);
}

TEST(Poisson, OfNoUnknownsThereIsNothingToSolve) {
  const PoissonRun run = solve_poisson(cube(1));
  EXPECT_EQ(run.unknowns, 0U);
  EXPECT_EQ(run.iterations, 0U);
  EXPECT_EQ(run.condition, 0);
  EXPECT_EQ(run.mean_error, 0);
  EXPECT_NE(to_json(run).find("\"per_root\": 0.0000"), std::string::npos);
}

}  // namespace
}  // namespace tetproof::poisson_test
