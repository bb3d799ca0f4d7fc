#include "oracles/mesh/shells.h"

#include <algorithm>
#include <utility>

#include "oracles/base/edge_key.h"
#include "oracles/mesh/solids.h"

namespace tetproof::oracles {

Shells::Shells(const ExactPoints& points, const std::vector<Face>& triangles,
               std::vector<std::uint8_t> empty)
    : points_(points), triangles_(triangles), empty_(std::move(empty)) {
  UnionFind sets(empty_.size());
  connect(sets);
  for (Index s = 0; s < empty_.size(); ++s) {
    if (empty_[s] == 0) continue;
    Shell& shell = shells_[sets.find(s)];
    shell.sides.push_back(s);
    add_side(s, shell.volume);
  }
}

// Joins the empty sides around each edge.
void Shells::connect(UnionFind& sets) {
  std::map<std::uint64_t, std::vector<AtEdge>> edges;
  for (Index n = 0; n < triangles_.size(); ++n) {
    const Face& c = triangles_[n];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = c[k], b = c[(k + 1) % 3];
      edges[edge_key(a, b)].push_back({n, c[(k + 2) % 3], a < b});
    }
  }
  for (auto& [key, around] : edges) {
    const auto low = static_cast<Index>(key >> 32), high = static_cast<Index>(key);
    sort_around(low, high, around);
    for (std::size_t n = 0; n < around.size(); ++n) {
      const AtEdge &here = around[n], &next = around[n + 1 < around.size() ? n + 1 : 0];
      // A triangle that runs along the edge looks to where one turns to the left around it.
      const Index a = side(here.triangle, !here.runs_along),
                  b = side(next.triangle, next.runs_along);
      if (empty_[a] != empty_[b]) {
        broken_wedges_.push_back({here.triangle, next.triangle});
      } else if (empty_[a] != 0) {
        sets.unite(a, b);
      }
    }
  }
}

// Turning to the left around the edge, from the first one on.
void Shells::sort_around(Index low, Index high, std::vector<AtEdge>& around) const {
  if (around.size() < 3) return;
  const Index first = around.front().apex;
  const auto half = [&](Index apex) {
    if (apex == first) return 0;
    const int s = exact::orient3d(points_, low, high, first, apex);
    return s > 0 ? 1 : s == 0 ? 2 : 3;
  };
  std::stable_sort(around.begin(), around.end(), [&](const AtEdge& a, const AtEdge& b) {
    const int i = half(a.apex), j = half(b.apex);
    return i != j ? i < j : exact::orient3d(points_, low, high, a.apex, b.apex) > 0;
  });
}

std::vector<Face> Shells::faces_of(const Shell& shell) const {
  std::vector<Face> faces;
  for (const Index s : shell.sides) faces.push_back(triangles_[s / 2]);
  return faces;
}

// Does a shell surround what is on this side of a triangle?
bool Shells::surrounds(const Shell& shell, Index what) const {
  Index own = kNone;
  for (Index n = 0; n < shell.sides.size(); ++n) {
    if (shell.sides[n] / 2 == what / 2) own = n;
  }
  return RayTarget(points_, faces_of(shell)).surrounds(triangles_[what / 2], what % 2 != 0, own);
}

ExactSum Shells::without_cavities(const Shell& outer) {
  ExactSum sum = outer.volume;
  for (const auto& [number, cavity] : shells_) {
    if (cavity.volume.sign() >= 0) continue;
    const Index what = cavity.sides.front();
    if (innermost([&](const Shell& other) { return surrounds(other, what); }) != &outer) continue;
    for (const Index s : cavity.sides) add_side(s, sum);
  }
  return sum;
}

// Seen from what is on its side, a triangle is turned the other way in front.
void Shells::add_side(Index s, ExactSum& sum) const {
  exact::Volume6 volume6;
  const ExactNumber& volume = volume6.from_origin(points_, triangles_[s / 2]);
  s % 2 != 0 ? sum += volume : sum -= volume;
}

}  // namespace tetproof::oracles
