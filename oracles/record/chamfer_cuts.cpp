// Checks the parts that chamfering cut off, and that it had to.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <unordered_map>

#include "oracles/base/edge_key.h"
#include "oracles/record/chamfer.h"
#include "oracles/surface/corners.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// Cut points are placed with a relative accuracy of 2^-20.
constexpr double kPlacement = 1 + 0x1p-16;

std::string corner_name(Index v) {
  return "input vertex " + std::to_string(v);
}

// --- was there need?

class ChamferNeed {
 public:
  explicit ChamferNeed(const RefinedMesh& mesh)
      : record_(*mesh.record),
        surface_(*mesh.surface),
        facets_(surface_, record_),
        acute_(*mesh.points, surface_),
        limit_(mesh.promise->chamfer_radius),
        to_link_(mesh.promise->link || mesh.promise->bridges),
        thresholds_(thresholds_of(record_.parameters)) {
    for (const ExactRecord::Corner& corner : record_.corners) corner_[corner.vertex] = &corner;
  }

  OracleReport run() {
    const auto present = [this](Index f) { return facets_.kept(f); };
    for (const Index v : surface_.used_vertices()) {
      ++report_.checked;
      const auto corner = corner_.find(v);
      const bool cut = corner != corner_.end();
      const std::string why =
          acute_.why_acute(v, present, thresholds_, cut ? Doubt::acute : Doubt::not_acute);
      if (cut && why.empty()) {
        report_.fail(corner_name(v) + " was chamfered and is not acute");
      } else if (!cut && !why.empty()) {
        report_.fail(corner_name(v) + " was not chamfered and is acute: " + why);
      }
      if (cut) check_distance(*corner->second);
    }
    if (corner_.size() != record_.corners.size()) report_.fail("a corner is listed twice");
    for (const auto& [v, corner] : corner_) {
      if (!std::binary_search(surface_.used_vertices().begin(), surface_.used_vertices().end(),
                              v)) {
        report_.fail(corner_name(v) + " was chamfered and is on no facet");
      }
    }
    check_missing_edges();
    report_.figures.emplace_back("corners", static_cast<double>(corner_.size()));
    report_.figures.emplace_back("largest distance over local feature size", largest_share_);
    return std::move(report_);
  }

 private:
  void check_distance(const ExactRecord::Corner& corner) {
    const Index v = corner.vertex;
    if (!(corner.distance > 0)) return report_.fail(corner_name(v) + " is not cut back");
    const auto present = [this](Index f) { return facets_.kept(f); };
    const double reach = 3 * corner.distance * (1 - 1e-9);
    const double link = to_link_ ? acute_.distance_to_link(v, present) : HUGE_VAL;
    if (link < reach) {
      report_.fail(corner_name(v) +
                   " is cut back by more than a third of its distance from its link");
    }
    // The link is nearer than the rest of the boundary of the facets here; the boundary of another
    // part of a facet may be nearer, beyond the part that is cut off.
    const std::string near = to_link_ ? "" : acute_.nearer_than(reach, v, present);
    if (!near.empty()) {
      report_.fail(corner_name(v) + " is cut back by more than a third of its distance from " +
                   near);
    }
    if (limit_ > 0 && corner.distance > limit_ * kPlacement) {
      report_.fail(corner_name(v) + " is cut back farther than --chamfer-radius");
    }
    const double size =
        to_link_ ? link : acute_.local_feature_size(v, present, 4 * corner.distance);
    largest_share_ = std::max(largest_share_, corner.distance / size);
  }

