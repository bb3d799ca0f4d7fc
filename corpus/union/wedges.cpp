#include "corpus/union/wedges.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

#include "corpus/union/unite.h"

namespace tetproof::unite {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// The order of triangles around an edge, counter-clockwise from the first one if one looks against
// the direction from its low vertex to the high one.
class Around {
 public:
  Around(const Soup& soup, const EdgeUse& first) : soup_(soup), first_(first) {}
  bool operator()(const EdgeUse& a, const EdgeUse& b) const {
    const int half_a = half(a), half_b = half(b);
    if (half_a != half_b) return half_a < half_b;
    return half_a % 2 == 1 && turn(a, b) > 0;
  }

 private:
  // 0: the first triangle itself, 1: less than half a turn from it, 2: half a turn, 3: more.
  int half(const EdgeUse& use) const {
    return use.triangle == first_.triangle ? 0 : 2 - turn(first_, use);
  }
  int turn(const EdgeUse& a, const EdgeUse& b) const {
    return CGAL::orientation(point(first_.low), point(first_.high), point(apex(a)), point(apex(b)));
  }
  Kernel::Point_3 point(Index v) const {
    const Position& p = soup_.vertices[v];
    return {p[0], p[1], p[2]};
  }
  Index apex(const EdgeUse& use) const {
    const Triangle& t = soup_.triangles[use.triangle];
    return *std::find_if(t.begin(), t.end(),
                         [&](Index v) { return v != use.low && v != use.high; });
  }

  const Soup& soup_;
  const EdgeUse first_;
};

}  // namespace

// In that order the solid comes after a triangle that goes backwards along the edge, and before one
// that goes forwards.
std::vector<Wedge> wedges_at(const Soup& soup, std::span<const EdgeUse> uses) {
  std::vector<EdgeUse> order(uses.begin(), uses.end());
  const auto backward =
      std::find_if(order.begin(), order.end(), [](const EdgeUse& use) { return !use.forward; });
  if (backward == order.end()) throw InternalError("an edge without a triangle that goes back");
  std::sort(order.begin(), order.end(), Around(soup, EdgeUse(*backward)));
  std::vector<Wedge> wedges;
  for (std::size_t i = 0; i < order.size(); i += 2) {
    if (order[i].forward || i + 1 == order.size() || !order[i + 1].forward) {
      throw Twisted{order[i].low};
    }
    wedges.push_back({order[i], order[i + 1]});
  }
  return wedges;
}

Fans::Fans(const Soup& soup) : soup_(soup), corners_(3 * soup.triangles.size()) {
  Edges(soup.triangles).for_each([&](std::span<const EdgeUse> uses) {
    for (const auto& [a, b] : wedges_at(soup, uses)) {
      for (const Index v : {a.low, a.high}) {
        corners_.unite(corner(a.triangle, v), corner(b.triangle, v));
      }
    }
  });
}

Index Fans::corner(Index triangle, Index vertex) const {
  const Triangle& t = soup_.triangles[triangle];
  return static_cast<Index>(3 * triangle + (std::find(t.begin(), t.end(), vertex) - t.begin()));
}

}  // namespace tetproof::unite
