#include "oracles/mesh/loose_points.h"

#include <algorithm>
#include <string>
#include <vector>

#include "oracles/base/box.h"
#include "oracles/base/triangle_distance.h"
#include "oracles/mesh/region_points.h"

namespace tetproof::oracles {
namespace {

bool is_on(const ExactPoints& points, Index p, const std::array<Index, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  if (exact::orient3d(points, a, b, c, p) != 0) return false;
  const ExactVector normal = exact::area2(points, a, b, c);
  return sgn(exact::dot(exact::area2(points, p, b, c), normal)) >= 0 &&
         sgn(exact::dot(exact::area2(points, a, p, c), normal)) >= 0 &&
         sgn(exact::dot(exact::area2(points, a, b, p), normal)) >= 0;
}

bool is_near(const Polyhedron& input, const ExactPoints& points, Index p, double near) {
  return std::ranges::any_of(input.triangles, [&](const auto& t) {
    if (is_on(points, p, t)) return true;
    const Corners corners = {input.vertices[t[0]], input.vertices[t[1]], input.vertices[t[2]]};
    return near > 0 && distance_to_triangle(input.vertices[p], corners) <= near;
  });
}

}  // namespace

std::vector<Index> loose_points(const Polyhedron& input) {
  std::vector<std::uint8_t> has_triangle(input.vertices.size(), 0);
  for (const auto& triangle : input.triangles) {
    for (const Index v : triangle) {
      if (v < has_triangle.size()) has_triangle[v] = 1;
    }
  }
  std::vector<Index> loose;
  for (Index v = 0; v < input.vertices.size(); ++v) {
    if (has_triangle[v] == 0) loose.push_back(v);
  }
  return loose;
}

OracleReport check_loose_points(const Polyhedron& input, const MeshFile& mesh,
                                const TetComplex& complex, double near) {
  OracleReport report("points", "points of no triangle");
  std::vector<Index> missing = loose_points(input);
  report.checked = missing.size();
  if (missing.empty()) return report;
  std::vector<Position> there = mesh.vertices;
  std::ranges::sort(there);
  std::erase_if(missing,
                [&](Index v) { return std::ranges::binary_search(there, input.vertices[v]); });
  const std::vector<std::vector<Index>> around =
      tetrahedra_around(*complex.points, complex, missing);
  Box box;
  for (const auto& triangle : input.triangles) {
    for (const Index v : triangle) box.add(input.vertices[v]);
  }
  const auto is_beside = [&](const Position& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(p[k] > box.low[k] && p[k] < box.high[k])) return true;
    }
    return false;
  };
  std::uint64_t outside = 0, on_surface = 0;
  for (std::size_t n = 0; n < missing.size(); ++n) {
    if (around[n].empty() || is_beside(input.vertices[missing[n]])) {
      ++outside;
    } else if (is_near(input, *complex.points, missing[n], near)) {
      ++on_surface;
    } else {
      report.fail("input vertex " + std::to_string(missing[n]) + " is in " +
                      complex.tet_name(around[n].front()) + ", and no vertex",
                  {Site::Kind::input_vertex, {missing[n], 0, 0}});
    }
  }
  if (outside > 0) report.figures.emplace_back("outside", static_cast<double>(outside));
  if (on_surface > 0) report.figures.emplace_back("on triangles", static_cast<double>(on_surface));
  return report;
}

}  // namespace tetproof::oracles
