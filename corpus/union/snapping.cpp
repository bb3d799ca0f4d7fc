#include "corpus/union/snapping.h"

#include <CGAL/Box_intersection_d/Box_with_handle_d.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "corpus/union/flat_faces.h"
#include "oracles/base/triangle_distance.h"
#include "oracles/base/union_find.h"
#include "oracles/base/vectors.h"

namespace tetproof::unite {
namespace {

using oracles::between;
using oracles::cross;
using oracles::dot;
using oracles::minus;
using oracles::quick_distance;
using oracles::UnionFind;
using Edge = std::pair<Index, Index>;  // the lower vertex first, but in boundaries

// A vertex, an edge or a triangle: its corners, the last one repeated.
struct Feature {
  Triangle corners;
  Index number;
};
using Bounds = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Feature*>;

Edge edge(Index a, Index b) {
  return std::minmax(a, b);
}

std::vector<Feature> features_of(std::span<const Edge> edges) {
  std::vector<Feature> features;
  for (const auto& [a, b] : edges) {
    features.push_back({{a, b, b}, static_cast<Index>(features.size())});
  }
  return features;
}

std::vector<Feature> features_of(std::span<const Triangle> triangles) {
  std::vector<Feature> features;
  for (const Triangle& t : triangles) features.push_back({t, static_cast<Index>(features.size())});
  return features;
}

// Of points on the segments from a to b and from c to d, the shares of those nearest to each other.
std::array<double, 2> nearest_shares(const Position& a, const Position& b, const Position& c,
                                     const Position& d) {
  const Position u = minus(b, a), v = minus(d, c), w = minus(a, c);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  return {(uv * vw - vv * uw) / determinant, (uu * vw - uv * uw) / determinant};
}

class Snapper {
 public:
  Snapper(const Soup& soup, double reach, Poll& poll)
      : soup_(soup), triangles_(soup.triangles), reach_(reach), poll_(poll) {
    result_.vertices = soup.vertices;
  }
  Snapped run();

 private:
  // Vertices do not get nearer to each other by bending, so that this many rounds are many.
  static constexpr int kRounds = 64;
  struct Bend {
    double off_middle;
    Index vertex;
    auto operator<=>(const Bend&) const = default;
  };

  const Position& at(Index v) const { return result_.vertices[v]; }
  std::vector<Bounds> bounds(const std::vector<Feature>& features) const;
  // Calls visit(feature, feature) where the boxes around both are at most 2 `reach_` apart.
  template <class Visit>
  void for_each_pair(const std::vector<Feature>& features, const Visit& visit) const;
  template <class Visit>
  void for_each_pair(const std::vector<Feature>& some, const std::vector<Feature>& others,
                     const Visit& visit) const;
  std::vector<Feature> corners(std::span<const Edge> edges) const;
  void join_vertices();
  std::vector<Edge> parts() const;
  void add_parts(const Edge& whole, std::set<Edge>& parts) const;
  void add_chain(Index from, Index to, std::vector<Index>& chain) const;
  bool note(const Edge& edge, Index vertex);
  void note_if_near(const Edge& edge, Index vertex);
  void cross_if_near(const Edge& one, const Edge& other);
  Index nearest(const Position& p, double farthest, const Edge& edge) const;
  Index vertex_at(const Position& p);
  void note_crossing(const Edge& edge, Index vertex, const Position& p);
  void enter_found() {
    for (const auto& [e, bend] : found_) bends_.emplace(e, bend.vertex);
  }
  bool bend();
  bool bend_all();
  std::vector<Edge> boundary_of(const Triangle& t) const;
  bool lies_in(const Position& p, const Triangle& t, double height) const;
  void find_faces();
  void find_features();
  void find_within(Index triangle, const Edge& edge);
  bool cut_faces();
  bool cut_together(const std::vector<Index>& members);
  void measure_moves();
  bool fail(Index vertex) {
    result_.done = false;
    result_.place = vertex;
    return true;
  }

