#include "mesher/planar/planarized_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/base/sort_unique.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/planar/facet_laws.h"
#include "mesher/planar/group_planes.h"
#include "mesher/planar/planar_growth.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::planar {
namespace {

// A few roundings of doubles at the largest coordinate.
double roundings(const Surface& surface) {
  double largest = 0;
  for (const Vec3& v : surface.vertices) {
    for (const double x : v) largest = std::max(largest, std::fabs(x));
  }
  return largest > 0 ? 0x1p-51 * std::ldexp(1.0, std::ilogb(largest)) : 0;
}

// Is v of the earlier store on these planes by definition?
bool is_same(const PointStore& points, const std::array<std::uint32_t, 3>& planes,
             const PointStore& earlier, VertexId v) {
  if (earlier.is_explicit(v)) return false;
  const PointDefinition before = earlier.definition(v);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(points.plane(planes[i]) == earlier.plane(before.corner[i]))) return false;
  }
  return true;
}

class Planarizer {
 public:
  // Groups grow by half the bound: their planes may yet be moved by the other half.
  Planarizer(const Surface& surface, double bound, Control& control, Retriangulate retriangulate)
      : given_(surface),
        bound_(bound),
        may_flip_(retriangulate == Retriangulate::yes),
        vertices_(surface.vertices),
        triangles_(surface.triangles),
        control_(control),
        surface_(surface),
        growth_(surface_, bound / 2 * (1 - 0x1p-20), roundings(surface), control),
        planes_(surface_, growth_, control) {}

  PlanarizedSurface build() {
    if (!growth_.any_nearly_flat()) return {};
    growth_.grow_all();
    growth_.merge_neighbours();
    // Groups that cannot be certified are taken apart, and the rest is tried again. Every round
    // takes a triangle out of a group, or makes the bound of a group smaller.
    while (true) {
      control_.poll();
      if (!planes_.fit()) return {};
      planes_.share();
      planes_.spread_moves();
      if (planes_.relieve_vertices()) continue;
      place_vertices();
      if (certify()) return result();
      planes_.let_go();
    }
  }

 private:
  // How far a vertex may move along its facets, which planes at small angles make it do: a share of
  // the shortest edge at the vertex. Both ends of an edge together move by less than its length.
  // What finds no room shatters the faces around it.
  static constexpr double kShareOfEdge = 0x1p-2;

  bool in_group(std::uint32_t t) const { return growth_.is_group(growth_.group_of(t)); }
  const PlaneEquation& plane_of_triangle(std::uint32_t t) const {
    return planes_.plane(planes_.plane_of(growth_.group_of(t)));
  }

  // ---- places

