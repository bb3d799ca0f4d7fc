#include "oracles/plane/faces.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>

namespace tetproof::oracles {

using delmesher::Insideness;

// Where a piece crosses the ray to the right of a point, and how far its upper end is to the right
// of there for each unit upwards. The ray is above the point by less than anything.
struct PlaneFaces::Crossing {
  mpq_class x, slope;
  Index left;  // the side that faces the point
  bool operator<(const Crossing& other) const {
    return x != other.x ? x < other.x : slope < other.slope;
  }
};

static std::vector<PlaneSlabs::Piece> ends_of_pieces(const PlaneGraph& graph) {
  std::vector<PlaneSlabs::Piece> result;
  for (const auto& [a, b, segment] : graph.pieces()) result.push_back({a, b});
  return result;
}

PlaneFaces::PlaneFaces(PlaneGraph& graph)
    : graph_(graph), slabs_(graph.points(), ends_of_pieces(graph)) {
  sort_sides();
  trace_borders();
  join_components();
  find_inside();
}

void PlaneFaces::sort_sides() {
  sides_from_.resize(graph_.given().vertices.size());
  std::map<std::pair<Index, Index>, Index> known;
  for (Index n = 0; n < graph_.pieces().size(); ++n) {
    const auto& [a, b, segment] = graph_.pieces()[n];
    const auto [at, fresh] = known.emplace(std::minmax(a, b), 2 * n);
    // An equal piece may run the other way.
    side_of_.push_back(start(at->second) == a ? at->second : at->second ^ 1U);
    if (!fresh) continue;
    sides_from_[a].push_back(2 * n);
    sides_from_[b].push_back(2 * n + 1);
  }
  for (std::vector<Index>& sides : sides_from_) {
    std::sort(sides.begin(), sides.end(), [this](Index s, Index t) {
      const auto at = [&](Index v) -> const Point& { return graph_.vertex(v); };
      return graph_.points().turns_before(at(start(s)), at(end(s)), at(end(t)));
    });
  }
}

// After a side comes, around its end, the next one clockwise from its way back: together they
// follow the border of the face on their left.
void PlaneFaces::trace_borders() {
  std::vector<Index> next(2 * graph_.pieces().size(), kNone);
  for (const std::vector<Index>& sides : sides_from_) {
    for (std::size_t k = 0; k < sides.size(); ++k) {
      next[sides[k] ^ 1U] = sides[(k + sides.size() - 1) % sides.size()];
    }
  }
  face_.assign(next.size(), kNone);
  for (Index first = 0; first < next.size(); ++first) {
    if (next[first] == kNone || face_[first] != kNone) continue;
    for (Index side = first; face_[side] == kNone; side = next[side]) face_[side] = unbounded_;
    ++unbounded_;
  }
  joined_ = UnionFind(unbounded_ + 1);  // one more than there are borders
}

// The rightmost vertex of each connected part of the graph, of these the uppermost.
std::vector<PlaneFaces::Index> PlaneFaces::outermost() const {
  std::vector<std::uint8_t> seen(sides_from_.size());
  std::vector<Index> result;
  for (Index first = 0; first < seen.size(); ++first) {
    if (seen[first] != 0 || sides_from_[first].empty()) continue;
    std::vector<Index> part = {first};
    seen[first] = 1;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const Index side : sides_from_[part[i]]) {
        if (std::exchange(seen[end(side)], std::uint8_t{1}) == 0) part.push_back(end(side));
      }
    }
    result.push_back(*std::max_element(part.begin(), part.end(), [this](Index v, Index w) {
      const Point &p = graph_.vertex(v), &q = graph_.vertex(w);
      return p.x != q.x ? p.x < q.x : p.y < q.y;
    }));
  }
  return result;
}

// The outer border of a connected part belongs to the face around it. At the outermost vertex that
// is the face between the last side, counter-clockwise, and the first one.
void PlaneFaces::join_components() {
  for (const Index v : outermost()) {
    const Index around = border_right_of(graph_.vertex(v));
    joined_.unite(face_[sides_from_[v].back()], around);
  }
  for (Index& face : face_) {
    if (face != kNone) face = joined_.find(face);
  }
  unbounded_ = joined_.find(unbounded_);
}

// Of a piece that the ray crosses.
PlaneFaces::Crossing PlaneFaces::crossing(Index piece, const Point& p) const {
  const auto& [a, b, segment] = graph_.pieces()[piece];
  const Point &first = graph_.vertex(a), &last = graph_.vertex(b);
  Crossing found;
  found.slope = (last.x - first.x) / (last.y - first.y);
  found.x = first.x + (p.y - first.y) * found.slope;
  found.left = first.below(p) ? side_of_[piece] : side_of_[piece] ^ 1U;
  return found;
}

// The border of the face that a point is in, or that begins above a vertex: that of the first piece
// on the ray to the right.
PlaneFaces::Index PlaneFaces::border_right_of(const Point& p) {
  std::optional<Crossing> nearest;
  slabs_.right_of(p, [&](std::span<const Index> pieces) {
    Crossing found = crossing(pieces.front(), p);
    if (!nearest || found < *nearest) nearest = std::move(found);
  });
  return nearest ? face_[nearest->left] : unbounded_;
}

// Enclosed is what no way from far outside, or from a hole, reaches without crossing a piece. Of
// nested faces every other one is inside, counted over the fewest pieces that separate.
void PlaneFaces::find_inside() {
  const bool nested = graph_.given().insideness == Insideness::nested;
  std::vector<std::vector<std::pair<Index, bool>>> beside(joined_.size());
  for (Index n = 0; nested && n < graph_.pieces().size(); ++n) {
    const Index left = face_[side_of_[n]], right = face_[side_of_[n] ^ 1U];
    const bool costs = graph_.separates(graph_.pieces()[n].segment);
    beside[left].emplace_back(right, costs);
    beside[right].emplace_back(left, costs);
  }
  constexpr unsigned kNotReached = 0xffffffffU;
  std::vector<unsigned> depth(joined_.size(), kNotReached);
  depth[unbounded_] = 0;
  for (const auto& hole : graph_.given().holes) {
    if (nested || graph_.on_segment(hole)) continue;
    depth[joined_.find(border_right_of({hole[0], hole[1], hole[0], hole[1]}))] = 0;
  }
  std::deque<Index> queue = {unbounded_};
  while (!queue.empty()) {
    const Index face = queue.front();
    queue.pop_front();
    for (const auto& [other, costs] : beside[face]) {
      const unsigned here = depth[face] + (costs ? 1 : 0);
      if (here >= depth[other]) continue;
      depth[other] = here;
      costs ? queue.push_back(other) : queue.push_front(other);  // shallow faces first
    }
  }
  for (const unsigned d : depth) inside_.push_back(nested ? d % 2 : d != 0 ? 1 : 0);
}

bool PlaneFaces::inside(const Point& p) {
  return inside_[joined_.find(border_right_of(p))] != 0;
}

}  // namespace tetproof::oracles