  void check_missing_edges() {
    const InputEdges input_edges(surface_);
    std::vector<std::uint8_t> present_edge(surface_.edges().size());
    for (const ExactRecord::Chain& chain : record_.segments) {
      const Index e = chain.artificial ? kNone : input_edges.of_chain(record_, chain.vertices);
      if (e != kNone) present_edge[e] = 1;
    }
    const auto present = [this](Index f) { return facets_.kept(f); };
    for (Index e = 0; e < surface_.edges().size(); ++e) {
      const InputSurface::Edge& edge = surface_.edges()[e];
      if (!AcuteCorners::edge_present(edge, present)) continue;
      const std::string name =
          "input edge " + std::to_string(edge.from) + "-" + std::to_string(edge.to);
      if (present_edge[e] == 0 && !acute_.edge_is_acute(e, present, thresholds_, Doubt::acute)) {
        report_.fail(name + " was chamfered and is not acute");
      }
      if (present_edge[e] != 0 && acute_.edge_is_acute(e, present, thresholds_, Doubt::not_acute)) {
        report_.fail(name + " was not chamfered and is acute");
      }
    }
  }

  const ExactRecord& record_;
  const InputSurface& surface_;
  const FacetIndex facets_;
  const AcuteCorners acute_;
  double limit_;
  bool to_link_;
  std::unordered_map<Index, const ExactRecord::Corner*> corner_;
  const CornerThresholds thresholds_;
  double largest_share_ = 0;
  OracleReport report_{"chamfer-need", "input vertices"};
};

// --- the missing parts

using AreaSum = std::array<ExactSum, 3>;

// Follows the boundary of the rest of every kept facet. It must be the facet's own boundary, side
// by side, except for a detour around each chamfered corner, over points made for that corner, and
// a strip beside each acute edge, from the points made for one end to those made for the other.
class ChamferCuts {
 public:
  explicit ChamferCuts(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        input_edges_(surface_) {
    for (const auto& [point, vertex] : record_.chamfer_points) {
      const auto [known, fresh] = made_for_.emplace(point, vertex);
      if (!fresh && known->second != vertex) {
        report_.fail(complex_.vertex_name(point) + " was made for two corners");
      }
    }
    for (const ExactRecord::Corner& corner : record_.corners) corners_.push_back(corner.vertex);
    std::sort(corners_.begin(), corners_.end());
  }

  OracleReport run() {
    collect_faces();
    collect_chains();
    collect_sides();
    for (Index f = 0; f < surface_.facets().size(); ++f) {
      if (facets_.kept(f)) check_facet(f);
    }
    report_.figures.emplace_back("detours around corners", static_cast<double>(detours_));
    report_.figures.emplace_back("strips beside acute edges", static_cast<double>(strips_));
    return std::move(report_);
  }

 private:
  struct Side {  // of a facet, seen from outside, on an input edge
    Index from, to, edge, next;
  };
  // What is left of an input edge: a chain of the record.
  struct Rest {
    Index chain = kNone;
    bool reversed = false;  // it runs from the edge's head to its tail
  };
  struct Link {  // an artificial chain, in the direction of the rest's boundary
    Index to;
    const std::vector<Index>* vertices;
    bool reversed;
    bool used = false;
  };
  using Links = std::map<std::pair<Index, Index>, Link>;  // facet, from
  struct Walk {                                           // around one boundary of a facet
    Index facet;
    Index first;      // side
    Index begin, at;  // points of the complex
  };

  void collect_faces();
  void collect_chains();
  void collect_sides();
  void check_facet(Index f);
  bool walk(Index f, Index first);
  Index step(Index f, Index at);
  Index start_of_strip(Index f, Index s) const;
  bool pass_side(Walk& walk, Index s);
  bool pass_corner(Walk& walk, Index s);
  bool is_behind_corner(const Walk& walk, Index s) const;
  bool is_cut_off(Index s) const { return rest_[sides_[s].edge].chain == kNone; }
  // The chain of the edge that a side lies on, which is not cut off.
  const std::vector<Index>& chain_of(Index s) const {
    return record_.segments[rest_[sides_[s].edge].chain].vertices;
  }
  // Does that chain run from the side's head to its tail?
  bool is_reversed(Index s) const {
    const bool along = surface_.edges()[sides_[s].edge].from == sides_[s].from;
    return along == rest_[sides_[s].edge].reversed;
  }
  Index start(Index s) const { return is_reversed(s) ? chain_of(s).back() : chain_of(s).front(); }
  Index end(Index s) const { return is_reversed(s) ? chain_of(s).front() : chain_of(s).back(); }
  void add(const std::vector<Index>& chain, bool reversed);
  bool accounts_for(Index f);
  AreaSum area(Index f, std::span<const std::uint64_t> edges) const;
  void fail(Index f, const std::string& what) {
    report_.fail("facet " + std::to_string(surface_.facets()[f].id) + ": " + what);
  }
  bool refuse(Index f, const std::string& what) {
    fail(f, what);
    return false;
  }
  std::span<const std::uint64_t> face_sides(Index f) const {
    return std::span(face_sides_)
        .subspan(first_face_side_[f], first_face_side_[f + 1] - first_face_side_[f]);
  }
  Index made_for(Index v) const {
    const auto found = made_for_.find(v);
    return found != made_for_.end() ? found->second : kNone;
  }

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  const InputEdges input_edges_;
  std::unordered_map<Index, Index> made_for_;
  std::vector<Index> corners_;  // ascending
  // The directed edges of the faces on each facet, ascending.
  std::vector<std::uint64_t> face_sides_;
  std::vector<std::size_t> first_face_side_;  // per facet, and the end
  std::vector<Rest> rest_;                    // per input edge
  Links links_;
  std::vector<Side> sides_;        // one facet after another
  std::vector<Index> first_side_;  // per facet, and the end
  std::vector<std::uint8_t> passed_;
  std::vector<std::uint64_t> walked_;  // the directed edges followed so far
  std::uint64_t detours_ = 0, strips_ = 0;
  OracleReport report_{"chamfer-cuts", "sides of kept facets"};
};

void ChamferCuts::collect_faces() {
  first_face_side_.assign(surface_.facets().size() + 1, 0);
  for (const auto& [a, b, c, id] : record_.refined_facets) {
    if (const Index f = facets_.find(id); f != kNone) first_face_side_[f + 1] += 3;
  }
  std::partial_sum(first_face_side_.begin(), first_face_side_.end(), first_face_side_.begin());
  face_sides_.resize(first_face_side_.back());
  std::vector<std::size_t> next(first_face_side_.begin(), first_face_side_.end() - 1);
  for (const auto& [a, b, c, id] : record_.refined_facets) {
    const Index f = facets_.find(id);
    if (f == kNone) continue;
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      face_sides_[next[f]++] = directed_key(p, q);
    }
  }
  for (std::size_t f = 0; f < next.size(); ++f) {
    std::sort(face_sides_.begin() + static_cast<std::ptrdiff_t>(first_face_side_[f]),
              face_sides_.begin() + static_cast<std::ptrdiff_t>(next[f]));
  }
}

