#include "corpus/union/joining.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "oracles/base/union_find.h"
#include "oracles/base/vectors.h"

namespace tetproof::unite {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using oracles::dot;
using oracles::minus;
using Edge = std::pair<Index, Index>;  // the lower vertex first

double distance(const Position& p, const Position& q) {
  const Position d = minus(p, q);
  return std::sqrt(dot(d, d));
}

class Joiner {
 public:
  Joiner(Soup& soup, double reach, Poll& poll) : soup_(soup), reach_(reach), poll_(poll) {}
  double run(const std::vector<MeetingPair>& pairs);
  double run_on_needles(const std::vector<MeetingPair>& themselves);

 private:
  enum class Which { exactly_on, near };
  struct Bend {
    double at;  // the share of the edge before it
    Index vertex;
    auto operator<=>(const Bend&) const = default;
  };
  const Position& at(Index v) const { return soup_.vertices[v]; }
  void join_vertices(const std::vector<MeetingPair>& pairs);
  bool is_on(Index v, const Edge& edge) const;
  void find_bend(Index v, const Edge& edge, Which which);
  std::vector<Index> bends(Index from, Index to) const;
  void divide(const Triangle& corners, std::array<std::vector<Index>, 3> bends, std::int32_t label);
  void bend(const std::vector<MeetingPair>& pairs, Which which);

  Soup& soup_;
  const double reach_;
  Poll& poll_;
  std::map<Edge, std::vector<Bend>> bends_;
  double farthest_ = 0;
};

void Joiner::join_vertices(const std::vector<MeetingPair>& pairs) {
  oracles::UnionFind same(soup_.vertices.size());
  for (const MeetingPair& pair : pairs) {
    poll_();
    for (const Index v : soup_.triangles[pair.a]) {
      for (const Index w : soup_.triangles[pair.b]) {
        if (distance(at(v), at(w)) <= reach_) same.unite(v, w);
      }
    }
  }
  for (Triangle& t : soup_.triangles) {
    for (Index& v : t) {
      farthest_ = std::max(farthest_, distance(at(v), at(same.find(v))));
      v = same.find(v);
    }
  }
}

bool Joiner::is_on(Index v, const Edge& edge) const {
  const auto point = [&](Index i) { return Kernel::Point_3(at(i)[0], at(i)[1], at(i)[2]); };
  return CGAL::collinear(point(edge.first), point(v), point(edge.second));
}

void Joiner::find_bend(Index v, const Edge& edge, Which which) {
  const auto& [low, high] = edge;
  if (v == low || v == high || low == high) return;
  const Position along = minus(at(high), at(low)), to = minus(at(v), at(low));
  const double share = dot(along, to) / dot(along, along);
  if (!(share > 0 && share < 1)) return;
  Position nearest = at(low);
  for (std::size_t k = 0; k < 3; ++k) nearest[k] += share * along[k];
  const double off = distance(nearest, at(v));
  if (off > reach_ || (which == Which::exactly_on && !is_on(v, edge))) return;
  if (which == Which::near) farthest_ = std::max(farthest_, off);
  bends_[edge].push_back({share, v});
}

std::vector<Index> Joiner::bends(Index from, Index to) const {
  const auto found = bends_.find(std::minmax(from, to));
  std::vector<Index> vertices;
  if (found == bends_.end()) return vertices;
  for (const Bend& bend : found->second) vertices.push_back(bend.vertex);
  if (from > to) std::reverse(vertices.begin(), vertices.end());
  return vertices;
}

// Halves the triangle at a bend of its first edge that has one. Edge k starts at corner k.
void Joiner::divide(const Triangle& corners, std::array<std::vector<Index>, 3> bends,
                    std::int32_t label) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (bends[k].empty()) continue;
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const auto middle = bends[k].begin() + static_cast<std::ptrdiff_t>(bends[k].size() / 2);
    divide({corners[k], *middle, corners[last]}, {{{bends[k].begin(), middle}, {}, bends[last]}},
           label);
    divide({*middle, corners[next], corners[last]},
           {{{middle + 1, bends[k].end()}, bends[next], {}}}, label);
    return;
  }
  soup_.triangles.push_back(corners);
  soup_.labels.push_back(label);
}

void Joiner::bend(const std::vector<MeetingPair>& pairs, Which which) {
  bends_.clear();
  for (const MeetingPair& pair : pairs) {
    poll_();
    for (const auto& [one, other] : {Edge{pair.a, pair.b}, Edge{pair.b, pair.a}}) {
      const Triangle& t = soup_.triangles[other];
      for (const Index v : soup_.triangles[one]) {
        for (std::size_t k = 0; k < 3; ++k) find_bend(v, std::minmax(t[k], t[(k + 1) % 3]), which);
      }
    }
  }
  for (auto& [edge, list] : bends_) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  const std::vector<Triangle> triangles = std::exchange(soup_.triangles, {});
  const std::vector<std::int32_t> labels = std::exchange(soup_.labels, {});
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    poll_();
    const auto& [a, b, c] = triangles[i];
    divide(triangles[i], {bends(a, b), bends(b, c), bends(c, a)}, labels[i]);
  }
}

// A corner that is exactly on an edge comes first: triangles there have the edge in parts, and
// would leave it if only these bent. What only touches exactly is left to the arrangement.
double Joiner::run(const std::vector<MeetingPair>& pairs) {
  const Soup given = soup_;
  bend(pairs, Which::exactly_on);
  const std::vector<MeetingPair> left = meeting_pairs(soup_, poll_);
  join_vertices(left);
  bend(left, Which::near);
  soup_ = farthest_ > 0 ? soup_of(surface_of(soup_)) : given;
  return farthest_;
}

double Joiner::run_on_needles(const std::vector<MeetingPair>& themselves) {
  join_vertices(themselves);
  bend(themselves, Which::near);
  soup_ = soup_of(surface_of(soup_));
  return farthest_;
}

}  // namespace

double join_near(Soup& soup, const std::vector<MeetingPair>& pairs, double reach, Poll& poll) {
  return Joiner(soup, reach, poll).run(pairs);
}

bool is_needle(const Soup& soup, const Triangle& corners, double height) {
  std::array<Position, 3> sides;
  double unit = 0;  // or squares of tiny ones would vanish
  for (std::size_t k = 0; k < 3; ++k) {
    sides[k] = minus(soup.vertices[corners[(k + 1) % 3]], soup.vertices[corners[k]]);
    unit = std::max(unit, oracles::largest_component(sides[k]));
  }
  double longest = 0;
  for (Position& side : sides) {
    for (double& x : side) x /= unit;
    longest = std::max(longest, oracles::length(side));
  }
  return unit * oracles::length(oracles::cross(sides[0], sides[1])) <= height * longest;
}

double remove_needles(Soup& soup, const std::vector<Index>& needles, double reach, Poll& poll) {
  std::vector<MeetingPair> themselves;
  for (const Index t : needles) themselves.push_back({t, t, true});
  return Joiner(soup, reach, poll).run_on_needles(themselves);
}

}  // namespace tetproof::unite
