#include "corpus/union/separate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "corpus/union/arrangement.h"
#include "corpus/union/pairs.h"
#include "corpus/union/points.h"
#include "corpus/union/unite.h"
#include "corpus/union/wedges.h"
#include "corpus/union/winding.h"
#include "oracles/base/vectors.h"

namespace tetproof::unite {
namespace {

using oracles::cross;
using oracles::dot;
using oracles::minus;

Position along(const Position& p, const Position& direction, double length) {
  return {p[0] + length * direction[0], p[1] + length * direction[1], p[2] + length * direction[2]};
}

Position unit(const Position& p) {
  const double length = std::sqrt(dot(p, p));
  return length > 0 ? along({}, p, 1 / length) : p;
}

// Which way goes in below all triangles with these outward unit normals, as steeply as possible?
// Against the point of their convex hull that is nearest to the origin (Gilbert's iteration). None
// if no way does.
std::optional<Position> below_all(const std::vector<Position>& normals) {
  constexpr int kSteps = 2000;
  constexpr double kFlat = 1e-6;
  Position nearest = normals.front();
  for (int step = 0; step < kSteps; ++step) {
    const Position& lowest = *std::min_element(
        normals.begin(), normals.end(),
        [&](const Position& a, const Position& b) { return dot(a, nearest) < dot(b, nearest); });
    const Position to = minus(lowest, nearest);
    const double gain = -dot(nearest, to);
    if (gain <= kFlat * dot(nearest, nearest)) break;
    nearest = along(nearest, to, std::min(1.0, gain / dot(to, to)));
  }
  const Position direction = unit(along({}, nearest, -1));
  const bool below = std::all_of(normals.begin(), normals.end(),
                                 [&](const Position& n) { return dot(n, direction) < -kFlat; });
  return below ? std::optional(direction) : std::nullopt;
}

// The triangles around a copy of a vertex.
struct Fan {
  Index vertex, home;                 // the copy, and what it is one of
  std::vector<Index> corners;         // 3 t + k is that of vertex k of triangle t
  std::optional<Position> direction;  // a unit vector along which it is moved
  double reach = 0;                   // how far at most
  int attempts = 0;
};

class Separator {
 public:
  Separator(Soup& soup, double farthest, Poll& poll)
      : soup_(soup), farthest_(farthest), poll_(poll) {}
  Separation run();

 private:
  static constexpr int kHalvings = 12;  // of how far a fan is moved

  bool halve_edges();
  void halve(std::span<const EdgeUse> uses);
  void make_copies();
  void copy(Index vertex, const std::vector<Index>& corners, Fans& fans);
  std::array<Position, 2> sides(Index corner) const;
  bool lies_ahead(const Fan& fan, const Fan& other) const;
  void aim(Fan& fan);
  void aim_all();
  Position target(const Fan& fan);
  bool move_all();
  Exact::Point_3 exact_home(Index home) const;
  bool is_near();
  void check();
  bool fail(Index home) {
    result_.place = homes_[home];
    return false;
  }

  Soup& soup_;
  const double farthest_;
  Poll& poll_;
  Separation result_;
  std::map<Index, std::array<Index, 2>> middles_;  // of which edges
  // As they were, with halved edges.
  std::vector<Position> homes_;
  std::vector<Triangle> touching_;
  std::vector<Fan> fans_;      // those of one vertex together
  std::vector<Index> fan_of_;  // of vertices that are copies
  std::mt19937_64 random_{1};  // the same each time
};

void Separator::halve(std::span<const EdgeUse> uses) {
  const Index low = uses[0].low, high = uses[0].high;
  const auto middle = static_cast<Index>(soup_.vertices.size());
  Position p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = soup_.vertices[low][k] / 2 + soup_.vertices[high][k] / 2;
  }
  soup_.vertices.push_back(p);
  middles_[middle] = {low, high};
  ++result_.halved;
  for (const EdgeUse& use : uses) {
    Triangle half = soup_.triangles[use.triangle];
    std::replace(half.begin(), half.end(), low, middle);
    std::replace(soup_.triangles[use.triangle].begin(), soup_.triangles[use.triangle].end(), high,
                 middle);
    soup_.triangles.push_back(half);
    soup_.labels.push_back(soup_.labels[use.triangle]);
  }
}

// Where two wedges of an edge have the same fans at both of its ends, copies of the ends leave the
// edge one of both. No two edges of one triangle at a time. Was there one?
bool Separator::halve_edges() {
  Fans fans(soup_);
  std::vector<bool> taken(soup_.triangles.size(), false);
  std::vector<std::vector<EdgeUse>> found;
  Edges(soup_.triangles).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() == 2) return;
    std::vector<std::array<Index, 2>> ends;
    for (const auto& [use, _] : wedges_at(soup_, uses)) {
      ends.push_back({fans.fan(use.triangle, use.low), fans.fan(use.triangle, use.high)});
    }
    std::sort(ends.begin(), ends.end());
    const auto is_taken = [&](const EdgeUse& use) { return taken[use.triangle]; };
    if (std::adjacent_find(ends.begin(), ends.end()) == ends.end() ||
        std::any_of(uses.begin(), uses.end(), is_taken)) {
      return;
    }
    for (const EdgeUse& use : uses) taken[use.triangle] = true;
    found.emplace_back(uses.begin(), uses.end());
  });
  for (const std::vector<EdgeUse>& uses : found) halve(uses);
  return !found.empty();
}

