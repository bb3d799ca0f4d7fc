#include "mesher/planar/group_planes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>

#include "mesher/arithmetic/bounded.h"
#include "mesher/base/disjoint_sets.h"
#include "mesher/base/sort_unique.h"
#include "mesher/predicates/exact_point.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::planar {

Fit rough(const PlaneEquation& plane) {
  return {plane.normal, plane.through[0]};
}

bool exactly_on(const PlaneEquation& plane, const Vec3& p) {
  if (plane.spanned) {
    if (std::ranges::find(plane.through, p) != plane.through.end()) return true;
    return orient3d_sign(plane.through[0], plane.through[1], plane.through[2], p) == 0;
  }
  // Most points are off the plane by more than roundings; the others are often on it by what the
  // numbers are.
  Bounded height;  // nothing is added where a difference or a component is 0
  for (std::size_t i = 0; i < 3; ++i) {
    if (plane.normal[i] == 0 || p[i] == plane.through[0][i]) continue;
    height = height + Bounded{plane.normal[i]} * (Bounded{p[i]} - Bounded{plane.through[0][i]});
  }
  if (const int sign = height.sign(); sign != kUnknownSign) return sign == 0;
  Dyadic sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum = sum + Dyadic::from_double(plane.normal[i]) *
                    (Dyadic::from_double(p[i]) - Dyadic::from_double(plane.through[0][i]));
  }
  return sum.sign() == 0;
}

bool GroupPlanes::fit() {
  planes_.resize(growth_.groups().size());
  bool any = false;
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (!growth_.is_group(g)) continue;
    if (planes_[g].fitted_to != growth_.groups()[g].triangles.size()) fit(g);
    any = any || (growth_.is_group(g) && planes_[g].state == State::moving);
  }
  return any;
}

void GroupPlanes::fit(std::uint32_t group) {
  Plane& p = planes_[group];
  const PlanarGrowth::Group& grown = growth_.groups()[group];
  PlaneFit sum(surface_.vertices());
  p.area = 0;
  for (const std::uint32_t t : grown.triangles) {
    control_.poll();
    sum.add(surface_.triangles()[t]);
    p.area += surface_.size(t);
  }
  const std::vector<VertexId> list = growth_.vertices_of(group);
  p.plane = p.fitted = meant_plane(sum.fit(), group, list);
  p.state = State::moving;
  if (all_on(p.plane, list)) {
    p.state = State::on_plane;
  } else if (in_one_plane(group, list)) {
    p.state = State::planar;
  }
  // Vertices that the growing plane had left behind.
  const Fit fit = rough(p.plane);
  for (std::size_t i = grown.triangles.size(); i-- > 0;) {
    const std::uint32_t t = grown.triangles[i];
    if (!growth_.within(t, fit, grown.noise)) growth_.detach(t);
  }
  p.fitted_to = grown.triangles.size();
}

bool GroupPlanes::all_on(const PlaneEquation& plane, const std::vector<VertexId>& list) const {
  return std::ranges::all_of(list, [&](VertexId v) {
    control_.poll();
    return exactly_on(plane, surface_.vertices()[v]);
  });
}

std::uint32_t GroupPlanes::largest_triangle(std::uint32_t group) const {
  return *std::ranges::max_element(growth_.groups()[group].triangles, {},
                                   [&](std::uint32_t t) { return surface_.size(t); });
}

bool GroupPlanes::in_one_plane(std::uint32_t group, const std::vector<VertexId>& list) const {
  const auto& [a, b, c] = surface_.triangles()[largest_triangle(group)];
  return std::ranges::all_of(list, [&, a = a, b = b, c = c](VertexId v) {
    return orient3d_sign(surface_.vertices()[a], surface_.vertices()[b], surface_.vertices()[c],
                         surface_.vertices()[v]) == 0;
  });
}

