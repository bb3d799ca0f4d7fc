#include "mesher/surface/planar_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"
#include "mesher/predicates/box_tree.h"
#include "mesher/predicates/exact_point.h"
#include "mesher/predicates/predicates.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/predicates/vector.h"
#include "mesher/surface/half_edges.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::surface {
namespace {

// A plane in doubles, the largest component of its normal being 1 or -1.
struct Fit {
  Vec3 normal{0, 0, 0};
  Vec3 through{0, 0, 0};

  double height(const Vec3& p) const { return dot(normal, subtract(p, through)) / norm(normal); }
};

int largest_axis(const Vec3& v) {
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::fabs(v[i]) > std::fabs(v[axis])) axis = i;
  }
  return axis;
}

// From the sum of area vectors, whose error does not grow with the length of a narrow group: what
// the noise of a long edge adds to it is perpendicular to that edge.
class Growing {
 public:
  explicit Growing(const std::vector<Vec3>& vertices) : vertices_(&vertices) {}

  void add(const std::array<std::uint32_t, 3>& t) {
    const Vec3 &a = (*vertices_)[t[0]], &b = (*vertices_)[t[1]], &c = (*vertices_)[t[2]];
    const Vec3 area = cross(subtract(b, a), subtract(c, a));
    const double weight = norm(area);
    if (count_ == 0) origin_ = a;
    for (int i = 0; i < 3; ++i) {
      area_[i] += area[i];
      moment_[i] += weight * ((a[i] - origin_[i]) + (b[i] - origin_[i]) + (c[i] - origin_[i]));
    }
    weight_ += weight;
    ++count_;
  }
  Fit fit() const {
    Fit f;
    const double largest = std::fabs(area_[largest_axis(area_)]);
    for (int i = 0; i < 3; ++i) {
      f.normal[i] = area_[i] / largest;
      f.through[i] = origin_[i] + moment_[i] / (3 * weight_);
    }
    return f;
  }

 private:
  const std::vector<Vec3>* vertices_;
  Vec3 area_{0, 0, 0}, moment_{0, 0, 0}, origin_{0, 0, 0};
  double weight_ = 0;
  std::uint64_t count_ = 0;
};

Fit rough(const PlaneEquation& plane) {
  return {plane.normal, plane.through[0]};
}

struct Group {
  std::vector<std::uint32_t> triangles;
  PlaneEquation fitted_plane{};  // of its triangles alone
  PlaneEquation plane{};         // and moved so that it contains the pins of its vertices
  std::vector<VertexId> pins;    // if it lends its plane: vertices that stay and that it contains
  double area = 0;
  double noise = 0;     // bound on the distances of its vertices from the plane
  bool fitted = false;  // are plane and area those of the triangles?
  // on_plane: all vertices are on the plane exactly. planar: they are in one plane, whose equation
  // doubles cannot hold; it needs one only if one of its vertices moves for another group.
  enum class State : std::uint8_t { on_plane, planar, moving } state = State::on_plane;
};

bool exactly_on(const PlaneEquation& plane, const Vec3& p) {
  if (plane.spanned) {
    return orient3d_sign(plane.through[0], plane.through[1], plane.through[2], p) == 0;
  }
  Dyadic sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum = sum + Dyadic::from_double(plane.normal[i]) *
                    (Dyadic::from_double(p[i]) - Dyadic::from_double(plane.through[0][i]));
  }
  return sum.sign() == 0;
}

// A few roundings of doubles at the largest coordinate.
double roundings(const Surface& surface) {
  double largest = 0;
  for (const Vec3& v : surface.vertices) {
    for (const double x : v) largest = std::max(largest, std::fabs(x));
  }
  return largest > 0 ? 0x1p-51 * std::ldexp(1.0, std::ilogb(largest)) : 0;
}

class StandInBuilder {
 public:
  StandInBuilder(const Surface& surface, double noise, Control& control)
      : surface_(surface),
        vertices_(surface.vertices),
        triangles_(surface.triangles),
        labels_(surface.labels),
        noise_(noise),
        finest_(roundings(surface)),
        control_(control) {}

  StandIn build() {
    if (!(noise_ > 0)) return {};
    find_neighbours();
    if (!any_nearly_flat()) return {};
    grow_groups();
    // What cannot be certified is taken apart, and the rest tried again. Every round takes a
    // triangle out of a group for good.
    while (true) {
      control_.poll();
      fit_planes();
      if (groups_moving_ == 0) return {};
      share_planes();
      spread_moves();
      if (relieve_vertices()) continue;
      place_vertices();
      if (!certify()) continue;
      return result();
    }
  }