  const Soup& soup_;
  std::vector<Triangle> triangles_;
  const double reach_;
  Poll& poll_;
  std::map<Edge, Index> bends_;  // the vertex between the two parts of an edge
  std::map<Edge, Bend> found_;   // in this round
  using Cell = std::array<double, 3>;
  Cell cell_of(const Position& p) const;
  std::map<Cell, std::vector<Index>> cells_;  // of a grid, and the vertices there
  // What is to be cut along, per triangle: beside its boundary, vertices and parts of edges within.
  std::vector<std::vector<Index>> vertices_within_;
  std::vector<std::vector<Edge>> boundaries_, edges_within_;
  UnionFind faces_{0};  // sets of triangles that lie on each other
  Snapped result_;
};

std::vector<Bounds> Snapper::bounds(const std::vector<Feature>& features) const {
  std::vector<Bounds> boxes;
  boxes.reserve(features.size());
  for (const Feature& feature : features) {
    CGAL::Bbox_3 box;
    for (const Index v : feature.corners) {
      const Position& p = at(v);
      box += CGAL::Bbox_3(p[0] - reach_, p[1] - reach_, p[2] - reach_, p[0] + reach_, p[1] + reach_,
                          p[2] + reach_);
    }
    boxes.emplace_back(box, &feature);
  }
  return boxes;
}

template <class Visit>
void Snapper::for_each_pair(const std::vector<Feature>& features, const Visit& visit) const {
  std::vector<Bounds> boxes = bounds(features);
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Bounds& x, const Bounds& y) {
    poll_();
    visit(*x.handle(), *y.handle());
  });
}

template <class Visit>
void Snapper::for_each_pair(const std::vector<Feature>& some, const std::vector<Feature>& others,
                            const Visit& visit) const {
  std::vector<Bounds> x = bounds(some), y = bounds(others);
  CGAL::box_intersection_d(x.begin(), x.end(), y.begin(), y.end(),
                           [&](const Bounds& one, const Bounds& other) {
                             poll_();
                             visit(*one.handle(), *other.handle());
                           });
}

void Snapper::join_vertices() {
  std::vector<Feature> vertices;
  for (Index v = 0; v < result_.vertices.size(); ++v) vertices.push_back({{v, v, v}, v});
  UnionFind same(vertices.size());
  for_each_pair(vertices, [&](const Feature& v, const Feature& w) {
    if (quick_distance(at(v.number), at(w.number)) <= 2 * reach_) same.unite(v.number, w.number);
  });
  for (Triangle& t : triangles_) {
    for (Index& v : t) {
      result_.moved = std::max(result_.moved, quick_distance(at(v), at(same.find(v))));
      v = same.find(v);
    }
  }
  for (Index v = 0; v < vertices.size(); ++v) {
    if (same.find(v) == v) cells_[cell_of(at(v))].push_back(v);
  }
}

void Snapper::add_parts(const Edge& whole, std::set<Edge>& parts) const {
  if (whole.first == whole.second) return;
  const auto bend = bends_.find(whole);
  if (bend == bends_.end()) {
    parts.insert(whole);
    return;
  }
  add_parts(edge(whole.first, bend->second), parts);
  add_parts(edge(bend->second, whole.second), parts);
}

std::vector<Edge> Snapper::parts() const {
  std::set<Edge> parts;
  for (const auto& [a, b, c] : triangles_) {
    add_parts(edge(a, b), parts);
    add_parts(edge(b, c), parts);
    add_parts(edge(c, a), parts);
  }
  return {parts.begin(), parts.end()};
}

// Without `to`.
void Snapper::add_chain(Index from, Index to, std::vector<Index>& chain) const {
  if (from == to) return;
  const auto bend = bends_.find(edge(from, to));
  if (bend == bends_.end()) {
    chain.push_back(from);
    return;
  }
  add_chain(from, bend->second, chain);
  add_chain(bend->second, to, chain);
}

// Of several vertices near an edge the one that halves it best comes first. Parts are shorter than
// the whole, so that bending ends.
bool Snapper::note(const Edge& edge, Index vertex) {
  const double to_first = quick_distance(at(edge.first), at(vertex)),
               to_second = quick_distance(at(edge.second), at(vertex)),
               whole = quick_distance(at(edge.first), at(edge.second));
  if (!(std::min(to_first, to_second) > 0 && std::max(to_first, to_second) < whole)) return false;
  const Bend bend = {std::fabs(to_first - to_second), vertex};
  const auto [entry, fresh] = found_.try_emplace(edge, bend);
  if (!fresh) entry->second = std::min(entry->second, bend);
  return true;
}

void Snapper::note_if_near(const Edge& edge, Index vertex) {
  const auto& [low, high] = edge;
  if (vertex == low || vertex == high) return;
  const Position along = minus(at(high), at(low));
  const double share = dot(along, minus(at(vertex), at(low))) / dot(along, along);
  if (!(share > 0 && share < 1)) return;
  const double off = quick_distance(between(at(low), at(high), share), at(vertex));
  if (off > reach_) return;
  note(edge, vertex);
}