  void place_vertices() {
    planarized_ = {};
    planarized_.planes_of.assign(vertices_.size(), {kNone, kNone, kNone});
    std::vector<std::uint32_t> number(growth_.groups().size(), kNone);
    const auto number_of = [&](std::uint32_t g) {
      if (number[g] == kNone) number[g] = add_plane(planes_.plane(g));
      return number[g];
    };
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      control_.poll();
      if (planes_.planes_at(v).empty() || !planes_.must_move(v)) continue;
      std::array<std::uint32_t, 3>& planes = planarized_.planes_of[v];
      std::vector<Vec3> normals;
      for (const std::uint32_t g : planes_.planes_at(v)) {
        planes[normals.size()] = number_of(g);
        normals.push_back(planes_.plane(g).normal);
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
    planarized_.planes.push_back(plane);
    return static_cast<std::uint32_t>(planarized_.planes.size() - 1);
  }
  bool moves(VertexId v) const { return planarized_.planes_of[v][0] != kNone; }
  static std::vector<int> axes_left(const std::vector<Vec3>& normals) {
    if (normals.size() >= 3) return {};
    if (normals.size() == 2) return {largest_axis(cross(normals[0], normals[1]))};
    const int axis = largest_axis(normals[0]);
    return {(axis + 1) % 3, (axis + 2) % 3};
  }

  // ---- certificate

  // Is the planarized surface a valid surface with planar groups, and near? If not, takes triangles
  // out of groups where it is not.
  bool certify() {
    bool good = true;
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      const auto& p = planarized_.planes_of[v];
      if (p[0] != kNone && parallel(p)) good = !planes_.release(v) && good;
    }
    if (!good) return false;
    const PointStore earlier = std::exchange(points_, {});
    PointStore& points = points_;
    const std::vector<std::uint8_t> same = add_vertices(given_, planarized_, points, earlier);
    // Most vertices stay where the last attempt had them.
    ++attempt_;
    changed_at_.resize(vertices_.size(), 0);
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      if (same[v] == 0) changed_at_[v] = attempt_;
    }
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      control_.poll();
      if (points.is_explicit(v)) continue;
      const double moved = distance(points.nearest(v), vertices_[v]);
      const double error = 2 * points.approximation(v).error;
      const double most = kShareOfEdge * (1 - 0x1p-40) * shortest_edge(v);
      if (!(moved + error <= most)) good = !planes_.release(v) && good;
      planarized_.displacement = std::max(planarized_.displacement, moved);
    }
    if (!good) return false;
    Predicates predicates(points);
    if (!keeps_orientations(predicates) || !groups_are_planar(predicates)) return false;
    support_groups(points);
    return meets_nothing_new(predicates) && facets_keep_laws(points, predicates);
  }
  // What lies in one plane of a group is not to be computed again: coordinates of points on planes
  // are long.
  void support_groups(PointStore& points) const {
    std::vector<std::pair<VertexId, PlaneId>> on;
    for (std::uint32_t g = 0; g < growth_.groups().size(); ++g) {
      if (!growth_.is_group(g)) continue;
      for (const std::uint32_t t : growth_.groups()[g].triangles) {
        for (const VertexId v : flat_[t]) on.emplace_back(v, g);
      }
    }
    sort_unique(on);
    std::vector<PlaneId> groups;
    for (auto first = on.begin(); first != on.end();) {
      groups.clear();
      const VertexId v = first->first;
      for (; first != on.end() && first->first == v; ++first) groups.push_back(first->second);
      points.set_supports(v, groups, {});
    }
  }
  bool parallel(const std::array<std::uint32_t, 3>& p) const {
    const auto n = [&](std::size_t i) { return planarized_.planes[p[i]].normal; };
    return !(std::fabs(dot(n(0), cross(n(1), n(2)))) > 0x1p-30);
  }
  double shortest_edge(VertexId v) {
    double shortest = HUGE_VAL;
    for (const std::uint32_t t : surface_.triangles_at(v)) {
      for (const VertexId w : triangles_[t]) {
        if (w != v) shortest = std::min(shortest, distance(vertices_[v], vertices_[w]));
      }
    }
    return shortest;
  }

  bool keeps_orientations(Predicates& predicates) {
    flat_ = triangles_;
    twin_ = surface_.opposite();
    flipped_.clear();
    std::vector<std::uint32_t> turned, flat;
    projections_.assign(triangles_.size(), {});
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      control_.poll();
      if (!in_group(t)) {
        projections_[t] = find_projection(predicates, triangles_[t]);
        if (projections_[t].sign == 0) flat.push_back(t);
        continue;
      }
      const Vec3& normal = plane_of_triangle(t).normal;
      const int axis = largest_axis(normal);
      // Groups on either side of a shared plane have opposite orientations.
      const bool same_side = dot(normal, planes_.plane(growth_.group_of(t)).normal) > 0;
      const int sign = (normal[axis] > 0) == same_side ? 1 : -1;
      projections_[t] = {axis, sign};
      if (!positive(predicates, t)) turned.push_back(t);
    }
    // A flip may make room for the next.
    for (bool again = may_flip_; again;) {
      again = false;
      std::erase_if(turned, [&](std::uint32_t t) {
        const bool done = positive(predicates, t) || flip_edge_of(predicates, t);
        again = again || done;
        return done;
      });
    }
    for (const std::uint32_t t : turned) growth_.detach(t);
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
      if (growth_.group_of(u) != growth_.group_of(t)) continue;
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
  // Is cd an edge of the surface as given, or by a flip?
  bool is_edge(VertexId c, VertexId d) {
    bool found =
        std::ranges::find(flipped_, std::pair(std::min(c, d), std::max(c, d))) != flipped_.end();
    for (const std::uint32_t t : surface_.triangles_at(c)) {
      found = found || std::ranges::find(triangles_[t], d) != triangles_[t].end();
    }
    return found;
  }
  // A group that is not in one plane gives up its triangles at the vertices off it.
  bool groups_are_planar(Predicates& predicates) {
    bool good = true;
    planar_at_.resize(growth_.groups().size(), 0);
    for (std::uint32_t g = 0; g < growth_.groups().size(); ++g) {
      if (!growth_.is_group(g)) continue;
      if (is_still_planar(g)) continue;
      const auto [a, b, c] = flat_[growth_.groups()[g].triangles.front()];
      std::vector<std::uint32_t> off;
      for (const std::uint32_t t : growth_.groups()[g].triangles) {
        control_.poll();
        const bool on = std::ranges::all_of(flat_[t], [&, a = a, b = b, c = c](VertexId v) {
          return predicates.orient3d(a, b, c, v) == 0;
        });
        if (!on) off.push_back(t);
      }
      for (const std::uint32_t t : off) growth_.detach(t);
      planar_at_[g] = off.empty() ? attempt_ : 0;
      good = good && off.empty();
    }
    return good;
  }
  // Is it what was seen to be planar, or a part of that, at the same places?
  bool is_still_planar(std::uint32_t g) const {
    return planar_at_[g] > 0 &&
           std::ranges::all_of(growth_.groups()[g].triangles, [&](std::uint32_t t) {
             return std::ranges::all_of(
                 flat_[t], [&](VertexId v) { return changed_at_[v] <= planar_at_[g]; });
           });
  }
  // The groups of all neighbours give up their triangles at this one.
  bool release_around(std::uint32_t t) {
    bool any = false;
    for (const VertexId v : triangles_[t]) {
      if (moves(v)) any |= planes_.release_all(v);
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
      if (!release_around(t) && in_group(t)) growth_.detach(t);
    }
    return meeting.empty();
  }

  // The facets that the planarized surface will have are groups, groups that share a plane, parts
  // of groups that gave up the triangles between them, each with whatever else lies in its plane
  // beside it. All promises about them are checked once more, exactly.
  bool facets_keep_laws(PointStore& points, Predicates& predicates) {
    const ChangedSurface changed{given_, surface_.opposite(), flat_, twin_};
    std::vector<std::uint32_t> against;
    std::vector<std::uint8_t> flattened(vertices_.size(), 0);
    for (const std::vector<std::uint32_t>& facet : facets_of(changed, predicates)) {
      control_.poll();
      if (facet.size() == 1) continue;
      bool any_moves = false;
      for (const std::uint32_t t : facet) {
        for (const VertexId v : flat_[t]) {
          flattened[v] = 1;
          any_moves = any_moves || moves(v);
        }
      }
      if (!any_moves) continue;
      const std::vector<std::uint32_t> wrong =
          keeps_outline(changed, facet) ? far_from_plane(changed, facet, bound_, points) : facet;
      against.insert(against.end(), wrong.begin(), wrong.end());
    }
    bool good = against.empty();
    for (const std::uint32_t t : against) {
      if (in_group(t)) {
        growth_.detach(t);
      } else {
        release_around(t);
      }
    }
    for (VertexId v = 0; v < vertices_.size(); ++v) {
      if (moves(v) && flattened[v] == 0) good = !planes_.release_all(v) && good;
    }
    return good;
  }

  std::uint64_t given_facets() const {
    PointStore points;
    add_vertices(given_, {}, points);
    Predicates predicates(points);
    const std::vector<std::uint32_t>& opposite = surface_.opposite();
    return facets_of({given_, opposite, triangles_, opposite}, predicates).size();
  }

  PlanarizedSurface result() {
    planarized_.given_facets = given_facets();
    if (!flipped_.empty()) planarized_.triangles = std::move(flat_);
    for (std::uint32_t g = 0; g < growth_.groups().size(); ++g) {
      if (!growth_.is_group(g) || !planes_.moving(g)) continue;
      const PlaneEquation& plane = planes_.plane(planes_.plane_of(g));
      const std::vector<VertexId> list = growth_.vertices_of(g);
      if (std::ranges::all_of(list, [&](VertexId v) { return exactly_on(plane, vertices_[v]); })) {
        continue;
      }
      ++planarized_.groups;
      const Fit fit = rough(plane);
      for (const VertexId v : list) {
        planarized_.deviation =
            std::max(planarized_.deviation, std::fabs(fit.height(vertices_[v])));
      }
    }
    return std::move(planarized_);
  }

  const Surface& given_;
  const double bound_;
  const bool may_flip_;
  const std::vector<Vec3>& vertices_;
  const std::vector<std::array<std::uint32_t, 3>>& triangles_;
  Control& control_;
  MeasuredSurface surface_;
  PlanarGrowth growth_;
  GroupPlanes planes_;
  // On the planarized surface, where some edges are flipped: its triangles, the half-edges opposite
  // to theirs, and the edges made by flips.
  std::vector<std::array<std::uint32_t, 3>> flat_;
  std::vector<std::uint32_t> twin_;
  std::vector<std::pair<VertexId, VertexId>> flipped_;
  std::vector<Projection> projections_;
  // Attempts count from 1: the points of the last one, when they last changed, and when groups were
  // last seen to be planar (0: never).
  PointStore points_;
  std::uint32_t attempt_ = 0;
  std::vector<std::uint32_t> changed_at_, planar_at_;
  PlanarizedSurface planarized_;
};

}  // namespace