// The plane as it was meant, if one of short coordinates contains all vertices: nothing moves. The
// largest coordinate of normals is about 1 in all units, because triple products of them are
// compared.
PlaneEquation GroupPlanes::meant_plane(const Fit& fit, std::uint32_t group,
                                       const std::vector<VertexId>& list) const {
  PlaneEquation plane{surface_.area(largest_triangle(group)), {surface_.vertices()[list.front()]}};
  const int exponent = std::ilogb(plane.normal[largest_axis(plane.normal)]);
  for (double& x : plane.normal) x = std::ldexp(x, -exponent);
  if (all_on(plane, list)) return plane;
  for (const int bits : {0, 3, 12, 26}) {
    plane.normal = fit.normal;
    for (double& x : plane.normal) x = std::ldexp(std::round(std::ldexp(x, bits)), -bits);
    if (all_on(plane, list)) return plane;
  }
  return {fit.normal, {fit.through}};
}

void GroupPlanes::share() {
  planes_at_.assign(surface_.vertices().size(), {});
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (!growth_.is_group(g)) continue;
    for (const VertexId v : growth_.vertices_of(g)) planes_at_[v].push_back(g);
  }
  DisjointSets same(planes_.size());
  for (const std::vector<std::uint32_t>& at : planes_at_) {
    control_.poll();
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (same.smallest(at[i]) != same.smallest(at[j]) && one_plane(at[i], at[j])) {
          same.join(at[i], at[j]);
        }
      }
    }
  }
  plane_of_.assign(planes_.size(), kNone);
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (!growth_.is_group(g)) continue;
    const std::uint32_t root = same.smallest(g);
    if (plane_of_[root] == kNone || planes_[g].area > planes_[plane_of_[root]].area) {
      plane_of_[root] = g;
    }
  }
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (growth_.is_group(g)) plane_of_[g] = plane_of_[same.smallest(g)];
  }
  for (std::vector<std::uint32_t>& at : planes_at_) {
    for (std::uint32_t& g : at) g = plane_of_[g];
    sort_unique(at);
  }
  for (Plane& p : planes_) {
    p.plane = p.fitted;
    p.pins.clear();
  }
  find_lent_states();
}

// A plane that groups share has one state: a group that is flat in a plane of its own is not on the
// one that it was lent.
void GroupPlanes::find_lent_states() {
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (growth_.is_group(g)) planes_[g].lent_state = planes_[g].state;
  }
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (!growth_.is_group(g) || plane_of_[g] == g) continue;
    Plane& lent = planes_[plane_of_[g]];
    const bool on = lent.state == State::on_plane && all_on(lent.plane, growth_.vertices_of(g));
    const State needed = on                                  ? State::on_plane
                         : planes_[g].state == State::moving ? State::moving
                                                             : State::planar;
    lent.lent_state = std::max(lent.lent_state, needed);
  }
}

bool GroupPlanes::one_plane(std::uint32_t g, std::uint32_t h) const {
  const Fit a = rough(planes_[g].plane), b = rough(planes_[h].plane);
  const std::size_t axis = static_cast<std::size_t>(largest_axis(a.normal));
  const double side = a.normal[axis] * b.normal[axis];
  if (!(std::fabs(side) > 0.5)) return false;
  const double noise = std::min(growth_.groups()[g].noise, growth_.groups()[h].noise);
  const auto on = [&](const Fit& fit, std::uint32_t other) {
    return std::ranges::all_of(growth_.groups()[other].triangles, [&](std::uint32_t t) {
      control_.poll();
      return growth_.within(t, fit, noise);
    });
  };
  return on(a, h) && on(b, g);
}

bool GroupPlanes::spread_moves() {
  bool any = false;
  for (bool again = true; again;) {
    again = false;
    for (VertexId v = 0; v < planes_at_.size(); ++v) {
      control_.poll();
      if (!must_move(v)) continue;
      for (const std::uint32_t g : planes_at_[v]) {
        if (planes_[g].lent_state != State::planar) continue;
        planes_[g].lent_state = State::moving;
        any = again = true;
      }
    }
  }
  return any;
}