Snapper::Cell Snapper::cell_of(const Position& p) const {
  Cell cell;
  for (std::size_t k = 0; k < 3; ++k) cell[k] = std::floor(p[k] / (2 * reach_));
  return cell;
}

// The vertex nearest to a place, and no farther than that; not an end of the edge.
Index Snapper::nearest(const Position& p, double farthest, const Edge& edge) const {
  const Cell cell = cell_of(p);
  const int cells = static_cast<int>(std::ceil(farthest / (2 * reach_)));
  std::pair<double, Index> best = {farthest, kNone};
  for (int i = -cells; i <= cells; ++i) {
    for (int j = -cells; j <= cells; ++j) {
      for (int k = -cells; k <= cells; ++k) {
        const auto found = cells_.find({cell[0] + i, cell[1] + j, cell[2] + k});
        if (found == cells_.end()) continue;
        for (const Index v : found->second) {
          if (v == edge.first || v == edge.second) continue;
          best = std::min(best, {quick_distance(at(v), p), v});
        }
      }
    }
  }
  return best.second;
}

// A vertex near a place on an edge, or a new one there.
Index Snapper::vertex_at(const Position& p) {
  const Index near = nearest(p, 2 * reach_, {kNone, kNone});
  if (near != kNone) return near;
  const auto v = static_cast<Index>(result_.vertices.size());
  result_.vertices.push_back(p);
  cells_[cell_of(p)].push_back(v);
  return v;
}

// An edge that is crossed near its own end goes through the end of the other one, if that is there.
void Snapper::note_crossing(const Edge& edge, Index vertex, const Position& p) {
  const bool is_end = vertex == edge.first || vertex == edge.second;
  const Index v = is_end ? nearest(p, 8 * reach_, edge) : vertex;
  if (v != kNone) note(edge, v);
}

void Snapper::cross_if_near(const Edge& one, const Edge& other) {
  const auto& [a, b] = one;
  const auto& [c, d] = other;
  if (a == c || a == d || b == c || b == d) return;
  if (found_.contains(one) || found_.contains(other)) return;
  const auto [s, t] = nearest_shares(at(a), at(b), at(c), at(d));
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return;
  const Position p = between(at(a), at(b), s), q = between(at(c), at(d), t);
  const double off = quick_distance(p, q);
  if (off > reach_) return;
  const Position middle = between(p, q, 0.5);
  const Index v = vertex_at(middle);
  note_crossing(one, v, middle);
  note_crossing(other, v, middle);
}

// Their corners, as features.
std::vector<Feature> Snapper::corners(std::span<const Edge> edges) const {
  std::vector<bool> used(result_.vertices.size(), false);
  for (const auto& [a, b] : edges) used[a] = used[b] = true;
  std::vector<Feature> corners;
  for (Index v = 0; v < used.size(); ++v) {
    if (used[v]) corners.push_back({{v, v, v}, v});
  }
  return corners;
}

// Each edge at one vertex; false if there is none.
bool Snapper::bend() {
  const std::vector<Edge> edges = parts();
  const std::vector<Feature> features = features_of(edges);
  found_.clear();
  for_each_pair(corners(edges), features, [&](const Feature& v, const Feature& e) {
    note_if_near(edges[e.number], v.number);
  });
  std::vector<std::pair<Index, Index>> crossings;
  for_each_pair(features, [&](const Feature& x, const Feature& y) {
    crossings.emplace_back(std::minmax(x.number, y.number));
  });
  std::sort(crossings.begin(), crossings.end());
  for (const auto& [one, other] : crossings) cross_if_near(edges[one], edges[other]);
  enter_found();
  return !found_.empty();
}

bool Snapper::bend_all() {
  for (int round = 0; round < kRounds; ++round) {
    if (!bend()) return true;
  }
  return false;
}

// Do two triangles lie on each other, with heights at most `height` apart? What they share has to
// be wider than `width`.
class OnEachOther {
 public:
  OnEachOther(std::span<const Position> vertices, double width, double height)
      : vertices_(vertices), width_(width), height_(height) {}
  bool operator()(const Triangle& s, const Triangle& t) const;

 private:
  using Point = std::array<double, 2>;
  using Polygon = std::vector<Point>;

