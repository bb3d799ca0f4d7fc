// Laws of the predicted size and of the budget.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <regex>
#include <string>

#include "mesher/delmesher.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::budget_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;

// Two facets of 0.3 diagonals at a gap, in a model of diagonal 1: of one plate, or of two boxes.
Surface thin(double gap, bool plate) {
  Surface surface;
  if (plate) {
    samples::add_box(surface, {0, 0, 0}, {0.3, 0.3, gap});
  } else {
    samples::add_box(surface, {0, 0, 0}, {0.3, 0.3, 0.2});
    samples::add_box(surface, {0, 0, 0.2 + gap}, {0.3, 0.3, 0.4});
  }
  samples::add_box(surface, {0.5, 0.5, 0.5}, {0.577, 0.577, 0.577});
  return surface;
}

void expect_verified(const Surface& surface, const Options& options, const Result& result) {
  oracles::VerifyReport report;
  EXPECT_EQ(oracles::verify(
                samples::to_polyhedron(surface), samples::to_mesh(result.mesh), &result.exact,
                {.stage = oracles::Stage::both, .promised = oracles::promise_of(options)}, report),
            "");
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
}

// The gap is left out of the refinement, or the surface is kept; the written mesh conforms all the
// same.
TEST(Budget, IsFilledInThinPlatesAndGaps) {
  constexpr std::uint64_t kBudget = 2000;
  for (const double gap : {1e-2, 1e-3, 1e-5}) {
    for (const bool plate : {true, false}) {
      SCOPED_TRACE(testing::Message() << gap << ' ' << plate);
      const Surface surface = thin(gap, plate);
      Options options;
      options.budget = kBudget;
      options.want_exact = true;
      const Result result = delmesher::tetrahedralize(surface, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_LE(result.mesh.tetrahedra.size(), kBudget);
      // The edges of regular facets are all halved at the same size.
      EXPECT_GE(result.mesh.tetrahedra.size(), kBudget / 2);
      expect_verified(surface, options, result);
    }
  }
}

TEST(Budget, IsNearlyUsedUp) {
  for (const double length : {1.0, 3.0, 10.0}) {
    for (const std::uint64_t budget : {1000U, 4000U, 16000U}) {
      SCOPED_TRACE(testing::Message() << length << ' ' << budget);
      Surface surface;
      samples::add_box(surface, {0, 0, 0}, {length, 1, 1});
      Options options;
      options.budget = budget;
      const Result result = delmesher::tetrahedralize(surface, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_LE(result.mesh.tetrahedra.size(), budget);
      EXPECT_GE(result.mesh.tetrahedra.size(), budget - budget / 10);
    }
  }
}

TEST(Budget, GoesWithBoundsOnEdgesAndVertices) {
  Surface surface;
  samples::add_box(surface, {0, 0, 0}, {3, 1, 1});
  Options options;
  options.budget = 4000;
  options.max_edge = 0.5;
  options.want_exact = true;
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_GE(result.mesh.tetrahedra.size(), 3600U);
  expect_verified(surface, options, result);
  options.max_vertices = 500;
  const Result few = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(few.status.ok()) << few.status.message;
  EXPECT_LE(few.mesh.vertices.size(), 500U);
  EXPECT_LT(few.mesh.tetrahedra.size(), result.mesh.tetrahedra.size());
}

TEST(Budget, IsInterruptedInAnyRun) {
  Surface surface;
  samples::add_box(surface, {0, 0, 0}, {3, 1, 1});
  Options options;
  options.budget = 4000;
  int filtered = 0;
  double before = 0;
  options.progress = [&](const delmesher::Progress& progress) {
    const bool filters = progress.phase == delmesher::Phase::filter;
    filtered += filters && before != 1 ? 1 : 0;
    before = filters ? 1 : 0;
    return filtered < 2;  // the second run
  };
  const Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(filtered, 2);
  EXPECT_EQ(result.status.code, StatusCode::interrupted);
  EXPECT_TRUE(result.mesh.tetrahedra.empty());
}

// The surface alone takes as many as the message says, no fewer.
TEST(Budget, ThatIsTooSmallIsRefusedWithTheNumberThatFits) {
  const Surface surface = thin(1e-2, true);
  Options options;
  options.budget = 3;
  const Result refused = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(refused.status.limit, delmesher::Limit::budget);
  std::smatch needs;
  ASSERT_TRUE(std::regex_search(refused.status.message, needs, std::regex("has ([0-9]+) tetra")))
      << refused.status.message;
  EXPECT_EQ(refused.statistics.ladder[delmesher::Rung::no_planes], 0U);
  options.budget = std::stoull(needs[1]) - 1;
  EXPECT_FALSE(delmesher::tetrahedralize(surface, options).status.ok());
  ++options.budget;
  const Result fits = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(fits.status.ok()) << fits.status.message;
  EXPECT_EQ(fits.mesh.tetrahedra.size(), options.budget);
}

// A cube with triangles of a quarter of its side.
Surface fine_cube() {
  Surface cube, surface;
  samples::add_box(cube, {0, 0, 0}, {1, 1, 1});
  Options options;
  options.size = 0.25;
  const delmesher::TetMesh mesh = delmesher::tetrahedralize(cube, options).mesh;
  std::map<std::uint32_t, std::uint32_t> numbers;
  for (const auto& triangle : mesh.boundary) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint32_t>(surface.vertices.size());
      const auto [at, is_new] = numbers.emplace(triangle[k], next);
      if (is_new) surface.vertices.push_back(mesh.vertices[triangle[k]]);
      corners[k] = at->second;
    }
    surface.triangles.push_back(corners);
  }
  return surface;
}