bool GroupPlanes::relieve_vertices() {
  std::vector<std::vector<std::uint32_t>> sharing(planes_.size());
  for (std::uint32_t g = 0; g < planes_.size(); ++g) {
    if (growth_.is_group(g)) sharing[plane_of_[g]].push_back(g);
  }
  std::vector<VertexId> stuck;
  std::vector<std::uint8_t> is_stuck(planes_at_.size(), 0);
  // A plane that is moved for one vertex may leave another behind, which then moves, and planar
  // groups with it.
  for (bool again = true; again;) {
    again = false;
    for (VertexId v = 0; v < planes_at_.size(); ++v) {
      control_.poll();
      if (planes_at_[v].size() <= 3 || is_stuck[v] != 0 || !must_move(v)) continue;
      if (pin_all(v, sharing)) {
        again = true;
      } else {
        stuck.push_back(v);
        is_stuck[v] = 1;
      }
    }
    again = spread_moves() || again;
  }
  make_room(stuck);
  return !stuck.empty();
}

// All planes at the vertex, or none.
bool GroupPlanes::pin_all(VertexId v, const std::vector<std::vector<std::uint32_t>>& sharing) {
  std::vector<std::pair<std::uint32_t, PlaneEquation>> before;
  for (const std::uint32_t g : planes_at_[v]) {
    if (!moving(g) || exactly_on(plane(g), surface_.vertices()[v])) continue;
    before.emplace_back(g, plane(g));
    if (pin(v, g, sharing[g])) continue;
    before.pop_back();
    for (const auto& [pinned, equation] : before) {
      planes_[pinned].plane = equation;
      planes_[pinned].pins.pop_back();
    }
    return false;
  }
  return true;
}

// A plane that is given up at one vertex mostly is at all vertices of its group, if that is one of
// few triangles. So few planes are enough: the one first that makes room at most vertices for the
// least harm. Harm is done by triangles that become facets of their own, the more the narrower they
// are.
void GroupPlanes::make_room(const std::vector<VertexId>& stuck) {
  struct Candidate {
    std::vector<VertexId> at;
    double harm = 0;
  };
  std::map<std::uint32_t, Candidate> candidates;
  for (const VertexId v : stuck) {
    control_.poll();
    for (const std::uint32_t g : planes_at_[v]) {
      Candidate& candidate = candidates[g];
      candidate.at.push_back(v);
      for (const std::uint32_t t : triangles_at(v, g)) {
        const double length = surface_.edge_length(surface_.longest_edge(t));
        candidate.harm += length * length / surface_.size(t);
      }
    }
  }
  const auto has_no_room = [&](VertexId v) { return planes_at_[v].size() > 3; };
  using Gain = std::pair<double, std::uint32_t>;
  std::priority_queue<Gain> best;
  const auto push = [&](std::uint32_t g) {
    const Candidate& candidate = candidates[g];
    const auto count = static_cast<double>(std::ranges::count_if(candidate.at, has_no_room));
    if (count > 0) best.emplace(count / candidate.harm, g);
  };
  for (const auto& [g, candidate] : candidates) push(g);
  while (!best.empty()) {
    control_.poll();
    const auto [gain, g] = best.top();
    best.pop();
    // Gains only become smaller, so a candidate that is still the best is the best of all.
    const Candidate& candidate = candidates[g];
    const auto count = static_cast<double>(std::ranges::count_if(candidate.at, has_no_room));
    if (count / candidate.harm < gain) {
      push(g);
      continue;
    }
    for (const VertexId v : candidate.at) {
      if (has_no_room(v)) detach_at(v, g);
    }
  }
}

// Moves the plane so that it contains the vertex, and those that it was moved for before.
bool GroupPlanes::pin(VertexId v, std::uint32_t g, const std::vector<std::uint32_t>& sharing) {
  Plane& lent = planes_[g];
  if (lent.pins.size() == 3) return false;
  lent.pins.push_back(v);
  const PlaneEquation before = lent.plane;
  lent.plane = pinned_plane(lent);
  const Fit fit = rough(lent.plane);
  const bool near = std::ranges::all_of(sharing, [&](std::uint32_t other) {
    return std::ranges::all_of(growth_.groups()[other].triangles, [&](std::uint32_t t) {
      control_.poll();
      return growth_.within(t, fit, 2 * growth_.groups()[other].noise);
    });
  });
  const auto contains = [&](VertexId w) { return exactly_on(lent.plane, surface_.vertices()[w]); };
  if (near && std::ranges::all_of(lent.pins, contains)) return true;
  lent.plane = before;
  lent.pins.pop_back();
  return false;
}