PlanarizedSurface planarize(const Surface& surface, double bound, Control& control,
                            Retriangulate retriangulate) {
  PlanarizedSurface planarized;
  if (bound > 0) planarized = Planarizer(surface, bound, control, retriangulate).build();
  planarized.bound = bound;
  return planarized;
}

std::vector<std::uint8_t> add_vertices(const Surface& surface, const PlanarizedSurface& planarized,
                                       PointStore& points, const PointStore& earlier) {
  std::vector<std::uint8_t> same(surface.vertices.size(), 0);
  for (const PlaneEquation& plane : planarized.planes) points.add_plane(plane);
  points.reserve(surface.vertices.size());
  for (VertexId v = 0; v < surface.vertices.size(); ++v) {
    const Vec3& x = surface.vertices[v];
    if (planarized.planes_of.empty() || planarized.planes_of[v][0] == kNone) {
      points.add_explicit(x[0], x[1], x[2]);
      same[v] = v < earlier.size() && earlier.is_explicit(v);
      continue;
    }
    const auto& [a, b, c] = planarized.planes_of[v];
    same[v] = v < earlier.size() && is_same(points, {a, b, c}, earlier, v);
    if (same[v] != 0) {
      points.add_on_planes(a, b, c, earlier, v);
    } else {
      points.add_on_planes(a, b, c);
    }
  }
  return same;
}

SurfaceTopology planarized_topology(const Surface& surface, const PlanarizedSurface& planarized,
                                    PointStore& points, Predicates& predicates) {
  add_vertices(surface, planarized, points);
  if (planarized.triangles.empty()) return build_topology(surface, points, predicates);
  return build_topology({surface.vertices, planarized.triangles, surface.labels}, points,
                        predicates);
}

}  // namespace delmesher::planar
