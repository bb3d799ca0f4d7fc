// Planar graphs on their way through the stages; for tests.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "mesher/plane/refiner.h"

namespace delmesher::plane::test_graphs {

// A closed polygon.
inline PlanarGraph ring(const std::vector<std::array<double, 2>>& corners) {
  PlanarGraph graph;
  graph.vertices = corners;
  for (std::uint32_t i = 0; i < corners.size(); ++i) {
    graph.segments.push_back({i, (i + 1) % static_cast<std::uint32_t>(corners.size())});
  }
  return graph;
}

inline PlanarGraph square() {
  return ring({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
}

// Two of its corners are acute.
inline PlanarGraph arrow() {
  return ring({{0, 0}, {4, 0}, {1, 1}, {0, 4}});
}

// Around the origin, with random radii.
inline PlanarGraph star(int corners, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::array<double, 2>> points;
  for (int i = 0; i < corners; ++i) {
    const double angle = 6.283185307179586 * i / corners;
    const double radius = 1 + static_cast<double>(random() % 1024) / 512;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return ring(points);
}

// A graph up to the refinement.
struct Stages {
  explicit Stages(PlanarGraph given, const ChamferOptions& chamfering = {})
      : input(std::move(given)),
        graph(build_graph(input, points, predicates, control)),
        chamfered(chamfer(graph, points, predicates, chamfering, spared, control)) {}

  VertexId vertex(std::uint32_t number) const { return graph.id[number]; }

  PlanarGraph input;
  Limits limits;
  Control control{limits};
  PointStore points;
  PlanePredicates predicates{points};
  InputGraph graph;
  Spared spared;
  Chamfered chamfered;
};

}  // namespace delmesher::plane::test_graphs
