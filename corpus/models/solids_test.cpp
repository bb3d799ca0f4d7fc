#include "corpus/models/solids.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace tetproof {
namespace {

using oracles::Index;
using oracles::Polyhedron;

// A tetrahedron around the point (x, 0, 0), `radius` large, outwards or inwards.
void add_shell(Polyhedron& surface, double x, double radius, bool outwards = true) {
  const auto first = static_cast<Index>(surface.vertices.size());
  for (const auto& [dx, dy, dz] :
       std::vector<std::array<double, 3>>{{-1, -1, -1}, {3, -1, -1}, {-1, 3, -1}, {-1, -1, 3}}) {
    surface.vertices.push_back({x + radius * dx, radius * dy, radius * dz});
  }
  for (std::array<Index, 3> t :
       std::vector<std::array<Index, 3>>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {
    if (!outwards) std::swap(t[1], t[2]);
    for (Index& v : t) v += first;
    surface.triangles.push_back(t);
  }
}

TEST(Solids, OneShellIsOneSolid) {
  for (const bool outwards : {true, false}) {
    Polyhedron surface;
    add_shell(surface, 0, 1, outwards);
    const Solids found = solids_of(surface);
    ASSERT_EQ(found.solids.size(), 1U);
    EXPECT_EQ(found.solids[0].outer, 0U);
    EXPECT_TRUE(found.solids[0].cavities.empty());
    EXPECT_EQ(found.shell_of_triangle, std::vector<std::size_t>(4, 0));
  }
}

// Four shells around each other, two cavities side by side in the outermost, and a solid apart; the
// innermost come first and some are oriented the wrong way.
TEST(Solids, CavitiesBelongToTheShellAroundThem) {
  Polyhedron surface;
  add_shell(surface, 0, 0.01);          // 0: a cavity of 1
  add_shell(surface, 0, 0.1);           // 1: in the cavity 2
  add_shell(surface, 0, 0.2);           // 2: a cavity of 4
  add_shell(surface, 0.6, 0.1, false);  // 3: another one
  add_shell(surface, 0, 1, false);      // 4
  add_shell(surface, 20, 1);            // 5
  const Solids found = solids_of(surface);
  ASSERT_EQ(found.solids.size(), 3U);
  EXPECT_EQ(found.solids[0].outer, 1U);
  EXPECT_EQ(found.solids[0].cavities, (std::vector<std::size_t>{0}));
  EXPECT_EQ(found.solids[1].outer, 4U);
  EXPECT_EQ(found.solids[1].cavities, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(found.solids[2].outer, 5U);
  EXPECT_TRUE(found.solids[2].cavities.empty());
  EXPECT_EQ(found.shell_of_triangle[4], 1U);
  EXPECT_EQ(found.shell_of_triangle[23], 5U);
}

// Many solids side by side, each with a cavity of its own that comes after all of them.
TEST(Solids, OfManyShellsEachCavityBelongsToItsOwn) {
  constexpr std::size_t kSolids = 3000;
  Polyhedron surface;
  for (const double radius : {1.0, 0.1}) {
    for (std::size_t s = 0; s < kSolids; ++s)
      add_shell(surface, 5 * static_cast<double>(s), radius);
  }
  const Solids found = solids_of(surface);
  ASSERT_EQ(found.solids.size(), kSolids);
  for (std::size_t s = 0; s < kSolids; ++s) {
    EXPECT_EQ(found.solids[s].outer, s);
    EXPECT_EQ(found.solids[s].cavities, (std::vector<std::size_t>{kSolids + s}));
  }
}

TEST(Solids, AnOpenSurfaceBoundsNone) {
  Polyhedron surface;
  add_shell(surface, 0, 1);
  surface.triangles.pop_back();
  EXPECT_THROW(solids_of(surface), std::runtime_error);
}

}  // namespace
}  // namespace tetproof