// Its first fan keeps the vertex itself.
void Separator::copy(Index vertex, const std::vector<Index>& corners, Fans& fans) {
  std::map<Index, std::vector<Index>> sets;
  for (const Index c : corners) sets[fans.fan(c)].push_back(c);
  if (sets.size() < 2) return;
  for (auto& [_, members] : sets) {
    const bool first = members.front() == corners.front();
    const Index number = first ? vertex : static_cast<Index>(soup_.vertices.size());
    if (!first) soup_.vertices.push_back(homes_[vertex]);
    for (const Index c : members) soup_.triangles[c / 3][c % 3] = number;
    fans_.push_back({number, vertex, std::move(members), {}});
  }
}

void Separator::make_copies() {
  Fans fans(soup_);
  homes_ = soup_.vertices;
  touching_ = soup_.triangles;
  std::vector<std::vector<Index>> corners(homes_.size());
  for (Index c = 0; c < 3 * touching_.size(); ++c) corners[touching_[c / 3][c % 3]].push_back(c);
  for (Index v = 0; v < homes_.size(); ++v) copy(v, corners[v], fans);
  fan_of_.assign(soup_.vertices.size(), kNone);
  for (std::size_t f = 0; f < fans_.size(); ++f) fan_of_[fans_[f].vertex] = static_cast<Index>(f);
  result_.copies = fans_.size();
}

// The vectors from the vertex to the two others, in the order of the triangle.
std::array<Position, 2> Separator::sides(Index corner) const {
  const Triangle& t = touching_[corner / 3];
  const Position& p = homes_[t[corner % 3]];
  return {minus(homes_[t[(corner + 1) % 3]], p), minus(homes_[t[(corner + 2) % 3]], p)};
}

// Does a fan begin, at the vertex that both are at, on the side where this one is moved to? It has
// a direction, so that each ray has one triangle of it above or below. In doubles: if it is wrong,
// it is noticed by what meets.
bool Separator::lies_ahead(const Fan& fan, const Fan& other) const {
  const auto [u, v] = sides(other.corners.front());
  const Position ray = along(unit(u), unit(v), 1);
  for (const Index c : fan.corners) {
    const auto [a, b] = sides(c);
    const double volume = dot(cross(a, b), *fan.direction);
    const double along_a = dot(cross(ray, b), *fan.direction) / volume;
    const double along_b = dot(cross(a, ray), *fan.direction) / volume;
    if (along_a >= 0 && along_b >= 0) return dot(cross(a, b), ray) / volume > 0;
  }
  return false;
}

void Separator::aim(Fan& fan) {
  constexpr double kShare = 0.25;   // of the shortest edge
  constexpr double kMargin = 0.99;  // for rounding
  std::vector<Position> normals;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Index c : fan.corners) {
    const auto [a, b] = sides(c);
    normals.push_back(unit(cross(a, b)));
    shortest = std::min({shortest, dot(a, a), dot(b, b)});
  }
  fan.direction = below_all(normals);
  fan.reach = std::min(kMargin * farthest_, kShare * std::sqrt(shortest));
}

