#include "mesher/improve/relocation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/improve/mesh_in_order.h"

namespace delmesher::improve {
namespace {

using namespace cdt::test_models;

// A mesh of a surface with points of all kinds; without the outside, if `inside_alone`.
struct Case {
  Case(const Surface& surface, bool inside_alone, std::uint32_t seed) : model(surface) {
    EXPECT_TRUE(model.valid);
    cdt::test_models::enrich(model, 2, seed);
    mesh = model.run();
    ImproveMesh given;
    for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
      if (inside_alone && mesh.inside[n] == 0) continue;
      given.tetrahedra.push_back(mesh.tetrahedra[n]);
      given.region.push_back(mesh.inside[n]);
    }
    given.boundary = mesh.boundary;
    point = vertices_in_order(given, model.points);
    const std::size_t points = model.points.size();
    state.emplace(work_mesh(std::move(given), point, points), point, &model.topology,
                  std::span<const Vec3>{}, model.points, model.predicates, goals_of({}));
  }

  std::vector<VertexId> on_edges() const {
    std::vector<VertexId> list;
    for (VertexId v = 0; v < state->mesh.vertices(); ++v) {
      if (state->mesh.incident(v) == kNone || state->mobility(v) != Mobility::on_line) continue;
      list.push_back(v);
    }
    return list;
  }

  // By rational arithmetic, what is wrong with the mesh now.
  std::string wrong() {
    state->mesh.validate();
    ImproveMesh now = result_of(*state);
    mesh.tetrahedra = std::move(now.tetrahedra);
    mesh.inside.assign(now.region.begin(), now.region.end());
    mesh.boundary = std::move(now.boundary);
    for (VertexId v = 0; v < point.size(); ++v) {
      if (state->mesh.incident(v) != kNone) continue;
      for (auto& chain : mesh.chain) std::erase(chain, point[v]);
    }
    return cdt::rational::Checker(model.topology, model.points, mesh, false).run();
  }

  Model model;
  cdt::CdtResult mesh;
  std::vector<VertexId> point;
  std::optional<State> state;
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

// The other side would have to be tiled, too.
TEST(Relocation, LeavesPointsWithTetrahedraOnBothSides) {
  Case c(box(0, 1), false, 1);
  Relocation relocation(*c.state);
  const std::vector<VertexId> before = c.on_edges();
  EXPECT_FALSE(before.empty());
  for (const VertexId v : before) EXPECT_FALSE(relocation.run(v));
  EXPECT_EQ(c.on_edges(), before);
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
}  // namespace delmesher::improve