void ChamferCuts::collect_chains() {
  rest_.resize(surface_.edges().size());
  for (std::size_t n = 0; n < record_.segments.size(); ++n) {
    const ExactRecord::Chain& chain = record_.segments[n];
    const std::vector<Index>& v = chain.vertices;
    if (v.size() < 2) continue;  // the segment oracle reports it
    if (!chain.artificial) {
      const Index e = input_edges_.of_chain(record_, v);
      if (e == kNone) continue;
      const InputSurface::Edge& edge = surface_.edges()[e];
      rest_[e] = {static_cast<Index>(n), along_edge(points_, edge, v.front(), v.back()) < 0};
      continue;
    }
    const Index f = facets_.find(chain.facet);
    if (f == kNone) continue;
    const std::span<const std::uint64_t> sides = face_sides(f);
    const bool reversed = !std::binary_search(sides.begin(), sides.end(), directed_key(v[0], v[1]));
    const Index from = reversed ? v.back() : v.front(), to = reversed ? v.front() : v.back();
    for (const Index end : {from, to}) {
      if (made_for(end) == kNone) {
        fail(f, "the artificial segment at " + complex_.vertex_name(end) +
                    " ends where nothing was chamfered");
      }
    }
    if (!links_.emplace(std::pair(f, from), Link{to, &v, reversed}).second) {
      fail(f, "two artificial segments leave " + complex_.vertex_name(from));
    }
  }
}

