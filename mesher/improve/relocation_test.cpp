#include "mesher/improve/relocation.h"

#include <gtest/gtest.h>

#include <vector>

#include "mesher/improve/test_meshed_model.h"

namespace delmesher::improve::relocation_test {
namespace {

using namespace cdt::test_models;

struct Case : MeshedModel {
  using MeshedModel::MeshedModel;

  std::vector<VertexId> on_edges() const {
    std::vector<VertexId> list;
    for (VertexId v = 0; v < state->mesh.vertices(); ++v) {
      if (state->mesh.incident(v) == kNone || state->mobility(v) != Mobility::on_line) continue;
      list.push_back(v);
    }
    return list;
  }
};

// With nothing beyond the surface there is room just below it, if hardly any for doubles in places.
TEST(Relocation, TakesPointsOffTheirEdgesAndKeepsTheSurface) {
  std::size_t moved = 0, failed = 0;
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    Case c(s, true, seed++);
    Relocation relocation(*c.state);
    for (const VertexId v : c.on_edges()) {
      const std::size_t vertices = c.state->mesh.vertices();
      if (!relocation.run(v)) {
        EXPECT_NE(c.state->mesh.incident(v), kNone);
        ++failed;
        continue;
      }
      EXPECT_EQ(c.state->mesh.incident(v), kNone);
      ASSERT_EQ(c.state->mesh.vertices(), vertices + 1);
      EXPECT_EQ(c.state->mobility(static_cast<VertexId>(vertices)), Mobility::free);
      ++moved;
    }
    EXPECT_EQ(c.wrong(), "") << s.triangles.size() << " triangles";
  }
  EXPECT_GT(moved, 500U);
  EXPECT_LT(failed, moved / 20);
}

// Between two facets that are thinner at the edge than the grid of new places is fine.
TEST(Relocation, FindsRoomInThinWedges) {
  for (const double half : {1e-2, 1e-4}) {
    Surface wedge;
    wedge.vertices = {{0, 0, 0}, {1, 0.1, 0}, {0.4, 1, half}, {0.6, 0.9, -half}};
    for (auto& v : wedge.vertices) v[2] += 0.3 * v[0] + 0.7 * v[1];
    wedge.triangles = {{0, 1, 2}, {1, 0, 3}, {1, 3, 2}, {3, 0, 2}};
    std::size_t moved = 0;
    for (std::uint32_t seed = 1; seed < 8; ++seed) {
      Case c(wedge, true, seed);
      Relocation relocation(*c.state);
      for (const VertexId v : c.on_edges()) moved += relocation.run(v, true) ? 1 : 0;
      EXPECT_TRUE(c.on_edges().empty()) << half;
      EXPECT_EQ(c.wrong(), "") << half;
    }
    EXPECT_GT(moved, 0U);
  }
}

// Each side gets a point, and both are tiled alike.
TEST(Relocation, PutsAPointOnEachSide) {
  Case c(box(0, 1), false, 1);
  Relocation relocation(*c.state);
  std::size_t moved = 0;
  for (const VertexId v : c.on_edges()) {
    const std::size_t vertices = c.state->mesh.vertices();
    if (!relocation.run(v)) continue;
    ++moved;
    EXPECT_EQ(c.state->mesh.incident(v), kNone);
    ASSERT_EQ(c.state->mesh.vertices(), vertices + 2);
    for (std::size_t n = vertices; n < vertices + 2; ++n) {
      EXPECT_EQ(c.state->mobility(static_cast<VertexId>(n)), Mobility::free);
    }
  }
  EXPECT_GT(moved, 0U);
  EXPECT_EQ(c.wrong(), "");
}

TEST(Relocation, IsForPointsOnEdgesAlone) {
  Case c(box(0, 1), true, 1);
  Relocation relocation(*c.state);
  for (VertexId v = 0; v < c.state->mesh.vertices(); ++v) {
    if (c.state->mesh.incident(v) == kNone || c.state->mobility(v) == Mobility::on_line) continue;
    EXPECT_FALSE(relocation.run(v)) << v;
  }
}

}  // namespace
}  // namespace delmesher::improve::relocation_test
