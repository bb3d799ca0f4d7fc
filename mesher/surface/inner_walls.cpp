#include "mesher/surface/inner_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mesher/base/disjoint_sets.h"
#include "mesher/geometry/vector.h"

namespace delmesher::surface {
namespace {

// A triangle at an edge, which goes from the lower to the higher vertex.
struct Leaf {
  double angle;
  std::uint32_t triangle;
  bool forward;  // the triangle runs along the edge in its direction
};
using Leaves = std::map<std::array<std::uint32_t, 2>, std::vector<Leaf>>;

Leaves leaves_of(const Surface& surface) {
  Leaves leaves;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corners = surface.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      leaves[{std::min(a, b), std::max(a, b)}].push_back({0, t, a < b});
    }
  }
  return leaves;
}

// Sorts the triangles around an edge counter-clockwise, as seen against its direction.
void sort_around(const Surface& surface, const std::array<std::uint32_t, 2>& edge,
                 std::vector<Leaf>& leaves) {
  const Vec3& start = surface.vertices[edge[0]];
  const Vec3 along = subtract(surface.vertices[edge[1]], start);
  const auto radius = [&](const Leaf& leaf) {
    for (const std::uint32_t v : surface.triangles[leaf.triangle]) {
      if (v != edge[0] && v != edge[1]) return subtract(surface.vertices[v], start);
    }
    return Vec3{};
  };
  const Vec3 up = cross(along, radius(leaves[0])), zero = cross(up, along);
  const double scale = std::sqrt(dot(along, along));
  for (Leaf& leaf : leaves) {
    const Vec3 r = radius(leaf);
    leaf.angle = std::atan2(scale * dot(r, up), dot(r, zero));
  }
  std::stable_sort(leaves.begin(), leaves.end(),
                   [](const Leaf& a, const Leaf& b) { return a.angle < b.angle; });
}

// The side of a triangle from which it is seen counter-clockwise, and the other.
std::uint32_t front(std::uint32_t triangle) {
  return 2 * triangle;
}
std::uint32_t back(std::uint32_t triangle) {
  return 2 * triangle + 1;
}

// Six times the volume of each set of sides that see each other; that of the outside is negative.
std::map<std::uint32_t, double> volumes(const Surface& surface, DisjointSets& sides) {
  std::map<std::uint32_t, double> volume;
  const Vec3& origin = surface.vertices[surface.triangles[0][0]];
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    const double v =
        dot(subtract(surface.vertices[a], origin),
            cross(subtract(surface.vertices[b], origin), subtract(surface.vertices[c], origin)));
    volume[sides.smallest(back(t))] += v;
    volume[sides.smallest(front(t))] -= v;
  }
  return volume;
}

}  // namespace

std::optional<Enclosed> enclosed_by(const Surface& surface) {
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  if (count == 0) return std::nullopt;
  DisjointSets sides(std::size_t{2} * count), sheets(count);
  Enclosed enclosed;
  Leaves edges = leaves_of(surface);
  for (auto& [edge, leaves] : edges) {
    if (leaves.size() == 1) return std::nullopt;
    enclosed.closes &= leaves.size() % 2 == 0;
    if (leaves.size() == 2) sheets.join(leaves[0].triangle, leaves[1].triangle);
    sort_around(surface, edge, leaves);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const Leaf& leaf = leaves[i];
      const Leaf& next = leaves[(i + 1) % leaves.size()];
      sides.join(leaf.forward ? front(leaf.triangle) : back(leaf.triangle),
                 next.forward ? back(next.triangle) : front(next.triangle));
    }
  }
  const std::map<std::uint32_t, double> volume = volumes(surface, sides);
  std::set<std::uint32_t> filled;
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t behind = sides.smallest(back(t));
    if (volume.at(behind) > 0) filled.insert(behind);
  }
  enclosed.parts = filled.size();
  std::set<std::uint32_t> of_walls;
  for (std::uint32_t t = 0; t < count; ++t) {
    if (!filled.contains(sides.smallest(front(t))) || !filled.contains(sides.smallest(back(t)))) {
      continue;
    }
    enclosed.walls.push_back(t);
    of_walls.insert(sheets.smallest(t));
  }
  enclosed.sheets = of_walls.size();
  return enclosed;
}

}  // namespace delmesher::surface
