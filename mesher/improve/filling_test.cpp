#include "mesher/improve/filling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "mesher/improve/test_meshed_model.h"

namespace delmesher::improve::filling_test {
namespace {

using namespace cdt::test_models;

struct Case : MeshedModel {
  using MeshedModel::MeshedModel;

  void fill(const Goals& goals = goals_of({})) { Filling(*state, goals, model.control).run(); }

  std::multiset<std::array<VertexId, 3>> faces() const {
    std::multiset<std::array<VertexId, 3>> keys;
    const MeshTopology& mesh = state->mesh;
    for (TetId t = 0; t < mesh.slots(); ++t) {
      for (int i = 0; i < 4; ++i) {
        if (!mesh.alive(t) || mesh.facet(t, i) == kNone) continue;
        std::array<VertexId, 3> key{};
        std::ranges::transform(kFace[i], key.begin(), [&](int k) { return mesh.tet(t)[k]; });
        std::ranges::sort(key);
        keys.insert(key);
      }
    }
    return keys;
  }
};

TEST(Filling, PutsPointsIntoTheVolumeAndLeavesTheSurfaceAlone) {
  std::size_t points = 0;
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    Case c(s, true, seed++);
    const auto faces = c.faces();
    const std::size_t before = c.state->mesh.vertices();
    c.fill();
    EXPECT_EQ(c.wrong(), "") << s.triangles.size() << " triangles";
    EXPECT_EQ(c.faces(), faces);
    for (VertexId v = 0; v < c.state->mesh.vertices(); ++v) {
      if (v < before) continue;
      EXPECT_EQ(c.state->mobility(v), Mobility::free);
      EXPECT_NE(c.state->mesh.incident(v), kNone);
      ++points;
    }
  }
  EXPECT_GT(points, 0U);
}

// A second time there is hardly anything to do.
TEST(Filling, Ends) {
  Case c(box(0, 1), true, 1);
  Goals goals = goals_of({});
  goals.max_edge = 0.25;
  const std::size_t before = c.state->mesh.vertices();
  c.fill(goals);
  const std::size_t filled = c.state->mesh.vertices();
  EXPECT_GT(filled, before + 27);
  c.fill(goals);
  EXPECT_LE(c.state->mesh.vertices() - filled, (filled - before) / 10);
  EXPECT_EQ(c.wrong(), "");
}

}  // namespace
}  // namespace delmesher::improve::filling_test
