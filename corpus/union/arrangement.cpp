#include "corpus/union/arrangement.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "corpus/union/plane_cut.h"
#include "corpus/union/unite.h"
#include "oracles/base/union_find.h"

namespace tetproof::unite {
namespace {

using Doubles = CGAL::Exact_predicates_inexact_constructions_kernel;
using oracles::UnionFind;

class Arranger {
 public:
  Arranger(const Soup& soup, Cancelled cancelled, Poll& poll)
      : soup_(soup),
        cancelled_(cancelled),
        poll_(poll),
        planes_(soup.triangles.size()),
        chords_(soup.triangles.size()),
        result_{Points(soup.vertices), {}} {}

  // First all pairs, so that new points are compared with all of their corners.
  void enter(const MeetingPair& pair) {
    for (const Index t : {pair.a, pair.b}) {
      for (const Index v : soup_.triangles[t]) result_.points.enter(v);
    }
  }
  void add(const MeetingPair& pair);
  Arrangement run();

 private:
  int side(Index plane, Index vertex) const;
  Index crossing(Index a, Index b, Index plane);
  std::pair<Index, Index> ends(Index triangle, Index plane);
  Chord chord(Index a, Index b);
  bool is_before(Index a, Index b) const { return a != b && result_.points[a] < result_.points[b]; }
  void cut(const std::vector<Index>& members);

  const Soup& soup_;
  const Cancelled cancelled_;
  Poll& poll_;
  UnionFind planes_;  // sets of triangles that meet in one plane
  std::vector<std::vector<Chord>> chords_;
  std::map<std::array<Index, 3>, Index> crossings_;  // of edges with planes of triangles
  Arrangement result_;
};

// Side of the vertex of a triangle's plane: 1 where its normal points, 0 on it, -1 behind it.
int Arranger::side(Index plane, Index vertex) const {
  const auto point = [&](Index v) {
    const Position& p = soup_.vertices[v];
    return Doubles::Point_3(p[0], p[1], p[2]);
  };
  const auto& [a, b, c] = soup_.triangles[plane];
  return CGAL::orientation(point(a), point(b), point(c), point(vertex));
}

Index Arranger::crossing(Index a, Index b, Index plane) {
  const Index low = std::min(a, b), high = std::max(a, b);
  const auto [at, fresh] = crossings_.try_emplace({low, high, plane});
  if (fresh) {
    Points& points = result_.points;
    const auto& [p, q, r] = soup_.triangles[plane];
    at->second = points.number_of(Exact().construct_plane_line_intersection_point_3_object()(
        points[p], points[q], points[r], points[low], points[high]));
  }
  return at->second;
}

// Where a triangle meets the plane of another one, which it does in a segment or a corner. In
// lexicographic order.
std::pair<Index, Index> Arranger::ends(Index triangle, Index plane) {
  const Triangle& t = soup_.triangles[triangle];
  const std::array<int, 3> sides = {side(plane, t[0]), side(plane, t[1]), side(plane, t[2])};
  std::vector<Index> found;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (sides[k] == 0) found.push_back(t[k]);
    if (sides[k] * sides[next] < 0) found.push_back(crossing(t[k], t[next], plane));
  }
  if (found.empty() || found.size() > 2) throw InternalError("a triangle misses a plane");
  if (is_before(found.back(), found.front())) return {found.back(), found.front()};
  return {found.front(), found.back()};
}

// Both triangles meet the line of their two planes in an interval. Points of a line are in order if
// their coordinates are.
Chord Arranger::chord(Index a, Index b) {
  const auto [from_a, to_a] = ends(a, b);
  const auto [from_b, to_b] = ends(b, a);
  const Chord chord = {is_before(from_a, from_b) ? from_b : from_a,
                       is_before(to_b, to_a) ? to_b : to_a};
  if (is_before(chord.to, chord.from)) throw InternalError("triangles that meet do not");
  return chord;
}

void Arranger::add(const MeetingPair& pair) {
  poll_();
  if (pair.coplanar) {
    planes_.unite(pair.a, pair.b);
    return;
  }
  const Chord common = chord(pair.a, pair.b);
  chords_[pair.a].push_back(common);
  chords_[pair.b].push_back(common);
}

void Arranger::cut(const std::vector<Index>& members) {
  PlaneCut plane(soup_, members, cancelled_, result_.points);
  for (const Index member : members) {
    poll_();
    plane.add(chords_[member]);
  }
  const std::size_t before = result_.pieces.size();
  plane.append_to(result_.pieces, poll_);
  const bool same = members.size() == 1 && result_.pieces.size() == before + 1;
  if (!same) result_.cut += members.size();
}

Arrangement Arranger::run() {
  std::map<Index, std::vector<Index>> sets;  // of several triangles
  for (Index t = 0; t < planes_.size(); ++t) {
    const Index first = planes_.find(t);
    if (first == t) continue;
    std::vector<Index>& members = sets[first];
    if (members.empty()) members.push_back(first);
    members.push_back(t);
  }
  for (Index t = 0; t < planes_.size(); ++t) {
    poll_();
    if (planes_.find(t) != t) continue;
    if (const auto set = sets.find(t); set != sets.end()) {
      cut(set->second);
    } else if (!chords_[t].empty()) {
      cut({t});
    } else {
      result_.pieces.push_back({soup_.triangles[t], 1, t, false});
      if (cancelled_ == Cancelled::kept) result_.pieces.back().parents = {t};
    }
  }
  return std::move(result_);
}

}  // namespace

std::vector<Triangle> triangles_of(std::span<const Piece> pieces) {
  std::vector<Triangle> list;
  list.reserve(pieces.size());
  for (const Piece& piece : pieces) list.push_back(piece.corners);
  return list;
}

delmesher::Surface rounded(const Points& points, std::span<const Piece> pieces,
                           const std::function<std::int32_t(const Piece&)>& label, double& moved,
                           Poll& poll) {
  delmesher::Surface surface;
  for (Index i = 0; i < points.size(); ++i) surface.vertices.push_back(points.approximate(i));
  std::vector<bool> done(points.size(), false);
  double largest = 0;
  for (const Piece& piece : pieces) {
    poll();
    for (const Index v : piece.corners) {
      if (done[v] || points.is_given(v)) continue;
      done[v] = true;
      const Position at = points.rounded(v);
      surface.vertices[v] = at;
      const auto off = points[v] - Exact::Point_3(at[0], at[1], at[2]);
      largest = std::max(largest, std::sqrt(CGAL::to_double(off.squared_length())));
    }
    surface.triangles.push_back(piece.corners);
    surface.labels.push_back(label(piece));
  }
  moved += largest;
  return surface;
}

Arrangement arrange(const Soup& soup, const std::vector<MeetingPair>& pairs, Cancelled cancelled,
                    Poll& poll) {
  Arranger arranger(soup, cancelled, poll);
  for (const MeetingPair& pair : pairs) arranger.enter(pair);
  for (const MeetingPair& pair : pairs) arranger.add(pair);
  return arranger.run();
}

}  // namespace tetproof::unite
