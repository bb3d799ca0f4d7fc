#include "oracles/plane/graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace tetproof {

using delmesher::Insideness;
using Index = PlanePoints::Index;

PlaneBoxes::Box plane_box(const std::vector<const PlanePoints::Point*>& points, double margin) {
  PlaneBoxes::Box result{{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
  for (const PlanePoints::Point* p : points) {
    result.low = {std::min(result.low[0], p->dx), std::min(result.low[1], p->dy)};
    result.high = {std::max(result.high[0], p->dx), std::max(result.high[1], p->dy)};
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const double rounding = 1e-14 * std::max(std::fabs(result.low[k]), std::fabs(result.high[k]));
    result.low[k] -= margin + rounding + 1e-320;
    result.high[k] += margin + rounding + 1e-320;
  }
  return result;
}

PlaneGraph::PlaneGraph(const delmesher::PlanarGraph& graph) : graph_(graph) {
  std::array<double, 2> low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
  for (const auto& p : graph.vertices) {
    points_.add({p[0], p[1], p[0], p[1]});
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
      largest_ = std::max(largest_, std::fabs(p[k]));
    }
  }
  if (!graph.vertices.empty()) diagonal_ = std::hypot(high[0] - low[0], high[1] - low[1]);
  std::vector<PlaneBoxes::Box> boxes;
  for (const auto& [a, b] : graph.segments) boxes.push_back(plane_box({&vertex(a), &vertex(b)}, 0));
  segments_ = PlaneBoxes(boxes);
  boxes.clear();
  for (Index v = 0; v < graph.vertices.size(); ++v) boxes.push_back(plane_box({&vertex(v)}, 0));
  vertices_ = PlaneBoxes(boxes);
  cut_into_pieces();
  find_rings();
}

void PlaneGraph::cut_into_pieces() {
  pieces_at_.resize(graph_.vertices.size());
  pieces_of_.resize(graph_.segments.size());
  std::set<std::pair<Index, Index>> seen;
  for (Index s = 0; s < graph_.segments.size(); ++s) {
    const Index a = graph_.segments[s][0], b = graph_.segments[s][1];
    if (!seen.insert(std::minmax(a, b)).second) continue;
    std::vector<std::pair<mpq_class, Index>> on = {{0, a}, {1, b}};
    const auto& [p, q] = std::pair(graph_.vertices[a], graph_.vertices[b]);
    const double margin = 1e-9 * (largest_ + 1e-290);
    vertices_.visit_near_line(plane_box({&vertex(a), &vertex(b)}, 0), p, q, margin, [&](Index v) {
      if (v == a || v == b || points_.orient(a, b, v) != 0) return;
      mpq_class t = points_.parameter(v, a, b);
      if (t > 0 && t < 1) on.emplace_back(std::move(t), v);
    });
    std::sort(on.begin(), on.end());
    for (std::size_t k = 0; k + 1 < on.size(); ++k) {
      const auto id = static_cast<Index>(pieces_.size());
      pieces_.push_back({on[k].second, on[k + 1].second, s});
      pieces_of_[s].push_back(id);
      pieces_at_[on[k].second].push_back(id);
      pieces_at_[on[k + 1].second].push_back(id);
    }
  }
}

double PlaneGraph::ulp() const {
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  return largest_ > 0 ? std::max(std::ldexp(1.0, std::ilogb(largest_) - 52), kLeast) : kLeast;
}

bool PlaneGraph::separates(Index segment) const {
  return graph_.partitions.empty() || graph_.partitions[segment] == 0;
}

// The vertices of the single closed curve that the segments form; empty if they do not form one.
std::vector<Index> PlaneGraph::round_the_ring() const {
  std::map<Index, std::vector<Index>> next;
  for (const auto& [a, b] : graph_.segments) {
    next[a].push_back(b);
    next[b].push_back(a);
  }
  for (const auto& [v, ends] : next) {
    if (ends.size() != 2 || ends[0] == ends[1]) return {};
  }
  if (next.empty()) return {};
  std::vector<Index> ring = {graph_.segments[0][0]};
  Index at = graph_.segments[0][1];
  while (at != ring[0]) {
    const Index before = ring.back();
    ring.push_back(at);
    at = next[at][0] == before ? next[at][1] : next[at][0];
  }
  if (ring.size() != next.size()) return {};
  return ring;
}

void PlaneGraph::find_rings() {
  const std::vector<Index> ring = round_the_ring();
  // If a vertex lies within a segment, the curve may touch itself.
  if (!ring.empty() && pieces_.size() == graph_.segments.size() && graph_.partitions.empty()) {
    ring_area_ = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Point &p = vertex(ring[i]), &q = vertex(ring[(i + 1) % ring.size()]);
      ring_area_ += p.x * q.y - p.y * q.x;
    }
    ring_area_ = abs(ring_area_);
  }
  // A single ring encloses what parity says.
  if (graph_.insideness == Insideness::enclosed) {
    rings_ = ring_area_ >= 0 && graph_.holes.empty();
    if (!rings_) ring_area_ = -1;
    return;
  }
  std::set<std::pair<Index, Index>> seen;
  std::map<Index, int> degree;
  for (Index s = 0; s < graph_.segments.size(); ++s) {
    const auto& [a, b] = graph_.segments[s];
    if (!seen.insert(std::minmax(a, b)).second) return;
    if (!separates(s)) continue;
    ++degree[a];
    ++degree[b];
  }
  rings_ = std::all_of(degree.begin(), degree.end(), [](auto& d) { return d.second % 2 == 0; });
}

bool PlaneGraph::inside_by_ray(const Point& c) {
  if (!separating_) {
    std::vector<PlaneSlabs::Piece> pieces;
    for (const auto& [a, b, segment] : pieces_) {
      if (separates(segment)) pieces.push_back({a, b});
    }
    separating_.emplace(points_, std::move(pieces));
  }
  std::size_t crossed = 0;
  separating_->right_of(c, [&](std::span<const Index> pieces) { crossed += pieces.size(); });
  return crossed % 2 != 0;
}

bool PlaneGraph::on_segment(const std::array<double, 2>& at) {
  const Point p{at[0], at[1], at[0], at[1]};
  bool found = false;
  near_segments({at, at}, [&](Index s) {
    const Point &a = vertex(graph_.segments[s][0]), &b = vertex(graph_.segments[s][1]);
    found = found ||
            (points_.orient(a, b, p) == 0 && std::min(a.x, b.x) <= p.x &&
             p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y));
  });
  return found;
}

double PlaneGraph::feature_size(Index v, double most) {
  double least = HUGE_VAL;
  const PlaneBoxes::Box box = plane_box({&vertex(v)}, most);
  near_vertices(box, [&](Index u) {
    if (u != v) least = std::min(least, points_.distance(v, u));
  });
  near_segments(box, [&](Index s) {
    const auto [a, b] = graph_.segments[s];
    if (a == v || b == v) return;
    if (points_.orient(a, b, v) == 0) return;  // on it, or met by its ends
    least = std::min(least, points_.distance_to_segment(v, a, b));
  });
  return least;
}

}  // namespace tetproof
