#include "mesher/planar/planar_growth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "mesher/arithmetic/bounded.h"
#include "mesher/base/check.h"
#include "mesher/base/disjoint_sets.h"
#include "mesher/base/sort_unique.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::planar {
namespace {

// A group that cannot be is taken apart with a bound smaller by this factor, several times.
constexpr double kFiner = 0x1p-5;

}  // namespace

int largest_axis(const Vec3& v) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::fabs(v[i]) > std::fabs(v[axis])) axis = i;
  }
  return axis;
}

void PlaneFit::Sum::add(double x) {
  double tail = 0;
  arithmetic::two_sum(high, x, high, tail);
  low += tail;
}

void PlaneFit::add(const std::array<std::uint32_t, 3>& t) {
  const Vec3 &a = (*vertices_)[t[0]], &b = (*vertices_)[t[1]], &c = (*vertices_)[t[2]];
  const Vec3 area = cross(subtract(b, a), subtract(c, a));
  const double weight = norm(area);
  if (count_ == 0) origin_ = a;
  for (int i = 0; i < 3; ++i) {
    area_[i].add(area[i]);
    moment_[i].add(weight * ((a[i] - origin_[i]) + (b[i] - origin_[i]) + (c[i] - origin_[i])));
  }
  weight_ += weight;
  ++count_;
}

void PlaneFit::add(const PlaneFit& other) {
  if (count_ == 0) {
    *this = other;
    return;
  }
  for (int i = 0; i < 3; ++i) {
    area_[i].add(other.area_[i].high);
    area_[i].add(other.area_[i].low);
    moment_[i].add(other.moment_[i].high);
    moment_[i].add(other.moment_[i].low);
    moment_[i].add(3 * other.weight_ * (other.origin_[i] - origin_[i]));
  }
  weight_ += other.weight_;
  count_ += other.count_;
}

Fit PlaneFit::fit() const {
  Fit f;
  Vec3 area{0, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) area[i] = area_[i].high + area_[i].low;
  const double largest = std::fabs(area[largest_axis(area)]);
  for (std::size_t i = 0; i < 3; ++i) {
    f.normal[i] = area[i] / largest;
    f.through[i] = origin_[i] + (moment_[i].high + moment_[i].low) / (3 * weight_);
  }
  return f;
}

MeasuredSurface::MeasuredSurface(const Surface& surface)
    : surface_(surface), opposite_(3 * surface.triangles.size(), kNone) {
  const HalfEdgeGroups edges(triangles(), vertices().size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges[e];
    DELMESHER_CHECK(h.size() == 2, "an edge of a valid surface does not have two triangles");
    opposite_[h[0]] = h[1];
    opposite_[h[1]] = h[0];
  }
  area_.reserve(triangles().size());
  size_.reserve(triangles().size());
  for (const auto& [a, b, c] : triangles()) {
    area_.push_back(
        cross(subtract(vertices()[b], vertices()[a]), subtract(vertices()[c], vertices()[a])));
    size_.push_back(norm(area_.back()));
  }
}

std::uint32_t MeasuredSurface::longest_edge(std::uint32_t t) const {
  std::uint32_t longest = 3 * t;
  for (const std::uint32_t h : {3 * t + 1, 3 * t + 2}) {
    if (edge_length(h) > edge_length(longest)) longest = h;
  }
  return longest;
}

bool MeasuredSurface::bends_by_less(std::uint32_t h, double most) const {
  const std::uint32_t g = opposite_[h], t = h / 3, u = g / 3;
  if (!(dot(area(t), area(u)) > 0)) return false;
  const std::uint32_t larger = size(t) < size(u) ? u : t;
  const Vec3 offset =
      subtract(vertices()[across(larger == t ? g : h)], vertices()[triangles()[larger][0]]);
  return std::fabs(dot(area(larger), offset)) <= most * size(larger);
}

double MeasuredSurface::edge_length(std::uint32_t h) const {
  const auto& t = triangles()[h / 3];
  return distance(vertices()[t[h % 3]], vertices()[t[(h % 3 + 1) % 3]]);
}

