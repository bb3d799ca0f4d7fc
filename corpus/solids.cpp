#include "corpus/solids.h"

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

struct Shell {
  InputSurface surface;
  BoxTree::Box box;
};

std::vector<std::size_t> number_shells(const InputSurface& whole) {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> shell(whole.triangles().size(), kNone);
  std::size_t count = 0;
  for (Index seed = 0; seed < shell.size(); ++seed) {
    if (shell[seed] != kNone) continue;
    std::vector<Index> members = {seed};
    shell[seed] = count;
    while (!members.empty()) {
      const Index t = members.back();
      members.pop_back();
      for (int i = 0; i < 3; ++i) {
        const Index n = whole.neighbour(t, i);
        if (shell[n] == kNone) members.push_back(n);
        shell[n] = count;
      }
    }
    ++count;
  }
  return shell;
}

bool meet(const BoxTree::Box& a, const BoxTree::Box& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (a.high[i] < b.low[i] || b.high[i] < a.low[i]) return false;
  }
  return true;
}

// Shells do not meet, so that one vertex tells.
bool contains(const Shell& outer, const Shell& inner, const ExactPoints& points) {
  if (!meet(outer.box, inner.box)) return false;
  for (const Index v : inner.surface.used_vertices()) {
    const Index corners[1] = {v};
    const int inside = outer.surface.inside(points, corners);
    if (inside >= 0) return inside > 0;
  }
  throw std::runtime_error("two shells have all vertices in common");
}

std::vector<Shell> shells_of(const Polyhedron& surface, const std::vector<std::size_t>& shell,
                             const ExactPoints& points) {
  Polyhedron part;
  part.vertices = surface.vertices;
  std::vector<std::vector<std::array<Index, 3>>> triangles(
      1 + *std::max_element(shell.begin(), shell.end()));
  for (std::size_t t = 0; t < shell.size(); ++t) {
    triangles[shell[t]].push_back(surface.triangles[t]);
  }
  std::vector<Shell> shells(triangles.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    part.triangles = std::move(triangles[s]);
    demand(shells[s].surface.assign(part, points));
    shells[s].box = oracles::box_around(points, shells[s].surface.used_vertices());
  }
  return shells;
}

}  // namespace

Solids solids_of(const Polyhedron& surface) {
  ExactPoints points;
  demand(points.assign(surface.vertices));
  InputSurface whole;
  demand(whole.assign(surface, points));
  Solids found;
  found.shell_of_triangle = number_shells(whole);
  const std::vector<Shell> shells = shells_of(surface, found.shell_of_triangle, points);
  std::vector<std::vector<std::size_t>> around(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    for (std::size_t other = 0; other < shells.size(); ++other) {
      if (other != s && contains(shells[other], shells[s], points)) around[s].push_back(other);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> cavities;
  for (std::size_t s = 0; s < shells.size(); ++s) {
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