// Every triangle is one face still; only the volume has more vertices.
TEST(Budget, KeepsASurfaceThatIsToBeKept) {
  const Surface surface = fine_cube();
  Options options;
  options.surface = delmesher::SurfaceChoice::keep;
  const Result coarse = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(coarse.status.ok()) << coarse.status.message;
  options.budget = 2 * coarse.mesh.tetrahedra.size();
  options.want_exact = true;
  const Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.mesh.boundary.size(), surface.triangles.size());
  EXPECT_LE(result.mesh.tetrahedra.size(), options.budget);
  EXPECT_GT(result.statistics.chosen_size, 0);
  EXPECT_GT(result.mesh.tetrahedra.size(), coarse.mesh.tetrahedra.size());
  expect_verified(surface, options, result);
}

// Sizes that are asked for stay: nothing is filled, and nothing is dropped.
TEST(Budget, LeavesASizeThatIsAskedFor) {
  Surface surface;
  samples::add_box(surface, {0, 0, 0}, {1, 1, 1});
  Options options;
  options.size = 0.25;
  const Result asked = delmesher::tetrahedralize(surface, options);
  options.budget = 100000;
  const Result bounded = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(bounded.status.ok());
  EXPECT_EQ(asked.mesh.vertices, bounded.mesh.vertices);
  EXPECT_EQ(asked.mesh.tetrahedra, bounded.mesh.tetrahedra);
  options.budget = asked.mesh.tetrahedra.size() - 1;
  EXPECT_EQ(delmesher::tetrahedralize(surface, options).status.limit, delmesher::Limit::budget);
}

// Without a budget the plate is filled with tetrahedra of its own thickness: a hundred times as
// many for a tenth of it, by the integral over the local feature size.
TEST(Budget, PredictionsGrowAsTheIntegralSays) {
  const auto predicted = [](double gap) {
    Options options = samples::split_surface();
    options.progress = [](const delmesher::Progress& progress) {
      return progress.predicted_tetrahedra == 0;
    };
    options.max_vertices = 10000;  // enough to have begun
    return delmesher::tetrahedralize(thin(gap, true), options).statistics.predicted_tetrahedra;
  };
  const double coarse = predicted(0.01), fine = predicted(0.001);
  EXPECT_GT(coarse, 1000);
  EXPECT_GT(fine / coarse, 50);
  EXPECT_LT(fine / coarse, 200);
}

TEST(Budget, WhatCannotFitIsRefusedWithAReason) {
  Surface surface;
  samples::add_box(surface, {0, 0, 0}, {1, 1, 1});
  for (const bool split : {true, false}) {
    Options options = split ? samples::split_surface() : Options();
    options.max_edge = 0.01;
    options.budget = 1000;
    const Result result = delmesher::tetrahedralize(surface, options);
    EXPECT_EQ(result.status.code, StatusCode::limit_reached);
    EXPECT_EQ(result.status.limit, delmesher::Limit::budget);
    EXPECT_NE(result.status.message.find("budget of 1000"), std::string::npos);
    EXPECT_TRUE(result.mesh.tetrahedra.empty());
  }
}

TEST(Budget, PredictionDoesNotDependOnTheScale) {
  for (const auto& model : samples::surfaces(20261121)) {
    SCOPED_TRACE(model.name);
    Options options = samples::split_surface();
    const Result result = delmesher::tetrahedralize(model.surface, options);
    ASSERT_TRUE(result.status.ok());
    Surface scaled = model.surface;
    for (auto& p : scaled.vertices) {
      for (double& x : p) x = std::ldexp(x, 20);
    }
    const Result other = delmesher::tetrahedralize(scaled, options);
    EXPECT_EQ(result.statistics.predicted_tetrahedra, other.statistics.predicted_tetrahedra);
    EXPECT_GT(result.statistics.predicted_tetrahedra, 0);
  }
}