std::span<const std::uint32_t> MeasuredSurface::triangles_at(VertexId v) {
  if (begin_.empty()) {
    begin_.assign(vertices().size() + 1, 0);
    for (const auto& t : triangles()) {
      for (const VertexId w : t) ++begin_[w + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    around_.resize(begin_.back());
    std::vector<std::size_t> cursor(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t t = 0; t < triangles().size(); ++t) {
      for (const VertexId w : triangles()[t]) around_[cursor[w]++] = t;
    }
  }
  return std::span(around_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
}

PlanarGrowth::PlanarGrowth(const MeasuredSurface& surface, double noise, double finest,
                           Control& control)
    : surface_(surface),
      noise_(noise),
      finest_(finest),
      control_(control),
      open_(surface.triangles().size(), 1),
      group_of_(surface.triangles().size(), kNone) {}

bool PlanarGrowth::any_nearly_flat() const {
  const std::vector<Vec3>& x = surface_.vertices();
  for (std::uint32_t h = 0; h < surface_.opposite().size(); ++h) {
    const std::uint32_t g = surface_.opposite()[h], t = h / 3;
    if (h > g || surface_.label(t) != surface_.label(g / 3)) continue;
    if (!surface_.bends_by_less(h, 4 * noise_)) continue;
    const auto& [a, b, c] = surface_.triangles()[t];
    if (orient3d_sign(x[a], x[b], x[c], x[surface_.across(g)]) != 0) return true;
  }
  return false;
}

void PlanarGrowth::grow_all() {
  std::vector<std::uint32_t> order(surface_.triangles().size());
  std::iota(order.begin(), order.end(), 0U);
  grow_from(std::move(order), noise_);
  hand_over_needles();
}

// A needle is a triangle whose third vertex is within the noise of its longest edge, so that it
// lies in the planes on both sides of that edge. It goes to the one across: then the vertex comes
// to lie in both planes, on the edge, and a flip of the edge leaves no trace of the triangle. Else
// it would have its own height to be resolved.
void PlanarGrowth::hand_over_needles() {
  std::vector<std::pair<double, std::uint32_t>> needles;  // by length, longest first
  for (std::uint32_t t = 0; t < surface_.triangles().size(); ++t) {
    const double length = surface_.edge_length(surface_.longest_edge(t));
    if (surface_.size(t) <= noise_ * length) needles.emplace_back(-length, t);
  }
  std::sort(needles.begin(), needles.end());
  for (const auto& [length, t] : needles) {
    const std::uint32_t u = surface_.opposite()[surface_.longest_edge(t)] / 3, from = group_of_[t],
                        to = group_of_[u];
    if (from == to || from == kNone || to == kNone || surface_.label(t) != surface_.label(u))
      continue;
    PlaneFit sum(surface_.vertices());
    for (const std::uint32_t member : groups_[to].triangles) sum.add(surface_.triangles()[member]);
    if (!within(t, sum.fit(), noise_)) continue;
    remove(t);
    group_of_[t] = to;
    std::vector<std::uint32_t>& members = groups_[to].triangles;
    members.insert(std::lower_bound(members.begin(), members.end(), t), t);
  }
}

// The edges' numbers decide who is first; two that were rejected are tried again once
// one of them has changed.
class PlanarGrowth::Merging {
 public:
  explicit Merging(PlanarGrowth& growth)
      : growth_(growth),
        surface_(growth.surface_),
        whole_(growth.groups_.size()),
        fits_(growth.groups_.size()) {}

  void run() {
    std::vector<std::uint32_t> edges = nearly_flat_edges();
    for (bool again = !edges.empty(); again;) {
      again = false;
      std::erase_if(edges, [&](std::uint32_t h) {
        growth_.control_.poll();
        const std::uint32_t a = group_of(h / 3), b = group_of(surface_.opposite()[h] / 3);
        const bool merged = a != b && merge(a, b);
        again = again || merged;
        return a == b || merged;
      });
    }
    for (Group& group : growth_.groups_) std::sort(group.triangles.begin(), group.triangles.end());
    for (std::uint32_t& g : growth_.group_of_) {
      if (g != kNone) g = whole_.smallest(g);
    }
  }

 private:
  std::uint32_t group_of(std::uint32_t t) { return whole_.smallest(growth_.group_of_[t]); }
  std::vector<std::uint32_t>& members(std::uint32_t g) { return growth_.groups_[g].triangles; }

  // Between two groups. Triangles of one plane bend their edge by no more.
  std::vector<std::uint32_t> nearly_flat_edges() const {
    std::vector<std::uint32_t> edges;
    for (std::uint32_t h = 0; h < surface_.opposite().size(); ++h) {
      const std::uint32_t g = surface_.opposite()[h], t = h / 3, u = g / 3;
      if (h > g || growth_.group_of_[t] == growth_.group_of_[u]) continue;
      if (growth_.group_of_[t] == kNone || growth_.group_of_[u] == kNone) continue;
      if (surface_.label(t) == surface_.label(u) && surface_.bends_by_less(h, 4 * growth_.noise_)) {
        edges.push_back(h);
      }
    }
    return edges;
  }

  bool merge(std::uint32_t a, std::uint32_t b) {
    if (members(a).size() < members(b).size()) std::swap(a, b);
    const std::array<std::size_t, 2> sizes = {members(a).size(), members(b).size()};
    std::array<std::size_t, 2>& refused = refused_[{a, b}];
    if (refused == sizes) return false;
    refused = sizes;
    PlaneFit sum = fit_of(a);
    sum.add(fit_of(b));
    const Fit fit = sum.fit();
    const auto fits = [&](std::uint32_t t) { return growth_.fits(t, fit, growth_.noise_); };
    // The smaller one is the sooner refused.
    if (!std::ranges::all_of(members(b), fits) || !std::ranges::all_of(members(a), fits)) {
      return false;
    }
    whole_.join(a, b);
    const std::uint32_t into = whole_.smallest(a), from = into == a ? b : a;
    fits_[into] = sum;
    members(into).insert(members(into).end(), members(from).begin(), members(from).end());
    members(from).clear();
    return true;
  }
  const PlaneFit& fit_of(std::uint32_t g) {
    if (!fits_[g]) {
      fits_[g].emplace(surface_.vertices());
      for (const std::uint32_t t : members(g)) fits_[g]->add(surface_.triangles()[t]);
    }
    return *fits_[g];
  }

  PlanarGrowth& growth_;
  const MeasuredSurface& surface_;
  DisjointSets whole_;
  std::vector<std::optional<PlaneFit>> fits_;
  std::map<std::array<std::uint32_t, 2>, std::array<std::size_t, 2>> refused_;  // of these sizes
};

void PlanarGrowth::merge_neighbours() {
  Merging(*this).run();
}

void PlanarGrowth::grow_from(std::vector<std::uint32_t> seeds, double noise) {
  std::sort(seeds.begin(), seeds.end(), [&](std::uint32_t t, std::uint32_t u) {
    return surface_.size(t) != surface_.size(u) ? surface_.size(t) > surface_.size(u) : t < u;
  });
  for (const std::uint32_t t : seeds) {
    control_.poll();
    if (open_[t] != 0 && surface_.size(t) > 0) grow(t, noise);
  }
}

// A group while it grows. The largest neighbours come first. A triangle joins if it is within the
// bound of the plane that it helps to find: that of a small seed says nothing about places far
// away. Whenever the group has doubled, all of it is checked; if it has become bent, it goes
// back to its former members and takes only triangles within the bound of that plane.
class PlanarGrowth::Growing {
 public:
  Growing(PlanarGrowth& growth, std::uint32_t id, std::uint32_t seed)
      : growth_(growth),
        surface_(growth.surface_),
        id_(id),
        group_(growth.groups_[id]),
        sum_(surface_.vertices()) {
    sum_.add(surface_.triangles()[seed]);
    join(seed);
    verified_plane_ = sum_.fit();
  }

  void run() {
    while (!heap_.empty()) {
      const std::uint32_t h = pop();
      if (growth_.open_[h / 3] == 0) continue;
      if (bent_) {
        if (growth_.fits(h / 3, verified_plane_, group_.noise)) join(h / 3);
        continue;
      }
      offer(h);
      const bool doubled = members().size() >= 2 * verified_;
      if (doubled || (heap_.empty() && members().size() > verified_)) verify();
    }
    std::sort(members().begin(), members().end());
  }

 private:
  std::vector<std::uint32_t>& members() { return group_.triangles; }

  // A heap of half-edges of triangles outside.
  bool smaller(std::uint32_t h, std::uint32_t g) const {
    const double a = surface_.size(h / 3), b = surface_.size(g / 3);
    return a != b ? a < b : h > g;
  }
  auto order() const {
    return [this](std::uint32_t h, std::uint32_t g) { return smaller(h, g); };
  }
  void push(std::uint32_t h) {
    heap_.push_back(h);
    std::push_heap(heap_.begin(), heap_.end(), order());
  }
  std::uint32_t pop() {
    std::pop_heap(heap_.begin(), heap_.end(), order());
    const std::uint32_t h = heap_.back();
    heap_.pop_back();
    return h;
  }
  void push_neighbours(std::uint32_t t) {
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t u = surface_.opposite()[h] / 3;
      if (growth_.open_[u] != 0 && surface_.label(u) == surface_.label(t)) {
        push(surface_.opposite()[h]);
      }
    }
  }

  void join(std::uint32_t t) {
    growth_.group_of_[t] = id_;
    growth_.open_[t] = 0;
    members().push_back(t);
    push_neighbours(t);
  }
  void offer(std::uint32_t h) {
    PlaneFit with = sum_;
    with.add(surface_.triangles()[h / 3]);
    if (growth_.fits(h / 3, with.fit(), group_.noise)) {
      sum_ = with;
      join(h / 3);
    } else {
      refused_.push_back(h);
    }
  }

  // Do all triangles fit the plane of all? If not, those that joined since this was so leave.
  void verify() {
    const Fit fit = sum_.fit();
    if (std::ranges::all_of(members(),
                            [&](std::uint32_t t) { return growth_.fits(t, fit, group_.noise); })) {
      verified_ = members().size();
      verified_plane_ = fit;
      for (const std::uint32_t h : refused_) push(h);
      refused_.clear();
      return;
    }
    bent_ = true;
    for (std::size_t n = verified_; n < members().size(); ++n) {
      growth_.group_of_[members()[n]] = kNone;
      growth_.open_[members()[n]] = 1;
    }
    members().resize(verified_);
    heap_.clear();
    for (std::size_t n = 0; n < verified_; ++n) push_neighbours(members()[n]);
  }

  PlanarGrowth& growth_;
  const MeasuredSurface& surface_;
  const std::uint32_t id_;
  Group& group_;
  PlaneFit sum_;  // of the members
  std::vector<std::uint32_t> heap_, refused_;
  std::size_t verified_ = 1;  // so many members, the first ones, fit the plane of all of these
  Fit verified_plane_;        // that plane
  bool bent_ = false;
};

void PlanarGrowth::grow(std::uint32_t seed, double noise) {
  const auto id = static_cast<std::uint32_t>(groups_.size());
  groups_.push_back({.triangles = {}, .noise = noise, .left = {}});
  Growing(*this, id, seed).run();
}

bool PlanarGrowth::fits(std::uint32_t t, const Fit& fit, double noise) const {
  return dot(surface_.area(t), fit.normal) > 0 && within(t, fit, noise);
}

bool PlanarGrowth::within(std::uint32_t t, const Fit& fit, double noise) const {
  return std::ranges::all_of(surface_.triangles()[t], [&](VertexId v) {
    return std::fabs(fit.height(surface_.vertices()[v])) <= noise;
  });
}

bool PlanarGrowth::take_apart(std::uint32_t g, std::size_t fewer_than) {
  const double noise = groups_[g].noise * kFiner;
  if (!(noise >= finest_)) return false;
  std::vector<std::uint32_t> members = groups_[g].triangles;
  members.insert(members.end(), groups_[g].left.begin(), groups_[g].left.end());
  const std::size_t before = groups_.size();
  for (const std::uint32_t t : members) {
    group_of_[t] = kNone;
    open_[t] = 1;
  }
  grow_from(members, noise);
  for (const std::uint32_t t : members) open_[t] = 0;
  if (groups_.size() - before < fewer_than) {
    groups_[g].triangles.clear();
    groups_[g].left.clear();
    return true;
  }
  groups_.resize(before);
  for (const std::uint32_t t : groups_[g].triangles) group_of_[t] = g;
  for (const std::uint32_t t : groups_[g].left) group_of_[t] = kNone;
  return false;
}

void PlanarGrowth::detach(std::uint32_t t) {
  groups_[group_of_[t]].left.push_back(t);
  remove(t);
}

void PlanarGrowth::remove(std::uint32_t t) {
  std::vector<std::uint32_t>& members = groups_[group_of_[t]].triangles;
  members.erase(std::lower_bound(members.begin(), members.end(), t));
  group_of_[t] = kNone;
}

std::vector<VertexId> PlanarGrowth::vertices_of(std::uint32_t group) const {
  std::vector<VertexId> list;
  for (const std::uint32_t t : groups_[group].triangles) {
    const auto& corners = surface_.triangles()[t];
    list.insert(list.end(), corners.begin(), corners.end());
  }
  sort_unique(list);
  return list;
}

}  // namespace delmesher::planar
