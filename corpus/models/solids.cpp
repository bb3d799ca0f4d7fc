#include "corpus/models/solids.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace tetproof {
namespace {

using oracles::BoxTree;
using oracles::ExactPoints;
using oracles::Index;
using oracles::InputSurface;
using oracles::Polyhedron;

void demand(const std::string& why_not) {
  if (!why_not.empty()) throw std::runtime_error(why_not);
}

// Shells do not meet, so one vertex decides.
bool contains(const InputSurface& outer, const InputSurface& inner, const ExactPoints& points) {
  for (const Index v : inner.used_vertices()) {
    const Index corners[1] = {v};
    const int inside = outer.inside(points, corners);
    if (inside >= 0) return inside > 0;
  }
  throw std::runtime_error("two shells have all vertices in common");
}

std::vector<InputSurface> shells_of(const Polyhedron& surface,
                                    const std::vector<std::vector<Index>>& components,
                                    const ExactPoints& points) {
  Polyhedron part;
  part.vertices = surface.vertices;
  std::vector<InputSurface> shells(components.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    part.triangles.clear();
    for (const Index t : components[s]) part.triangles.push_back(surface.triangles[t]);
    demand(shells[s].assign(part, points));
  }
  return shells;
}

// For each shell, those around it.
std::vector<std::vector<std::size_t>> shells_around(const std::vector<InputSurface>& shells,
                                                    const ExactPoints& points) {
  std::vector<BoxTree::Box> boxes;
  for (const InputSurface& shell : shells) {
    boxes.push_back(oracles::box_around(points, shell.used_vertices()));
  }
  const BoxTree tree(boxes);
  std::vector<std::vector<std::size_t>> around(shells.size());
  std::vector<Index> near;
  for (std::size_t s = 0; s < shells.size(); ++s) {
    near.clear();
    tree.query(boxes[s], near);
    for (const Index other : near) {
      if (other != s && contains(shells[other], shells[s], points)) around[s].push_back(other);
    }
  }
  return around;
}

}  // namespace

Solids solids_of(const Polyhedron& surface) {
  ExactPoints points;
  demand(points.assign(surface.vertices));
  InputSurface whole;
  demand(whole.assign(surface, points));
  Solids found;
  const std::vector<std::vector<Index>> components = whole.components();
  found.shell_of_triangle.resize(surface.triangles.size());
  for (std::size_t s = 0; s < components.size(); ++s) {
    for (const Index t : components[s]) found.shell_of_triangle[t] = s;
  }
  const auto around = shells_around(shells_of(surface, components, points), points);
  std::map<std::size_t, std::vector<std::size_t>> cavities;
  for (std::size_t s = 0; s < around.size(); ++s) {
    if (around[s].size() % 2 == 0) {
      cavities.try_emplace(s);
      continue;
    }
    // The innermost of those around it has all others around itself.
    const auto next = std::find_if(around[s].begin(), around[s].end(), [&](std::size_t other) {
      return around[other].size() + 1 == around[s].size();
    });
    if (next == around[s].end()) throw std::runtime_error("shells meet");
    cavities[*next].push_back(s);
  }
  for (auto& [outer, inside] : cavities) found.solids.push_back({outer, std::move(inside)});
  return found;
}

}  // namespace tetproof
