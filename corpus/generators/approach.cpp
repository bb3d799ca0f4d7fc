#include "corpus/generators/approach.h"

#include <algorithm>

#include "corpus/generators/certify.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using delmesher::Surface;
using shapes::mix;
using shapes::Point;

Point random_point(const Surface& s, const std::array<std::uint32_t, 3>& t, Random& r) {
  const Point on_edge = mix(s.vertices[t[0]], s.vertices[t[1]], r.unit());
  return mix(on_edge, s.vertices[t[2]], r.between(0.1, 0.9));
}

// Halves the way between the last valid place and the first invalid one until they are neighbours.
void bisect(Surface s, Approach& a) {
  double low = 0, high = 1;
  const Point far = a.invalid;
  for (int step = 0; step < 64; ++step) {
    const double middle = low + (high - low) / 2;
    const Point p = mix(a.from, far, middle);
    if (p == a.valid || p == a.invalid) break;
    s.vertices[a.vertex] = p;
    if (const auto defect = first_defect(s)) {
      high = middle;
      a.invalid = p;
      a.defect = *defect;
    } else {
      low = middle;
      a.valid = p;
    }
  }
}

}  // namespace

std::optional<Approach> approach(const Surface& surface, Random& random) {
  for (int attempt = 0; attempt < 12; ++attempt) {
    const auto& start = surface.triangles[random.below(surface.triangles.size())];
    const auto& goal = surface.triangles[random.below(surface.triangles.size())];
    Approach a;
    a.vertex = start[random.below(3)];
    if (std::find(goal.begin(), goal.end(), a.vertex) != goal.end()) continue;
    a.from = a.valid = surface.vertices[a.vertex];
    // A little beyond the facet.
    a.invalid = mix(a.from, random_point(surface, goal, random), 1.0625);
    Surface moved = surface;
    moved.vertices[a.vertex] = a.invalid;
    const auto defect = first_defect(moved);
    if (!defect) continue;
    a.defect = *defect;
    bisect(surface, a);
    return a;
  }
  return {};
}

bool pull_near(Surface& surface, Random& random, int bits) {
  const auto way = approach(surface, random);
  if (!way) return false;
  Surface pulled = surface;
  pulled.vertices[way->vertex] =
      random.chance(0.2) ? way->valid : mix(way->valid, way->from, random.tiny(bits));
  if (!certified_valid(pulled)) return false;
  surface = std::move(pulled);
  return true;
}

}  // namespace tetproof
