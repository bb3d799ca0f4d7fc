#include "mesher/improve/insertion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "mesher/improve/test_meshed_model.h"

namespace delmesher::improve::insertion_test {
namespace {

using namespace cdt::test_models;

struct Case : MeshedModel {
  using MeshedModel::MeshedModel;

  float worst_score() const {
    float worst = HUGE_VALF;
    for (TetId t = 0; t < state->mesh.slots(); ++t) {
      if (state->mesh.alive(t)) worst = std::min(worst, state->score(t));
    }
    return worst;
  }

  // From all bad tetrahedra once; returns how many points have each mobility.
  std::map<Mobility, int> put_in_points(Measure measure) {
    state->measure_by(measure);
    Insertion insertion(*state);
    const std::size_t slots = state->mesh.slots(), vertices = state->mesh.vertices();
    const float before = worst_score();
    for (TetId t = 0; t < slots; ++t) {
      if (!state->mesh.alive(t) || !insertion.run_on_surface(t)) continue;
      if (measure == Measure::shape) continue;
      for (const TetId u : state->mesh.created()) EXPECT_GE(state->score(u), State::kMended);
    }
    EXPECT_GE(worst_score(), before);
    std::map<Mobility, int> added;
    for (auto v = static_cast<VertexId>(vertices); v < state->mesh.vertices(); ++v) {
      ++added[state->mobility(v)];
    }
    for (VertexId v = 0; v < vertices; ++v) {
      const Mobility mobility = state->mobility(v);
      if (mobility == Mobility::free || mobility == Mobility::in_plane) continue;
      EXPECT_NE(state->mesh.incident(v), kNone) << v;
    }
    return added;
  }
};

TEST(Insertion, PutsPointsOnTheSurfaceAndKeepsIt) {
  std::map<Mobility, int> added;
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    for (const bool inside_alone : {false, true}) {
      for (const Measure measure : {Measure::shape, Measure::dihedrals}) {
        Case c(s, inside_alone, seed++);
        for (const auto& [mobility, n] : c.put_in_points(measure)) added[mobility] += n;
        EXPECT_EQ(c.wrong(), "") << s.triangles.size()
                                 << " triangles, inside alone: " << inside_alone;
      }
    }
  }
  EXPECT_GT(added[Mobility::in_plane], 100);
  EXPECT_GT(added[Mobility::on_line], 100);
  EXPECT_EQ(added.size(), 2U);
}

}  // namespace
}  // namespace delmesher::improve::insertion_test