PlaneEquation GroupPlanes::pinned_plane(const Plane& lent) const {
  const std::vector<VertexId>& pins = lent.pins;
  const Vec3& normal = lent.fitted.normal;
  const Vec3& a = surface_.vertices()[pins[0]];
  if (pins.size() == 1) return {normal, {a}};
  PlaneEquation plane{normal, {a, surface_.vertices()[pins[1]], {}}, true};
  plane.through[2] = pins.size() == 3 ? surface_.vertices()[pins[2]]
                                      : add_scaled(a, 1 / norm(normal),
                                                   cross(normal, subtract(plane.through[1], a)));
  Vec3 n = cross(subtract(plane.through[1], a), subtract(plane.through[2], a));
  if (dot(n, normal) < 0) {
    std::swap(plane.through[1], plane.through[2]);
    for (double& x : n) x = -x;
  }
  const double largest = std::fabs(n[largest_axis(n)]);
  for (int i = 0; i < 3; ++i) plane.normal[i] = n[i] / largest;
  return plane;
}

bool GroupPlanes::must_move(VertexId v) const {
  return std::ranges::any_of(planes_at_[v], [&](std::uint32_t g) {
    return planes_[g].lent_state == State::moving &&
           !exactly_on(planes_[g].plane, surface_.vertices()[v]);
  });
}

bool GroupPlanes::release(VertexId v) {
  if (planes_at_[v].empty()) return false;
  return release(v, *std::ranges::min_element(planes_at_[v], [&](std::uint32_t g, std::uint32_t h) {
                   return planes_[g].area != planes_[h].area ? planes_[g].area < planes_[h].area
                                                             : g > h;
                 }));
}

bool GroupPlanes::release_all(VertexId v) {
  bool any = false;
  while (!planes_at_[v].empty()) any |= release(v);
  return any;
}

bool GroupPlanes::release(VertexId v, std::uint32_t plane) {
  Departure departure{triangles_at(v, plane), {}};
  for (const std::uint32_t other : planes_at_[v]) {
    for (const std::uint32_t t : triangles_at(v, other)) {
      departure.groups.push_back(growth_.group_of(t));
    }
  }
  std::erase(planes_at_[v], plane);
  if (departure.triangles.empty()) return false;
  sort_unique(departure.groups);
  departures_.push_back(std::move(departure));
  return true;
}

void GroupPlanes::let_go() {
  constexpr std::size_t kPieces = 4;  // what is bent falls into few, what is noisy into many
  std::map<std::uint32_t, std::vector<std::size_t>> departures_at;
  for (std::size_t n = 0; n < departures_.size(); ++n) {
    for (const std::uint32_t g : departures_[n].groups) departures_at[g].push_back(n);
  }
  for (const auto& [g, at] : departures_at) {
    control_.poll();
    std::vector<std::uint32_t> spared;
    for (const std::size_t n : at) {
      const std::vector<std::uint32_t>& triangles = departures_[n].triangles;
      spared.insert(spared.end(), triangles.begin(), triangles.end());
    }
    sort_unique(spared);
    const std::size_t most =
        1 + growth_.groups()[g].left.size() + (spared.size() + kPieces - 1) / kPieces;
    if (!growth_.take_apart(g, most)) continue;
    for (const std::size_t n : at) departures_[n].triangles.clear();
  }
  for (const Departure& departure : departures_) {
    for (const std::uint32_t t : departure.triangles) {
      if (growth_.is_group(growth_.group_of(t))) growth_.detach(t);
    }
  }
  departures_.clear();
}

bool GroupPlanes::detach_at(VertexId v, std::uint32_t plane) {
  const std::vector<std::uint32_t> here = triangles_at(v, plane);
  for (const std::uint32_t t : here) growth_.detach(t);
  std::erase(planes_at_[v], plane);
  return !here.empty();
}

// In groups of this plane.
std::vector<std::uint32_t> GroupPlanes::triangles_at(VertexId v, std::uint32_t plane) {
  std::vector<std::uint32_t> here;
  for (const std::uint32_t t : surface_.triangles_at(v)) {
    const std::uint32_t g = growth_.group_of(t);
    if (growth_.is_group(g) && plane_of_[g] == plane) here.push_back(t);
  }
  return here;
}

}  // namespace delmesher::planar
