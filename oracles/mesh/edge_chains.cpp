#include "oracles/mesh/edge_chains.h"

#include <algorithm>
#include <cmath>

#include "oracles/base/distances.h"
#include "oracles/base/steps.h"
#include "oracles/base/vectors.h"

namespace tetproof::oracles {

// ------------------------------------------------------------------------------------- vertices

VertexMatch::VertexMatch(const ExactPoints& points, const BoundaryEdges& edges,
                         const InputSurface& surface, const ConformityOptions& options)
    : points_(points),
      edges_(edges),
      tolerance_(options.largest_tolerance * surface.diagonal()),
      match_(surface.used_vertices().back() + 1, kNone),
      matched_(points.size(), 0) {
  for (const Index v : surface.used_vertices()) {
    match_[v] = v;
    if (edges.has_vertex(v)) continue;
    sort_by_position();
    match_[v] = equal_vertex(v);
    if (match_[v] != kNone || options.exact) continue;
    match_[v] = nearest_vertex(v);
    moved_.push_back(v);
  }
  for (const Index v : surface.used_vertices()) {
    if (match_[v] != kNone) matched_[match_[v]] = 1;
  }
}

void VertexMatch::sort_by_position() {
  if (!by_position_.empty()) return;
  for (Index v = 0; v < points_.size(); ++v) {
    if (edges_.has_vertex(v)) by_position_.push_back(v);
  }
  std::sort(by_position_.begin(), by_position_.end(), [&](Index a, Index b) {
    const Position &p = points_.nearest(a), &q = points_.nearest(b);
    return p != q ? p < q : a < b;
  });
}

// The last one.
Index VertexMatch::equal_vertex(Index input_vertex) const {
  const Position& p = points_.nearest(input_vertex);
  Index result = kNone;
  auto found = std::lower_bound(
      by_position_.begin(), by_position_.end(), p,
      [&](Index a, const Position& position) { return points_.nearest(a) < position; });
  for (; found != by_position_.end() && points_.nearest(*found) == p; ++found) {
    if (exact::equal(points_, *found, input_vertex)) result = *found;
  }
  return result;
}

Index VertexMatch::nearest_vertex(Index input_vertex) const {
  const Position p = points_.nearest(input_vertex);
  Index best = kNone;
  double distance = tolerance_;
  const auto first = std::lower_bound(by_position_.begin(), by_position_.end(), p[0] - distance,
                                      [&](Index a, double x) { return points_.nearest(a)[0] < x; });
  for (auto i = first; i != by_position_.end(); ++i) {
    const Position q = points_.nearest(*i);
    if (q[0] > p[0] + distance) break;
    const double d = oracles::distance(q, p);
    if (d < distance) {
      distance = d;
      best = *i;
    }
  }
  return best;
}

// --------------------------------------------------------------------------------------- chains

// Position of v along the edge (0 at its start, 1 at its end) and distance from its line, in
// doubles: for choosing among neighbours when there is a tolerance.
double EdgeChains::progress(const InputSurface::Edge& edge, Index v, double& distance) const {
  steps += 2;
  const Position p = points_.nearest(edge.from), q = points_.nearest(edge.to),
                 r = points_.nearest(v);
  // Squares of lengths need not be doubles.
  const double length = oracles::distance(p, q);
  Position u = minus(q, p);
  for (double& x : u) x /= length;
  const Position w = minus(r, p), across = cross(u, w);
  distance = std::hypot(across[0], across[1], across[2]);
  return dot(u, w) / length;
}

// Exactly: is `next` on the line of the edge, beyond `here` and not beyond the edge's end?
bool EdgeChains::advances(const InputSurface::Edge& edge, Index here, Index next) const {
  return exact::collinear(points_, edge.from, edge.to, next) &&
         exact::dot_sign(points_, edge.from, edge.to, here, next) > 0 &&
         exact::dot_sign(points_, edge.from, edge.to, next, edge.to) >= 0;
}

// Input edges meet at common ends only, so no other input vertex and no edge of another chain
// belongs to a chain, however close they are.
bool EdgeChains::follow(const InputSurface::Edge& edge, double tolerance,
                        std::vector<Index>& chain) const {
  const Index goal = match_.of(edge.to);
  chain = {match_.of(edge.from)};
  if (!edges_.between(chain[0], goal).empty() && !edges_.in_chain(chain[0], goal)) {
    chain.push_back(goal);
    return true;
  }
  double distance = 0, reached = progress(edge, chain[0], distance);
  while (chain.back() != goal) {
    Index best = kNone;
    double best_distance = 0, best_progress = 0;
    const auto [first, last] = edges_.from(chain.back());
    for (std::size_t i = first; i < last; ++i) {
      const Index next = edges_[i].to;
      if (next != goal && (match_.is_matched(next) || edges_.in_chain(chain.back(), next))) {
        continue;
      }
      const double at = progress(edge, next, distance);
      if (options_.exact) {
        if (!advances(edge, chain.back(), next)) continue;
      } else if (next != goal && !(at > reached && at < 1 + tolerance &&
                                   distance <= tolerance * surface_.diagonal())) {
        continue;
      }
      if (best == kNone || distance < best_distance) {
        best = next;
        best_distance = distance;
        best_progress = at;
      }
    }
    if (best == kNone) return false;
    reached = best_progress;
    chain.push_back(best);
    if (chain.size() > edges_.size() / 3) return false;  // more than there are faces
  }
  return true;
}

// Has a given chain the structure of a chain of the edge?
bool EdgeChains::is_chain(const InputSurface::Edge& edge, std::span<const Index> chain) const {
  if (chain.size() < 2 || chain.front() != match_.of(edge.from) ||
      chain.back() != match_.of(edge.to)) {
    return false;
  }
  for (std::size_t i = 1; i < chain.size(); ++i) {
    const BoundaryEdges::Range edges = edges_.between(chain[i - 1], chain[i]);
    if (edges.empty() || edges_.left_of(edges.first) != kNone) return false;
    if (i + 1 < chain.size() && match_.is_matched(chain[i])) return false;
  }
  return true;
}

bool EdgeChains::find(const InputSurface::Edge& edge, std::vector<Index>& chain) const {
  if (options_.exact) return follow(edge, 0, chain);
  if (options_.chains != nullptr) {
    const std::span<const Index> given =
        options_.chains->of(static_cast<std::size_t>(&edge - surface_.edges().data()));
    if (is_chain(edge, given)) {
      chain.assign(given.begin(), given.end());
      return true;
    }
  }
  const double largest = options_.largest_tolerance;
  for (double tolerance = 1e-15; tolerance < largest; tolerance *= 100) {
    if (follow(edge, tolerance, chain)) return true;
  }
  return follow(edge, largest, chain);
}

}  // namespace tetproof::oracles