  Position normal(const Triangle& t) const {
    return cross(minus(vertices_[t[1]], vertices_[t[0]]), minus(vertices_[t[2]], vertices_[t[0]]));
  }
  static double turn(const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  }
  static Polygon cut(const Polygon& polygon, const Point& a, const Point& b);
  bool is_wide(const Polygon& polygon) const;

  std::span<const Position> vertices_;
  double width_, height_;
};

// What is to the left of the line from a to b.
OnEachOther::Polygon OnEachOther::cut(const Polygon& polygon, const Point& a, const Point& b) {
  Polygon left;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double at_p = turn(a, b, p), at_q = turn(a, b, q);
    if (at_p >= 0) left.push_back(p);
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0)) {
      const double share = at_p / (at_p - at_q);
      left.push_back({p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])});
    }
  }
  return left;
}

bool OnEachOther::is_wide(const Polygon& polygon) const {
  double twice = 0, longest = 0;
  for (std::size_t k = 0; k + 1 < polygon.size(); ++k) {
    twice += turn(polygon[0], polygon[k], polygon[k + 1]);
    longest = std::max(
        longest, std::hypot(polygon[k + 1][0] - polygon[0][0], polygon[k + 1][1] - polygon[0][1]));
  }
  return twice > width_ * longest;
}

bool OnEachOther::operator()(const Triangle& s, const Triangle& t) const {
  const Position n = normal(s), m = normal(t);
  const double along = dot(n, m), sizes = oracles::length(n) * oracles::length(m);
  if (!(std::fabs(along) > 0.9 * sizes)) return false;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) axis = std::fabs(n[k]) > std::fabs(n[axis]) ? k : axis;
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto seen = [&](const Triangle& triangle, const Position& normal) {
    Polygon polygon;
    for (const Index i : triangle) polygon.push_back({vertices_[i][u], vertices_[i][v]});
    if (normal[axis] < 0) std::swap(polygon[1], polygon[2]);
    return polygon;
  };
  Polygon common = seen(s, n);
  const Polygon other = seen(t, m);
  for (std::size_t k = 0; k < 3; ++k) common = cut(common, other[k], other[(k + 1) % 3]);
  if (common.size() < 3 || !is_wide(common)) return false;
  const auto height = [&](const Triangle& triangle, const Position& normal, const Point& p) {
    const Position& o = vertices_[triangle[0]];
    return o[axis] - (normal[u] * (p[0] - o[u]) + normal[v] * (p[1] - o[v])) / normal[axis];
  };
  return std::all_of(common.begin(), common.end(), [&](const Point& p) {
    return std::fabs(height(s, n, p) - height(t, m, p)) <= height_;
  });
}

// Sides that go there and back enclose nothing.
std::vector<Edge> Snapper::boundary_of(const Triangle& t) const {
  std::vector<Index> chain;
  for (std::size_t k = 0; k < 3; ++k) add_chain(t[k], t[(k + 1) % 3], chain);
  std::vector<Edge> boundary;
  for (std::size_t k = 0; k < chain.size(); ++k) {
    const Edge side = {chain[k], chain[(k + 1) % chain.size()]};
    const auto back = std::ranges::find(boundary, Edge{side.second, side.first});
    if (back == boundary.end()) {
      boundary.push_back(side);
    } else {
      boundary.erase(back);
    }
  }
  return boundary;
}

// As seen along the normal; no farther than `height` from the plane.
bool Snapper::lies_in(const Position& p, const Triangle& t, double height) const {
  const Position u = minus(at(t[1]), at(t[0])), v = minus(at(t[2]), at(t[0]));
  const Position n = cross(u, v);
  if (std::fabs(dot(n, minus(p, at(t[0])))) > height * oracles::length(n)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Position &a = at(t[k]), &b = at(t[(k + 1) % 3]);
    if (!(dot(n, cross(minus(b, a), minus(p, a))) > 0)) return false;
  }
  return true;
}

void Snapper::find_faces() {
  boundaries_.clear();
  for (const Triangle& t : triangles_) boundaries_.push_back(boundary_of(t));
  faces_ = UnionFind(triangles_.size());
  const OnEachOther on_each_other(result_.vertices, 2 * reach_, 4 * reach_);
  for_each_pair(features_of(triangles_), [&](const Feature& x, const Feature& y) {
    if (on_each_other(x.corners, y.corners)) faces_.unite(x.number, y.number);
  });
}

