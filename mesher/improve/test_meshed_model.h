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
#include "mesher/improve/state.h"
#include "mesher/tetmesh/numbering.h"

namespace delmesher::improve {

// A mesh of a surface with points of all kinds; without the outside, if `inside_alone`.
struct MeshedModel {
  MeshedModel(const Surface& surface, bool inside_alone, std::uint32_t seed) : model(surface) {
    EXPECT_TRUE(model.valid);
    cdt::test_models::enrich(model, 2, seed);
    ConformingMesh given = model.run().mesh;
    if (inside_alone) keep_inside(given);
    point = vertices_in_order(given, model.points);
    const std::size_t points = model.points.size();
    state.emplace(topology_of(std::move(given), point, points), point, &model.topology,
                  std::span<const Vec3>{}, model.points, model.predicates, goals_of({}));
  }

  // By rational arithmetic, what is wrong with the mesh now.
  std::string wrong() {
    state->mesh.validate();
    const ConformingMesh now = mesh_of(state->mesh, state->point_of_vertices());
    return cdt::rational::Checker(model.topology, model.points, now).run();
  }

  cdt::test_models::Model model;
  std::vector<VertexId> point;
  std::optional<State> state;
};

}  // namespace delmesher::improve
