// A meshed surface between two calls of an operation, for tests.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/improve/mesh_in_order.h"
#include "mesher/improve/state.h"

namespace delmesher::improve {

// A mesh of a surface with points of all kinds; without the outside, if `inside_alone`.
struct MeshedModel {
  MeshedModel(const Surface& surface, bool inside_alone, std::uint32_t seed) : model(surface) {
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

  cdt::test_models::Model model;
  cdt::CdtResult mesh;
  std::vector<VertexId> point;
  std::optional<State> state;
};

}  // namespace delmesher::improve