// Each fan goes into its solid, or, if others are there, out of it.
void Separator::aim_all() {
  for (Fan& fan : fans_) aim(fan);
  for (auto first = fans_.begin(); first != fans_.end();) {
    const auto last =
        std::find_if(first, fans_.end(), [&](const Fan& fan) { return fan.home != first->home; });
    for (auto fan = first; fan != last; ++fan) {
      if (!fan->direction) continue;
      std::ptrdiff_t ahead = 0;
      for (auto other = first; other != last; ++other) {
        ahead += other != fan && lies_ahead(*fan, *other) ? 1 : 0;
      }
      if (2 * ahead > last - first - 1) fan->direction = along({}, *fan->direction, -1);
    }
    first = last;
  }
}

// A fan that has a direction goes less and less far, then the other way. One that has none stays,
// then goes anywhere.
Position Separator::target(const Fan& fan) {
  const Position& home = homes_[fan.home];
  if (fan.direction) {
    const double way = fan.attempts < kHalvings ? 1 : -1;
    return along(home, *fan.direction, way * std::ldexp(fan.reach, -(fan.attempts % kHalvings)));
  }
  if (fan.attempts == 0) return home;
  std::normal_distribution<double> normal;
  const Position anywhere = unit({normal(random_), normal(random_), normal(random_)});
  return along(home, anywhere, std::ldexp(fan.reach, -fan.attempts % kHalvings));
}

// Until no two triangles meet.
bool Separator::move_all() {
  for (Fan& fan : fans_) soup_.vertices[fan.vertex] = target(fan);
  while (true) {
    const std::vector<MeetingPair> pairs = meeting_pairs(soup_, poll_);
    if (pairs.empty()) return true;
    std::set<Index> again;
    for (const MeetingPair& pair : pairs) {
      for (const Index t : {pair.a, pair.b}) {
        for (const Index v : soup_.triangles[t]) again.insert(fan_of_[v]);
      }
    }
    again.erase(kNone);
    for (const Index f : again) {
      Fan& fan = fans_[f];
      if (++fan.attempts == 2 * kHalvings) return fail(fan.home);
      soup_.vertices[fan.vertex] = target(fan);
    }
  }
}

Exact::Point_3 Separator::exact_home(Index home) const {
  const auto point = [&](Index v) {
    return Exact::Point_3(homes_[v][0], homes_[v][1], homes_[v][2]);
  };
  const auto edge = middles_.find(home);
  if (edge == middles_.end()) return point(home);
  return CGAL::midpoint(exact_home(edge->second[0]), exact_home(edge->second[1]));
}

bool Separator::is_near() {
  const Exact::FT most = CGAL::square(Exact::FT(farthest_));
  for (const Fan& fan : fans_) {
    const Position& at = soup_.vertices[fan.vertex];
    const Exact::FT squared =
        CGAL::squared_distance(Exact::Point_3(at[0], at[1], at[2]), exact_home(fan.home));
    if (squared > most) return fail(fan.home);
    result_.largest_move = std::max(result_.largest_move, std::sqrt(CGAL::to_double(squared)));
  }
  return true;
}

// Nothing is believed of the way it was made: it must be its own union.
void Separator::check() {
  const Soup again = soup_of(surface_of(soup_));
  if (again.welded + again.degenerate > 0) throw InternalError("parts moved apart are not");
  if (find_touching(soup_.triangles).place != kNone) throw InternalError("copies still touch");
  const Arrangement arrangement = arrange(soup_, {}, Cancelled::dropped, poll_);
  if (find_open_edges(arrangement.pieces).count > 0) throw InternalError("parts are open");
  const std::vector<int> windings = windings_in_front(arrangement, poll_);
  if (std::any_of(windings.begin(), windings.end(), [](int w) { return w != 0; })) {
    throw InternalError("parts moved apart are inside of others");
  }
}

Separation Separator::run() {
  try {
    while (halve_edges()) poll_();
  } catch (const Twisted& twisted) {
    result_.place = soup_.vertices[twisted.vertex];
    return result_;
  }
  make_copies();
  aim_all();
  result_.done = move_all() && is_near();
  if (result_.done) check();
  return result_;
}

}  // namespace

Separation separate(Soup& soup, double farthest, Poll& poll) {
  return Separator(soup, farthest, poll).run();
}

}  // namespace tetproof::unite
