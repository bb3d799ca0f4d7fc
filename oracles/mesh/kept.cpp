#include "oracles/mesh/kept.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

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

}  // namespace

OracleReport check_kept(const Polyhedron& input, const MeshFile& mesh, std::span<const Face> faces,
                        Index first) {
  OracleReport report("kept", "triangles");
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
    if (free == taken.begin() + (end - made.begin())) {
      report.fail("triangle " + std::to_string(t) + " is not a face of the mesh");
    } else {
      *free = 1;
    }
  }
  std::vector<Position> added;
  std::ranges::set_difference(used(made), used(given), std::back_inserter(added));
  report.figures = {{kSplitTriangles, static_cast<double>(report.violations)},
                    {kAddedVertices, static_cast<double>(added.size())}};
  return report;
}

}  // namespace tetproof::oracles