// The integral of 1 / lfs^3 over a box, by the definition of the local feature size: the radius of
// the smallest ball that meets two faces or edges without a common point.
double integral_over_box(const std::array<double, 3>& side) {
  using Span = std::array<std::array<double, 2>, 3>;
  std::vector<Span> elements;  // 6 faces and 12 edges
  for (int code = 0; code < 27; ++code) {
    const std::array<int, 3> place = {code % 3, code / 3 % 3, code / 9};
    const auto free = std::count(place.begin(), place.end(), 2);
    if (free != 1 && free != 2) continue;
    Span span;
    for (std::size_t k = 0; k < 3; ++k) {
      span[k] = {place[k] == 1 ? side[k] : 0, place[k] == 0 ? 0 : side[k]};
    }
    elements.push_back(span);
  }
  const auto touch = [](const Span& a, const Span& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (a[k][1] < b[k][0] || b[k][1] < a[k][0]) return false;
    }
    return true;
  };
  constexpr int kSteps = 24;
  double sum = 0;
  for (int i = 0; i < kSteps * kSteps * kSteps; ++i) {
    const std::array<int, 3> at = {i % kSteps, i / kSteps % kSteps, i / kSteps / kSteps};
    std::vector<double> distance;
    for (const Span& e : elements) {
      double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = side[k] * (at[k] + 0.5) / kSteps;
        const double off = std::max({e[k][0] - x, x - e[k][1], 0.0});
        squared += off * off;
      }
      distance.push_back(std::sqrt(squared));
    }
    double size = HUGE_VAL;
    for (std::size_t a = 0; a < elements.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (!touch(elements[a], elements[b])) {
          size = std::min(size, std::max(distance[a], distance[b]));
        }
      }
    }
    sum += 1 / (size * size * size);
  }
  return sum * side[0] * side[1] * side[2] / (kSteps * kSteps * kSteps);
}

TEST(Budget, PredictionsAreAboutTheIntegral) {
  const std::vector<std::array<double, 3>> sides = {{1, 1, 1}, {2, 1, 0.5}, {4, 1, 1},
                                                    {1, 8, 2}, {8, 8, 1},   {0.25, 1, 16}};
  std::vector<double> ratios;
  for (const auto& side : sides) {
    Surface surface;
    samples::add_box(surface, {0, 0, 0}, side);
    const Result result = delmesher::tetrahedralize(surface, samples::split_surface());
    ASSERT_TRUE(result.status.ok());
    ratios.push_back(result.statistics.predicted_tetrahedra / integral_over_box(side));
  }
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  // If each is within a factor of 3 of one multiple of the integral, as predictions should be, two
  // of them differ by at most 9.
  EXPECT_LT(*most / *least, 9) << testing::PrintToString(ratios);
}

// Only the integral counts, not the order of the triangles.
TEST(Budget, PredictionDoesNotDependOnTheOrder) {
  const auto predicted = [](std::size_t first) {
    Surface surface;
    samples::add_box(surface, {0, 0, 0}, {2, 1, 0.5});
    samples::add_box(surface, {2.25, 0, 0}, {3, 1, 1});
    std::rotate(surface.triangles.begin(),
                surface.triangles.begin() + static_cast<std::ptrdiff_t>(first),
                surface.triangles.end());
    const Result result = delmesher::tetrahedralize(surface, samples::split_surface());
    EXPECT_TRUE(result.status.ok());
    return result.statistics.predicted_tetrahedra;
  };
  const double expected = predicted(0);
  for (std::size_t first = 1; first < 24; ++first) {
    EXPECT_NEAR(predicted(first), expected, 1e-9 * expected) << first;
  }
}

// Nor on where the model is: coordinates and moves are such that no sum is rounded.
TEST(Budget, PredictionDoesNotDependOnThePlace) {
  const auto predicted = [](double x, double y, double z) {
    Surface surface;
    samples::add_box(surface, {x, y, z}, {x + 2, y + 1, z + 0.5});
    samples::add_box(surface, {x + 2.25, y, z}, {x + 3, y + 1, z + 1});
    const Result result = delmesher::tetrahedralize(surface, samples::split_surface());
    EXPECT_TRUE(result.status.ok());
    return result.statistics.predicted_tetrahedra;
  };
  const double here = predicted(0, 0, 0);
  EXPECT_GT(here, 0);
  EXPECT_EQ(predicted(1024, 0, 0), here);
  EXPECT_EQ(predicted(0, -1024, 0), here);
  EXPECT_EQ(predicted(0, 0, 1024), here);
}

}  // namespace
}  // namespace tetproof::budget_test