void ChamferCuts::collect_sides() {
  const auto& triangles = surface_.triangles();
  const auto& facet_of = surface_.facet_of_triangle();
  const InputSurface::Members members = surface_.members();
  std::vector<Index> number(3 * triangles.size(), kNone);  // per triangle * 3 + side
  sides_.reserve(2 * surface_.edges().size());
  for (Index f = 0; f < surface_.facets().size(); ++f) {
    first_side_.push_back(static_cast<Index>(sides_.size()));
    for (const Index t : members.of(f)) {
      for (int i = 0; i < 3; ++i) {
        if (facet_of[surface_.neighbour(t, i)] == f) continue;
        const Index a = triangles[t][i], b = triangles[t][(i + 1) % 3];
        number[3 * std::size_t{t} + i] = static_cast<Index>(sides_.size());
        sides_.push_back({a, b, input_edges_.find(a, b), 0});
      }
    }
  }
  first_side_.push_back(static_cast<Index>(sides_.size()));
  for (std::size_t key = 0; key < number.size(); ++key) {
    const Index side = number[key];
    if (side == kNone) continue;
    // Around the head, over the triangles of the facet, to the next side.
    auto t = static_cast<Index>(key / 3);
    int i = (static_cast<int>(key % 3) + 1) % 3;
    const Index head = sides_[side].to;
    while (facet_of[surface_.neighbour(t, i)] == facet_of[t]) {
      t = surface_.neighbour(t, i);
      i = static_cast<int>(std::find(triangles[t].begin(), triangles[t].end(), head) -
                           triangles[t].begin());
    }
    sides_[side].next = number[3 * std::size_t{t} + i];
  }
  passed_.resize(sides_.size());
}

void ChamferCuts::add(const std::vector<Index>& chain, bool reversed) {
  for (std::size_t i = 1; i < chain.size(); ++i) {
    walked_.push_back(reversed ? directed_key(chain[i], chain[i - 1])
                               : directed_key(chain[i - 1], chain[i]));
  }
}

// Is the area inside what has been followed that of the faces? It is, without any arithmetic, if
// these are the directed edges that bound the faces.
bool ChamferCuts::accounts_for(Index f) {
  const std::span<const std::uint64_t> sides = face_sides(f);
  std::vector<std::uint64_t> border;
  for (const std::uint64_t side : sides) {
    const std::uint64_t back = side << 32 | side >> 32;
    if (!std::binary_search(sides.begin(), sides.end(), back)) border.push_back(side);
  }
  std::sort(walked_.begin(), walked_.end());
  const bool once = std::adjacent_find(sides.begin(), sides.end()) == sides.end();
  return (once && walked_ == border) || area(f, walked_) == area(f, sides);
}

// Twice the area inside directed edges in the plane of a facet.
AreaSum ChamferCuts::area(Index f, std::span<const std::uint64_t> edges) const {
  AreaSum sum;
  for (const std::uint64_t edge : edges) {
    const ExactVector n = exact::area2(points_, surface_.facets()[f].span[0],
                                       static_cast<Index>(edge >> 32), static_cast<Index>(edge));
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += n[axis];
  }
  return sum;
}

void ChamferCuts::check_facet(Index f) {
  walked_.clear();
  bool followed = true;
  for (Index s = first_side_[f]; s < first_side_[f + 1]; ++s) {
    ++report_.checked;
    if (sides_[s].edge == kNone) return fail(f, "has a side on no input edge");
    if (passed_[s] == 0 && !is_cut_off(s)) followed = walk(f, s) && followed;
  }
  // Where all edges of a boundary are acute, only strips are left of it.
  for (Index s = first_side_[f]; s < first_side_[f + 1]; ++s) {
    if (passed_[s] == 0 && followed) followed = walk(f, s);
  }
  if (!followed) return;
  for (auto link = links_.lower_bound({f, 0}); link != links_.end() && link->first.first == f;
       ++link) {
    if (!link->second.used) {
      return fail(f, "the artificial segment from " + complex_.vertex_name(link->first.second) +
                         " cuts off no corner and no edge");
    }
  }
  if (!accounts_for(f)) fail(f, "the cuts do not account for what is missing");
}

