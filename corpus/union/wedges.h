// Around edges and vertices where parts touch: which triangles bound the same part?
#pragma once

#include <array>
#include <span>
#include <vector>

#include "corpus/union/soup.h"
#include "oracles/base/union_find.h"

namespace tetproof::unite {

// Two triangles at an edge with solid, and no other triangle, between them.
using Wedge = std::array<EdgeUse, 2>;

// Thrown where solid and outside do not alternate around an edge: its triangles are so near each
// other that rounding its middle turned them round.
struct Twisted {
  Index vertex;  // an end of the edge
};

// `uses`: those of one edge. The triangles are closed, with outward normals, and no two of them lie
// on each other; if not, it throws InternalError or Twisted. Decided exactly.
std::vector<Wedge> wedges_at(const Soup& soup, std::span<const EdgeUse> uses);

// Corners of triangles are connected at their vertex, over wedges. Corner 3 t + k is that of
// vertex k of triangle t.
class Fans {
 public:
  explicit Fans(const Soup& soup);
  // A corner that stands for all of the same fan.
  Index fan(Index corner) { return corners_.find(corner); }
  Index fan(Index triangle, Index vertex) { return fan(corner(triangle, vertex)); }

 private:
  Index corner(Index triangle, Index vertex) const;

  const Soup& soup_;
  oracles::UnionFind corners_;
};

}  // namespace tetproof::unite