// Vertices and edges that touch triangles from one side.
void Snapper::find_features() {
  vertices_within_.assign(triangles_.size(), {});
  edges_within_.assign(triangles_.size(), {});
  const std::vector<Edge> edges = parts();
  for_each_pair(
      features_of(edges), features_of(triangles_),
      [&](const Feature& e, const Feature& t) { find_within(t.number, edges[e.number]); });
}

void Snapper::find_within(Index triangle, const Edge& edge) {
  const std::vector<Edge>& boundary = boundaries_[triangle];
  const auto is_side = [&](const Edge& side) {
    return unite::edge(side.first, side.second) == edge;
  };
  if (boundary.empty() || std::ranges::any_of(boundary, is_side)) return;
  const Triangle& t = triangles_[triangle];
  int ends = 0;
  for (const Index v : {edge.first, edge.second}) {
    if (std::ranges::find(boundary, v, &Edge::first) != boundary.end()) {
      ++ends;
    } else if (lies_in(at(v), t, reach_)) {
      ++ends;
      vertices_within_[triangle].push_back(v);
    }
  }
  if (ends == 2 && lies_in(between(at(edge.first), at(edge.second), 0.5), t, reach_)) {
    edges_within_[triangle].push_back(edge);
  }
}

// False if some edges have to be bent first.
bool Snapper::cut_together(const std::vector<Index>& members) {
  double largest = -1;
  int axis = 0;
  for (const Index t : members) {
    const auto& [a, b, c] = triangles_[t];
    const Position n = cross(minus(at(b), at(a)), minus(at(c), at(a)));
    for (int k = 0; k < 3; ++k) {
      if (std::fabs(n[k]) > largest) {
        largest = std::fabs(n[k]);
        axis = k;
      }
    }
  }
  FlatFaces faces(result_.vertices, axis);
  for (const Index t : members) {
    if (!boundaries_[t].empty()) faces.add({t, boundaries_[t]});
    for (const Index v : vertices_within_[t]) faces.add_vertex(v);
    for (const Edge& e : edges_within_[t]) faces.add_segment(e);
  }
  found_.clear();
  const auto place = [&](const Edge& e, double share) {
    return between(at(e.first), at(e.second), share);
  };
  const bool whole = faces.triangulate(
      [&](const Edge& e, Index v, double share) { note_crossing(e, v, place(e, share)); },
      [&](const Edge& e, double share) { return vertex_at(place(e, share)); });
  enter_found();
  if (!found_.empty()) return false;
  return whole && faces.append_to(result_.pieces, poll_) ? true
                                                         : fail(boundaries_[members[0]][0].first);
}

bool Snapper::cut_faces() {
  find_faces();
  find_features();
  result_.pieces.clear();
  std::map<Index, std::vector<Index>> sets;
  for (Index t = 0; t < triangles_.size(); ++t) {
    if (!boundaries_[t].empty()) sets[faces_.find(t)].push_back(t);
  }
  bool cut = true;
  for (const auto& [first, members] : sets) {
    poll_();
    const std::vector<Edge>& sides = boundaries_[first];
    if (members.size() == 1 && sides.size() == 3 && vertices_within_[first].empty() &&
        edges_within_[first].empty()) {
      const auto second = std::ranges::find(sides, sides[0].second, &Edge::first);
      result_.pieces.push_back(
          {{sides[0].first, sides[0].second, second->second}, 1, first, false, {first}});
    } else {
      cut = cut_together(members) && cut;
    }
    if (!result_.done) break;
  }
  return cut;
}

// Of a piece no point is farther from a triangle than a corner is.
void Snapper::measure_moves() {
  for (const Piece& piece : result_.pieces) {
    if (!piece.cut) continue;
    poll_();
    for (const Index parent : piece.parents) {
      oracles::Corners given;
      std::ranges::transform(soup_.triangles[parent], given.begin(),
                             [&](Index v) { return soup_.vertices[v]; });
      for (const Index v : piece.corners) {
        result_.moved = std::max(result_.moved, oracles::distance_to_triangle(at(v), given));
      }
    }
  }
}

Snapped Snapper::run() {
  join_vertices();
  for (int round = 0; round < kRounds; ++round) {
    if (!bend_all()) break;
    if (!cut_faces()) continue;
    if (result_.done) measure_moves();
    return std::move(result_);
  }
  fail(triangles_.empty() ? kNone : triangles_[0][0]);
  return std::move(result_);
}

}  // namespace

Snapped snap(const Soup& soup, double reach, Poll& poll) {
  return Snapper(soup, reach, poll).run();
}

}  // namespace tetproof::unite