// Over one artificial segment; kNone if there is none that has not been passed.
Index ChamferCuts::step(Index f, Index at) {
  const auto link = links_.find({f, at});
  if (link == links_.end() || link->second.used) return kNone;
  link->second.used = true;
  add(*link->second.vertices, link->second.reversed);
  return link->second.to;
}

// Where the strip beside a side whose edge was cut off begins: at a point made for its tail. kNone
// if there is no strip.
Index ChamferCuts::start_of_strip(Index f, Index s) const {
  Index start = kNone;
  for (auto link = links_.lower_bound({f, 0}); link != links_.end() && link->first.first == f;
       ++link) {
    if (!link->second.used && made_for(link->first.second) == sides_[s].from &&
        made_for(link->second.to) == sides_[s].to) {
      start = link->first.second;
    }
  }
  return start;
}

// Over what is left of a side: its chain, or the strip beside it.
bool ChamferCuts::pass_side(Walk& walk, Index s) {
  if (!is_cut_off(s)) {
    add(chain_of(s), is_reversed(s));
    walk.at = end(s);
    return true;
  }
  ++strips_;
  walk.at = step(walk.facet, walk.at);
  if (walk.at != kNone && made_for(walk.at) == sides_[s].to) return true;
  return refuse(walk.facet, "no cut leads along the acute edge to " + corner_name(sides_[s].to));
}

// From the end of a side to the beginning of the next one: nowhere, or around the chamfered corner
// between them.
bool ChamferCuts::pass_corner(Walk& walk, Index s) {
  const Index corner = sides_[s].to;
  if (!std::binary_search(corners_.begin(), corners_.end(), corner)) {
    const Index next = sides_[s].next;
    const bool joined = !is_cut_off(next) && walk.at == corner && start(next) == corner;
    return joined || refuse(walk.facet, corner_name(corner) + " was cut off and is not chamfered");
  }
  ++detours_;
  while (!is_behind_corner(walk, s)) {
    walk.at = step(walk.facet, walk.at);
    if (walk.at == kNone || made_for(walk.at) != corner) {
      return refuse(walk.facet, "no cut leads around " + corner_name(corner));
    }
  }
  return true;
}

// Has the detour around the corner behind a side come to where the next side begins?
bool ChamferCuts::is_behind_corner(const Walk& walk, Index s) const {
  const Index next = sides_[s].next;
  if (next == walk.first) return walk.at == walk.begin;
  if (!is_cut_off(next)) return walk.at == start(next);
  const auto link = links_.find({walk.facet, walk.at});
  return link != links_.end() && made_for(link->second.to) == sides_[next].to &&
         sides_[next].to != sides_[s].to;
}

// Follows the boundary from a side, over all sides after it, back to it.
bool ChamferCuts::walk(Index f, Index first) {
  const Index begin = is_cut_off(first) ? start_of_strip(f, first) : start(first);
  if (begin == kNone) {
    return refuse(f, "nothing is left beside " + corner_name(sides_[first].from));
  }
  Walk walk{f, first, begin, begin};
  Index s = first;
  do {
    if (passed_[s]++ != 0) return refuse(f, "its boundary is followed twice");
    if (!pass_side(walk, s) || !pass_corner(walk, s)) return false;
    s = sides_[s].next;
  } while (s != first);
  return true;
}

}  // namespace

OracleReport check_chamfer_need(const RefinedMesh& mesh) {
  return ChamferNeed(mesh).run();
}

OracleReport check_chamfer_cuts(const RefinedMesh& mesh) {
  return ChamferCuts(mesh).run();
}

}  // namespace tetproof::oracles
