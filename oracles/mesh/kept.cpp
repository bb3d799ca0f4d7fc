#include "oracles/mesh/kept.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <vector>

#include "oracles/verdict/edge_sizes.h"

namespace tetproof::oracles {
namespace {

using Corners = std::array<Position, 3>;

Corners corners_of(const std::vector<Position>& vertices, Face triangle, Index first) {
  Corners corners;
  for (int k = 0; k < 3; ++k) corners[k] = vertices[triangle[k] - first];
  std::ranges::sort(corners);
  return corners;
}

std::vector<Position> used(const std::vector<Corners>& triangles) {
  std::vector<Position> places;
  for (const Corners& corners : triangles)
    places.insert(places.end(), corners.begin(), corners.end());
  std::ranges::sort(places);
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

bool has_longer_edge(const Corners& at, const EdgeSizes& bound) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (bound.excess(at[k], at[(k + 1) % 3]) > EdgeSizes::kMost) return true;
  }
  return false;
}

}  // namespace

OracleReport check_kept(const Polyhedron& input, const MeshFile& mesh, std::span<const Face> faces,
                        Index first, const Promise& promise) {
  OracleReport report("kept", "triangles");
  const EdgeSizes bound(promise.size_field, promise.size_growth, promise.longest_whole());
  std::uint64_t split = 0, too_long = 0;
  report.checked = input.triangles.size();
  std::vector<Corners> given, made;
  for (const Face& triangle : input.triangles) {
    given.push_back(corners_of(input.vertices, triangle, 0));
  }
  for (const Face& face : faces) made.push_back(corners_of(mesh.vertices, face, first));
  std::ranges::sort(made);
  std::vector<std::uint8_t> taken(made.size(), 0);
  for (std::size_t t = 0; t < given.size(); ++t) {
    const auto [begin, end] = std::equal_range(made.begin(), made.end(), given[t]);
    const auto free = std::find(taken.begin() + (begin - made.begin()),
                                taken.begin() + (end - made.begin()), std::uint8_t{0});
    const bool is_long = promise.halves && has_longer_edge(given[t], bound);
    too_long += is_long ? 1 : 0;
    if (free != taken.begin() + (end - made.begin())) {
      *free = 1;
      continue;
    }
    ++split;
    if (is_long) continue;
    report.fail("triangle " + std::to_string(t) + " is not a face of the mesh",
                {Site::Kind::input_triangle, {static_cast<Index>(t), 0, 0}});
  }
  std::vector<Position> added;
  std::ranges::set_difference(used(made), used(given), std::back_inserter(added));
  report.figures = {{kSplitTriangles, static_cast<double>(split)},
                    {kAddedVertices, static_cast<double>(added.size())}};
  if (promise.halves) report.figures.emplace_back(kLongTriangles, static_cast<double>(too_long));
  return report;
}

}  // namespace tetproof::oracles
