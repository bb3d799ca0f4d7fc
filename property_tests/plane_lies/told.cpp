#include "property_tests/plane_lies/told.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace tetproof::plane_lies {

using delmesher::PlanarGraph;
using delmesher::PlaneOptions;
using delmesher::PlaneRecord;
using delmesher::PlaneResult;
using Side = PlaneRecord::Side;
using Index = std::uint32_t;

PlanarGraph honest_graph() {
  PlanarGraph graph;
  graph.vertices = {{0, 0},     {4.5, 0},      {4, 4},    {2.2, 1.1}, {0, 4},      {1, 1},
                    {1.5, 0.5}, {1.25, 0.875}, {0.25, 2}, {0.25, 3},  {0.2505, 2}, {0.2505, 3}};
  graph.segments = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0},
                    {5, 6}, {6, 7}, {7, 5}, {8, 9}, {10, 11}};
  graph.markers = {1, 1, 2, 2, 1, 3, 3, 3, 4, 5};
  graph.holes = {{1.25, 0.8125}};
  return graph;
}

PlaneOptions honest_options() {
  PlaneOptions options;
  options.want_exact = true;
  options.tau = 1e-2;
  return options;
}

Told run_of(const PlaneOptions& options, const PlanarGraph& graph) {
  const PlaneResult result = delmesher::triangulate_polygon(graph, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  Told told{graph, oracles::plane_file_of(result.mesh), result.exact, {}};
  told.how.promised = oracles::promise_of(options);
  return told;
}

const Told& honest() {
  static const Told told = run_of(honest_options());
  return told;
}

std::array<Index, 3> turned(std::array<Index, 3> t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

PlaneRecord::Triangle& some(std::vector<PlaneRecord::Triangle>& triangles, Side side) {
  return *std::find_if(triangles.begin(), triangles.end(),
                       [side](const auto& t) { return t.side == side; });
}

std::size_t steiner(const Told& told) {
  for (std::size_t i = 0; i < told.record.mesh_vertices.size(); ++i) {
    if (told.record.mesh_vertices[i] >= told.graph.vertices.size()) return i;
  }
  ADD_FAILURE() << "no Steiner point";
  return 0;
}

}  // namespace tetproof::plane_lies
