#include "oracles/mesh/boundary_edges.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace tetproof::oracles {

BoundaryEdges::BoundaryEdges(const std::vector<Face>& faces, std::size_t points)
    : edges_(3 * faces.size()), first_(points + 1, 0) {
  for (const Face& face : faces) {
    for (const Index v : face) ++first_[v + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<Index> next(first_.begin(), first_.end() - 1);
  for (Index f = 0; f < faces.size(); ++f) {
    const Face& face = faces[f];
    for (std::size_t i = 0; i < 3; ++i) edges_[next[face[i]]++] = {face[(i + 1) % 3], f};
  }
  for (Index v = 0; v < points; ++v) {
    std::sort(edges_.begin() + first_[v], edges_.begin() + first_[v + 1],
              [](const Edge& a, const Edge& b) {
                return std::pair(a.to, a.face) < std::pair(b.to, b.face);
              });
  }
}

BoundaryEdges::Range BoundaryEdges::between(Index a, Index b) const {
  if (a >= first_.size() - 1) return {0, 0};
  const auto begin = edges_.begin() + first_[a], end = edges_.begin() + first_[a + 1];
  const auto first =
      std::lower_bound(begin, end, b, [](const Edge& edge, Index to) { return edge.to < to; });
  const auto last =
      std::upper_bound(first, end, b, [](Index to, const Edge& edge) { return to < edge.to; });
  return {static_cast<std::size_t>(first - edges_.begin()),
          static_cast<std::size_t>(last - edges_.begin())};
}

bool BoundaryEdges::put_in_chain(Index a, Index b, Index facet) {
  const Range edges = between(a, b);
  if (edges.empty()) return true;
  if (left_of(edges.first) != kNone) return false;
  edges_[edges.first].chain_facet = facet;
  return true;
}

}  // namespace tetproof::oracles