 private:
  // How far a vertex may move along its facets, which planes at small angles make it do.
  static constexpr double kShareOfEdge = 0x1p-6;  // of the shortest edge at the vertex
  // A group that cannot be is taken apart with a bound smaller by this factor, several times.
  static constexpr double kFiner = 0x1p-5;

  void find_neighbours() {
    const HalfEdgeGroups edges(triangles_, vertices_.size());
    opposite_.assign(3 * triangles_.size(), kNone);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges[e];
      DELMESHER_CHECK(h.size() == 2, "the surface must be a manifold");
      opposite_[h[0]] = h[1];
      opposite_[h[1]] = h[0];
    }
    area_.reserve(triangles_.size());
    for (const auto& [a, b, c] : triangles_) {
      area_.push_back(
          cross(subtract(vertices_[b], vertices_[a]), subtract(vertices_[c], vertices_[a])));
      size_.push_back(norm(area_.back()));
    }
  }
  std::int32_t label(std::uint32_t t) const { return t < labels_.size() ? labels_[t] : 0; }
  VertexId across(std::uint32_t h) const { return triangles_[h / 3][(h % 3 + 2) % 3]; }

  // Is there an edge between triangles that are coplanar within the noise, but not exactly? Most
  // surfaces have none, and nothing to be done.
  bool any_nearly_flat() const {
    for (std::uint32_t h = 0; h < opposite_.size(); ++h) {
      const std::uint32_t g = opposite_[h], t = h / 3, u = g / 3;
      if (h > g || label(t) != label(u) || !(dot(area_[t], area_[u]) > 0)) continue;
      const std::uint32_t larger = size_[t] < size_[u] ? u : t;
      const VertexId v = across(larger == t ? g : h);
      const Vec3 offset = subtract(vertices_[v], vertices_[triangles_[larger][0]]);
      if (std::fabs(dot(area_[larger], offset)) > 4 * noise_ * size_[larger]) continue;
      const auto& [a, b, c] = triangles_[larger];
      if (orient3d_sign(vertices_[a], vertices_[b], vertices_[c], vertices_[v]) != 0) return true;
    }
    return false;
  }

  void grow_groups() {
    group_of_.assign(triangles_.size(), kNone);
    std::vector<std::uint32_t> order(triangles_.size());
    std::iota(order.begin(), order.end(), 0U);
    open_.assign(triangles_.size(), 1);
    grow_from(std::move(order), noise_);
    hand_over_needles();
  }

  // A triangle whose apex is within the noise of its longest edge lies in the planes on both sides
  // of it. It goes to the one across that edge, so that the apex comes to lie in both planes, on
  // the edge, and a flip of the edge leaves no trace of the triangle. Else it would have its own
  // height to be resolved.
  void hand_over_needles() {
    std::vector<std::pair<double, std::uint32_t>> needles;  // by length, longest first
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const double length = edge_length(longest_edge(t));
      if (size_[t] <= noise_ * length) needles.emplace_back(-length, t);
    }
    std::sort(needles.begin(), needles.end());
    for (const auto& [length, t] : needles) {
      const std::uint32_t u = opposite_[longest_edge(t)] / 3, from = group_of_[t],
                          to = group_of_[u];
      if (from == to || from == kNone || to == kNone || label(t) != label(u)) continue;
      Growing sum(vertices_);
      for (const std::uint32_t member : groups_[to].triangles) sum.add(triangles_[member]);
      if (!within(t, sum.fit(), noise_)) continue;
      detach(t);
      group_of_[t] = to;
      std::vector<std::uint32_t>& members = groups_[to].triangles;
      members.insert(std::lower_bound(members.begin(), members.end(), t), t);
    }
  }
  std::uint32_t longest_edge(std::uint32_t t) const {
    std::uint32_t longest = 3 * t;
    for (const std::uint32_t h : {3 * t + 1, 3 * t + 2}) {
      if (edge_length(h) > edge_length(longest)) longest = h;
    }
    return longest;
  }
  double edge_length(std::uint32_t h) const {
    const auto& t = triangles_[h / 3];
    return distance(vertices_[t[h % 3]], vertices_[t[(h % 3 + 1) % 3]]);
  }
  void grow_from(std::vector<std::uint32_t> seeds, double noise) {
    std::sort(seeds.begin(), seeds.end(), [&](std::uint32_t t, std::uint32_t u) {
      return size_[t] != size_[u] ? size_[t] > size_[u] : t < u;
    });
    for (const std::uint32_t t : seeds) {
      control_.poll();
      if (open_[t] != 0 && size_[t] > 0) grow(t, noise);
    }
  }

  // The largest neighbours first. A triangle joins if it is within the bound of the plane that it
  // helps to find: that of a small seed says nothing about places far away. Whenever the group has
  // doubled, all of it is asked; if it has become a bent one, it goes back to what it was and takes
  // only what is within the bound of that plane.
  void grow(std::uint32_t seed, double noise) {
    const auto id = static_cast<std::uint32_t>(groups_.size());
    groups_.emplace_back();
    groups_.back().noise = noise;
    std::vector<std::uint32_t>& members = groups_.back().triangles;
    const auto smaller = [&](std::uint32_t h, std::uint32_t g) {
      return size_[h / 3] != size_[g / 3] ? size_[h / 3] < size_[g / 3] : h > g;
    };
    std::vector<std::uint32_t> heap, refused;  // half-edges of triangles outside
    const auto push = [&](std::uint32_t h) {
      heap.push_back(h);
      std::push_heap(heap.begin(), heap.end(), smaller);
    };
    const auto push_neighbours = [&](std::uint32_t t) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t g = opposite_[h];
        if (open_[g / 3] != 0 && label(g / 3) == label(t)) push(g);
      }
    };
    const auto join = [&](std::uint32_t t) {
      group_of_[t] = id;
      open_[t] = 0;
      members.push_back(t);
      push_neighbours(t);
    };
    Growing sum(vertices_);
    sum.add(triangles_[seed]);
    join(seed);
    std::size_t verified = 1;
    Fit fixed = sum.fit();
    bool bent = false;
    const auto verify = [&] {
      const Fit fit = sum.fit();
      const auto inside = [&](std::uint32_t t) { return fits(t, fit, noise); };
      if (std::ranges::all_of(members, inside)) {
        verified = members.size();
        fixed = fit;
        for (const std::uint32_t h : refused) push(h);
        refused.clear();
        return;
      }
      bent = true;
      for (std::size_t n = verified; n < members.size(); ++n) {
        group_of_[members[n]] = kNone;
        open_[members[n]] = 1;
      }
      members.resize(verified);
      heap.clear();
      for (const std::uint32_t t : std::vector<std::uint32_t>(members)) push_neighbours(t);
    };
    while (!heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), smaller);
      const std::uint32_t h = heap.back(), t = h / 3;
      heap.pop_back();
      if (open_[t] == 0) continue;
      if (bent) {
        if (fits(t, fixed, noise)) join(t);
        continue;
      }
      Growing with = sum;
      with.add(triangles_[t]);
      if (fits(t, with.fit(), noise)) {
        sum = with;
        join(t);
      } else {
        refused.push_back(h);
      }
      const bool doubled = members.size() >= 2 * verified;
      if (doubled || (heap.empty() && members.size() > verified)) verify();
    }
    std::sort(members.begin(), members.end());
  }
  bool fits(std::uint32_t t, const Fit& fit, double noise) const {
    return dot(area_[t], fit.normal) > 0 && within(t, fit, noise);
  }
  bool within(std::uint32_t t, const Fit& fit, double noise) const {
    return std::ranges::all_of(
        triangles_[t], [&](VertexId v) { return std::fabs(fit.height(vertices_[v])) <= noise; });
  }

  // ---- planes

  // In groups of smaller bounds, if it is not yet of the smallest.
  bool take_apart(std::uint32_t g) {
    const double noise = groups_[g].noise * kFiner;
    if (!(noise >= finest_)) return false;
    const std::vector<std::uint32_t> members = std::move(groups_[g].triangles);
    groups_[g].triangles.clear();
    for (const std::uint32_t t : members) {
      group_of_[t] = kNone;
      open_[t] = 1;
    }
    grow_from(members, noise);
    for (const std::uint32_t t : members) open_[t] = 0;
    return true;
  }

  // Takes a triangle out of its group: it is a facet of its own from now on.
  void detach(std::uint32_t t) {
    std::vector<std::uint32_t>& members = groups_[group_of_[t]].triangles;
    members.erase(std::lower_bound(members.begin(), members.end(), t));
    groups_[group_of_[t]].fitted = false;
    group_of_[t] = kNone;
  }
  bool is_group(std::uint32_t g) const { return g != kNone && groups_[g].triangles.size() > 1; }

  std::vector<VertexId> vertices_of(const Group& group) const {
    std::vector<VertexId> list;
    for (const std::uint32_t t : group.triangles) {
      list.insert(list.end(), triangles_[t].begin(), triangles_[t].end());
    }
    sort_unique(list);
    return list;
  }

  void fit_planes() {
    groups_moving_ = 0;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!is_group(g)) continue;
      if (!groups_[g].fitted) fit(groups_[g]);
      if (is_group(g) && groups_[g].state == Group::State::moving) ++groups_moving_;
    }
  }
  void fit(Group& group) {
    Growing sum(vertices_);
    group.area = 0;
    for (const std::uint32_t t : group.triangles) {
      sum.add(triangles_[t]);
      group.area += size_[t];
    }
    const std::vector<VertexId> list = vertices_of(group);
    group.plane = group.fitted_plane = plane_of(sum.fit(), group, list);
    group.state = Group::State::moving;
    if (all_on(group.plane, list)) {
      group.state = Group::State::on_plane;
    } else if (in_one_plane(group, list)) {
      group.state = Group::State::planar;
    }
    // Vertices that the growing plane had left behind.
    const Fit fit = rough(group.plane);
    const auto far = [&](VertexId v) { return std::fabs(fit.height(vertices_[v])) > group.noise; };
    for (std::size_t i = group.triangles.size(); i-- > 0;) {
      const std::uint32_t t = group.triangles[i];
      if (std::ranges::any_of(triangles_[t], far)) detach(t);
    }
    group.fitted = true;
  }
  bool all_on(const PlaneEquation& plane, const std::vector<VertexId>& list) const {
    return std::ranges::all_of(list, [&](VertexId v) { return exactly_on(plane, vertices_[v]); });
  }
  std::uint32_t largest_triangle(const Group& group) const {
    return *std::ranges::max_element(group.triangles, {},
                                     [&](std::uint32_t t) { return size_[t]; });
  }
  bool in_one_plane(const Group& group, const std::vector<VertexId>& list) const {
    const auto& [a, b, c] = triangles_[largest_triangle(group)];
    return std::ranges::all_of(list, [&, a = a, b = b, c = c](VertexId v) {
      return orient3d_sign(vertices_[a], vertices_[b], vertices_[c], vertices_[v]) == 0;
    });
  }
  // The plane as it was meant, if one of short coordinates contains all vertices: nothing moves.
  PlaneEquation plane_of(const Fit& fit, const Group& group,
                         const std::vector<VertexId>& list) const {
    PlaneEquation plane{area_[largest_triangle(group)], {vertices_[list.front()]}};
    if (all_on(plane, list)) return plane;
    for (const int bits : {0, 3, 12, 26}) {
      plane.normal = fit.normal;
      for (double& x : plane.normal) x = std::ldexp(std::round(std::ldexp(x, bits)), -bits);
      if (all_on(plane, list)) return plane;
    }
    return {fit.normal, {fit.through}};
  }

  // Groups that meet at a vertex in planes that are the same within the noise share one of them,
  // the larger group's.
  void share_planes() {
    planes_at_.assign(vertices_.size(), {});
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!is_group(g)) continue;
      for (const VertexId v : vertices_of(groups_[g])) planes_at_[v].push_back(g);
    }
    DisjointSets same(groups_.size());
    for (const std::vector<std::uint32_t>& at : planes_at_) {
      for (std::size_t i = 0; i < at.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          if (same.find(at[i]) != same.find(at[j]) && one_plane(at[i], at[j])) {
            same.unite(at[i], at[j]);
          }
        }
      }
    }
    plane_of_.assign(groups_.size(), kNone);
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!is_group(g)) continue;
      const std::uint32_t root = same.find(g);
      if (plane_of_[root] == kNone || groups_[g].area > groups_[plane_of_[root]].area) {
        plane_of_[root] = g;
      }
    }
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (is_group(g)) plane_of_[g] = plane_of_[same.find(g)];
    }
    for (std::vector<std::uint32_t>& at : planes_at_) {
      for (std::uint32_t& g : at) g = plane_of_[g];
      sort_unique(at);
    }
    for (Group& group : groups_) {
      group.plane = group.fitted_plane;
      group.pins.clear();
    }
  }
  bool one_plane(std::uint32_t g, std::uint32_t h) const {
    const Fit a = rough(groups_[g].plane), b = rough(groups_[h].plane);
    const std::size_t axis = static_cast<std::size_t>(largest_axis(a.normal));
    const double side = a.normal[axis] * b.normal[axis];
    if (!(std::fabs(side) > 0.5)) return false;
    const auto on = [&](const Fit& fit, std::uint32_t other) {
      return std::ranges::all_of(groups_[other].triangles, [&](std::uint32_t t) {
        return std::ranges::all_of(triangles_[t], [&](VertexId v) {
          return std::fabs(fit.height(vertices_[v])) <=
                 std::min(groups_[g].noise, groups_[h].noise);
        });
      });
    };
    return on(a, h) && on(b, g);
  }

  // A planar group one of whose vertices moves has to move with it.
  void spread_moves() {
    for (bool again = true; again;) {
      again = false;
      for (VertexId v = 0; v < planes_at_.size(); ++v) {
        if (!must_move(v)) continue;
        for (const std::uint32_t g : planes_at_[v]) {
          if (groups_[g].state != Group::State::planar) continue;
          groups_[g].state = Group::State::moving;
          again = true;
        }
      }
    }
  }

  // A vertex can be the meeting point of three planes. One of more stays where it is, and the
  // planes are moved so that they contain it, which each can for up to three vertices; where one
  // cannot, its groups give up their triangles at the vertex.
  bool relieve_vertices() {
    std::vector<std::vector<std::uint32_t>> sharing(groups_.size());
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (is_group(g)) sharing[plane_of_[g]].push_back(g);
    }
    bool any = false;
    // A plane that is moved for one vertex may leave another behind.
    for (bool again = true; again && !any;) {
      again = false;
      for (VertexId v = 0; v < planes_at_.size(); ++v) {
        if (planes_at_[v].size() <= 3 || !must_move(v)) continue;
        for (const std::uint32_t g : std::vector<std::uint32_t>(planes_at_[v])) {
          if (groups_[g].state != Group::State::moving ||
              exactly_on(groups_[g].plane, vertices_[v])) {
            continue;
          }
          const bool pinned = pin(v, g, sharing[g]);
          again = again || pinned;
          any = (!pinned && detach_at(v, g)) || any;
        }
      }
    }
    return any;
  }
  // Moves the plane so that it contains the vertex, and those that it was moved for before.
  bool pin(VertexId v, std::uint32_t g, const std::vector<std::uint32_t>& sharing) {
    Group& group = groups_[g];
    if (group.pins.size() == 3) return false;
    group.pins.push_back(v);
    const PlaneEquation before = group.plane;
    group.plane = pinned_plane(group);
    const Fit fit = rough(group.plane);
    const bool near = std::ranges::all_of(sharing, [&](std::uint32_t other) {
      return std::ranges::all_of(groups_[other].triangles, [&](std::uint32_t t) {
        return within(t, fit, 2 * groups_[other].noise);
      });
    });
    const auto contains = [&](VertexId w) { return exactly_on(group.plane, vertices_[w]); };
    if (near && std::ranges::all_of(group.pins, contains)) return true;
    group.plane = before;
    group.pins.pop_back();
    return false;
  }
  PlaneEquation pinned_plane(const Group& group) const {
    const std::vector<VertexId>& pins = group.pins;
    const Vec3& normal = group.fitted_plane.normal;
    const Vec3& a = vertices_[pins[0]];
    if (pins.size() == 1) return {normal, {a}};
    PlaneEquation plane{normal, {a, vertices_[pins[1]], {}}, true};
    plane.through[2] = pins.size() == 3 ? vertices_[pins[2]]
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
  bool must_move(VertexId v) const {
    return std::ranges::any_of(planes_at_[v], [&](std::uint32_t g) {
      return groups_[g].state == Group::State::moving &&
             !exactly_on(groups_[g].plane, vertices_[v]);
    });
  }
  // Of the plane with the least area there.
  bool release(VertexId v) {
    if (planes_at_[v].empty()) return false;
    return release(
        v, *std::ranges::min_element(planes_at_[v], [&](std::uint32_t g, std::uint32_t h) {
          return groups_[g].area != groups_[h].area ? groups_[g].area < groups_[h].area : g > h;
        }));
  }
  // Takes apart the groups of the plane at v, or takes the triangles at v out of them.
  bool release(VertexId v, std::uint32_t plane) {
    bool any = false;
    for (const std::uint32_t t : triangles_at(v, plane)) {
      const std::uint32_t g = group_of_[t];
      any |= g < plane_of_.size() && is_group(g) && take_apart(g);
    }
    return detach_at(v, plane) || any;
  }
  bool detach_at(VertexId v, std::uint32_t plane) {
    const std::vector<std::uint32_t> here = triangles_at(v, plane);
    for (const std::uint32_t t : here) detach(t);
    std::erase(planes_at_[v], plane);
    return !here.empty();
  }
  // In groups of this plane.
  std::vector<std::uint32_t> triangles_at(VertexId v, std::uint32_t plane) {
    std::vector<std::uint32_t> here;
    for_triangles_at(v, [&](std::uint32_t t) {
      const std::uint32_t g = group_of_[t];
      if (is_group(g) && g < plane_of_.size() && plane_of_[g] == plane) here.push_back(t);
    });
    return here;
  }
  template <class Visit>
  void for_triangles_at(VertexId v, Visit visit) {
    if (begin_.empty()) {
      begin_.assign(vertices_.size() + 1, 0);
      for (const auto& t : triangles_) {
        for (const VertexId w : t) ++begin_[w + 1];
      }
      std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
      around_.resize(begin_.back());
      std::vector<std::size_t> cursor(begin_.begin(), begin_.end() - 1);
      for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        for (const VertexId w : triangles_[t]) around_[cursor[w]++] = t;
      }
    }
    for (std::size_t i = begin_[v]; i < begin_[v + 1]; ++i) visit(around_[i]);
  }

  // ---- places

  void place_vertices() {
    stand_in_ = {};
    stand_in_.planes_of.assign(vertices_.size(), {kNone, kNone, kNone});
    std::vector<std::uint32_t> number(groups_.size(), kNone);
    const auto number_of = [&](std::uint32_t g) {
      if (number[g] == kNone) number[g] = add_plane(groups_[g].plane);
      return number[g];
    };
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      if (planes_at_[v].empty() || !must_move(v)) continue;
      std::array<std::uint32_t, 3>& planes = stand_in_.planes_of[v];
      std::vector<Vec3> normals;
      for (const std::uint32_t g : planes_at_[v]) {
        planes[normals.size()] = number_of(g);
        normals.push_back(groups_[g].plane.normal);
      }
      // Planes through the vertex that are about perpendicular to what remains.
      for (const int axis : axes_left(normals)) {
        Vec3 unit{0, 0, 0};
        unit[axis] = 1;
        planes[normals.size()] = add_plane({unit, {vertices_[v]}});
        normals.push_back(unit);
      }
    }
  }
  std::uint32_t add_plane(const PlaneEquation& plane) {
    stand_in_.planes.push_back(plane);
    return static_cast<std::uint32_t>(stand_in_.planes.size() - 1);
  }
  static std::vector<int> axes_left(const std::vector<Vec3>& normals) {
    if (normals.size() >= 3) return {};
    if (normals.size() == 2) return {largest_axis(cross(normals[0], normals[1]))};
    const int axis = largest_axis(normals[0]);
    return {(axis + 1) % 3, (axis + 2) % 3};
  }

  // ---- certificate

  // Is the stand-in a valid surface with planar groups, and near? If not, takes triangles out of
  // groups where it is not.
  bool certify() {
    bool good = true;
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      const auto& p = stand_in_.planes_of[v];
      if (p[0] != kNone && parallel(p)) good = !release(v) && good;
    }
    if (!good) return false;
    PointStore points;
    add_vertices(surface_, stand_in_, points);
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      if (points.is_explicit(v)) continue;
      const double moved = distance(points.nearest(v), vertices_[v]);
      if (!(moved <= kShareOfEdge * shortest_edge(v))) good = !release(v) && good;
      stand_in_.displacement = std::max(stand_in_.displacement, moved);
    }
    if (!good) return false;
    Predicates predicates(points);
    return keeps_orientations(predicates) && meets_nothing_new(predicates);
  }
  bool parallel(const std::array<std::uint32_t, 3>& p) const {
    const auto n = [&](std::size_t i) { return stand_in_.planes[p[i]].normal; };
    return !(std::fabs(dot(n(0), cross(n(1), n(2)))) > 0x1p-30);
  }
  double shortest_edge(VertexId v) {
    double shortest = HUGE_VAL;
    for_triangles_at(v, [&](std::uint32_t t) {
      for (const VertexId w : triangles_[t]) {
        if (w != v) shortest = std::min(shortest, distance(vertices_[v], vertices_[w]));
      }
    });
    return shortest;
  }

  bool keeps_orientations(Predicates& predicates) {
    flat_ = triangles_;
    twin_ = opposite_;
    flipped_.clear();
    std::vector<std::uint32_t> turned, flat;
    projections_.assign(triangles_.size(), {});
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      const std::uint32_t g = group_of_[t];
      if (!is_group(g)) {
        projections_[t] = find_projection(predicates, triangles_[t]);
        if (projections_[t].sign == 0) flat.push_back(t);
        continue;
      }
      const Vec3& normal = groups_[plane_of_[g]].plane.normal;
      const int axis = largest_axis(normal);
      // Groups on either side of a shared plane have opposite orientations.
      const int sign = dot(normal, groups_[g].plane.normal) > 0 ? (normal[axis] > 0 ? 1 : -1)
                                                                : (normal[axis] > 0 ? -1 : 1);
      projections_[t] = {axis, sign};
      if (!positive(predicates, t)) turned.push_back(t);
    }
    // A flip may make room for the next.
    for (bool again = true; again;) {
      again = false;
      std::erase_if(turned, [&](std::uint32_t t) {
        const bool done = positive(predicates, t) || flip_edge_of(predicates, t);
        again = again || done;
        return done;
      });
    }
    for (const std::uint32_t t : turned) detach(t);
    bool released = false;
    for (const std::uint32_t t : flat) released = release_around(t) || released;
    return turned.empty() && !released;
  }
  bool positive(Predicates& predicates, std::uint32_t t) const {
    return positive(predicates, projections_[t], flat_[t]);
  }
  static bool positive(Predicates& predicates, const Projection& projection,
                       const std::array<VertexId, 3>& t) {
    return predicates.orient2d(projection.axis, t[0], t[1], t[2]) == projection.sign;
  }

  // A triangle that is thinner than the noise may be turned over when its corners move within the
  // plane. Across one of its edges the facet then has another triangulation, which is as good.
  bool flip_edge_of(Predicates& predicates, std::uint32_t t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t g = twin_[3 * t + k], u = g / 3, l = g % 3;
      if (group_of_[u] != group_of_[t]) continue;
      const VertexId a = flat_[t][k], b = flat_[t][(k + 1) % 3], c = flat_[t][(k + 2) % 3],
                     d = flat_[u][(l + 2) % 3];
      const std::array<VertexId, 3> at_a = {a, d, c}, at_b = {d, b, c};
      if (c == d || !positive(predicates, projections_[t], at_a) ||
          !positive(predicates, projections_[t], at_b) || is_edge(c, d)) {
        continue;
      }
      const std::uint32_t bc = twin_[3 * t + (k + 1) % 3], ca = twin_[3 * t + (k + 2) % 3],
                          ad = twin_[3 * u + (l + 1) % 3], db = twin_[3 * u + (l + 2) % 3];
      flat_[t] = at_a;
      flat_[u] = at_b;
      const auto link = [&](std::uint32_t h, std::uint32_t other) {
        twin_[h] = other;
        twin_[other] = h;
      };
      link(3 * t, ad);
      link(3 * t + 2, ca);
      link(3 * u, db);
      link(3 * u + 1, bc);
      link(3 * t + 1, 3 * u + 2);
      flipped_.emplace_back(std::min(c, d), std::max(c, d));
      return true;
    }
    return false;
  }
  // Of the surface as given, or by a flip.
  bool is_edge(VertexId c, VertexId d) {
    bool found =
        std::ranges::find(flipped_, std::pair(std::min(c, d), std::max(c, d))) != flipped_.end();
    for_triangles_at(c, [&](std::uint32_t t) {
      found = found || std::ranges::find(triangles_[t], d) != triangles_[t].end();
    });
    return found;
  }
  // The groups of all neighbours give up their triangles at this one.
  bool release_around(std::uint32_t t) {
    bool any = false;
    for (const VertexId v : triangles_[t]) {
      if (stand_in_.planes_of[v][0] == kNone) continue;
      while (!planes_at_[v].empty()) any |= release(v);
    }
    return any;
  }

  bool meets_nothing_new(Predicates& predicates) {
    const PointStore& points = predicates.points();
    std::vector<Box> boxes;
    boxes.reserve(flat_.size());
    for (const auto& t : flat_) boxes.push_back(enclosing_box(points, t));
    std::vector<std::uint32_t> meeting;
    const auto moved = [&](std::uint32_t t) {
      return std::ranges::any_of(flat_[t], [&](VertexId v) { return !points.is_explicit(v); });
    };
    BoxTree(boxes).pairs([&](std::uint32_t t, std::uint32_t u) {
      control_.poll();
      if (!moved(t) && !moved(u)) return true;
      if (meet_outside_shared(predicates, flat_[t], flat_[u], projections_[t], projections_[u])) {
        meeting.push_back(t);
        meeting.push_back(u);
      }
      return true;
    });
    for (const std::uint32_t t : meeting) {
      if (!release_around(t) && is_group(group_of_[t])) detach(t);
    }
    return meeting.empty();
  }

  // Sets of triangles of one label that are connected by edges that are flat exactly.
  std::uint64_t given_facets() const {
    DisjointSets sets(triangles_.size());
    std::uint64_t facets = triangles_.size();
    for (std::uint32_t h = 0; h < opposite_.size(); ++h) {
      const std::uint32_t g = opposite_[h], t = h / 3, u = g / 3;
      if (h > g || label(t) != label(u) || sets.find(t) == sets.find(u)) continue;
      const auto& [a, b, c] = triangles_[t];
      if (orient3d_sign(vertices_[a], vertices_[b], vertices_[c], vertices_[across(g)]) != 0) {
        continue;
      }
      sets.unite(t, u);
      --facets;
    }
    return facets;
  }

  StandIn result() {
    stand_in_.given_facets = given_facets();
    if (!flipped_.empty()) stand_in_.triangles = std::move(flat_);
    for (const Group& group : groups_) {
      if (group.triangles.size() < 2 || group.state != Group::State::moving) continue;
      ++stand_in_.groups;
      const std::uint32_t g = group_of_[group.triangles.front()];
      const PlaneEquation& plane = groups_[plane_of_[g]].plane;
      const Fit fit = rough(plane);
      for (const VertexId v : vertices_of(group)) {
        stand_in_.deviation = std::max(stand_in_.deviation, std::fabs(fit.height(vertices_[v])));
      }
    }
    return std::move(stand_in_);
  }

  const Surface& surface_;
  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  const std::vector<std::int32_t>& labels_;
  const double noise_, finest_;
  Control& control_;
  std::vector<std::uint32_t> opposite_;
  std::vector<Vec3> area_;          // twice the area vector of each triangle
  std::vector<double> size_;        // twice the area
  std::vector<std::uint8_t> open_;  // triangles that a growing group may take
  std::vector<std::uint32_t> group_of_;
  std::vector<Group> groups_;
  std::uint64_t groups_moving_ = 0;
  std::vector<std::uint32_t> plane_of_;                // group -> the one whose plane it shares
  std::vector<std::vector<std::uint32_t>> planes_at_;  // vertex -> planes, as such groups
  std::vector<std::size_t> begin_;                     // vertex -> range of around_
  std::vector<std::uint32_t> around_;                  // triangles
  // On the stand-in, where some edges are flipped: its triangles, the half-edges opposite to
  // theirs, and the edges made by flips.
  std::vector<std::array<std::uint32_t, 3>> flat_;
  std::vector<std::uint32_t> twin_;
  std::vector<std::pair<VertexId, VertexId>> flipped_;
  std::vector<Projection> projections_;
  StandIn stand_in_;
};

}  // namespace

// Groups grow by half the bound: their planes may yet be moved by the other half.
StandIn find_stand_in(const Surface& surface, double bound, Control& control) {
  return StandInBuilder(surface, bound / 2 * (1 - 0x1p-20), control).build();
}

void add_vertices(const Surface& surface, const StandIn& stand_in, PointStore& points) {
  for (const PlaneEquation& plane : stand_in.planes) points.add_plane(plane);
  points.reserve(surface.vertices.size());
  for (VertexId v = 0; v < surface.vertices.size(); ++v) {
    const Vec3& x = surface.vertices[v];
    if (stand_in.planes_of.empty() || stand_in.planes_of[v][0] == kNone) {
      points.add_explicit(x[0], x[1], x[2]);
    } else {
      const auto& [a, b, c] = stand_in.planes_of[v];
      points.add_on_planes(a, b, c);
    }
  }
}

}  // namespace delmesher::surface
