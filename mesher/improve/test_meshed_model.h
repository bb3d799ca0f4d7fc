// A meshed surface between two calls of an operation, for tests.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <span>
#include <string>
#include <utility>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/improve/state.h"

namespace delmesher::improve {

// A mesh of a surface with points of all kinds; without the outside, if `inside_alone`.
struct MeshedModel {
  MeshedModel(const Surface& surface, bool inside_alone, std::uint32_t seed) : model(surface) {
    EXPECT_TRUE(model.valid);
    cdt::test_models::enrich(model, 2, seed);
    ConformingMesh given = model.run().mesh;
    if (inside_alone) keep_inside(given);
    state.emplace(numbered(std::move(given), model.points), &model.topology,
                  std::span<const Vec3>{}, model.points, model.predicates, goals_of({}));
  }

  // By rational arithmetic, what is wrong with the mesh now.
  std::string wrong() {
    state->mesh.validate();
    return cdt::rational::Checker(model.topology, model.points, state->conforming()).run();
  }

  cdt::test_models::Model model;
  std::optional<State> state;
};

}  // namespace delmesher::improve
