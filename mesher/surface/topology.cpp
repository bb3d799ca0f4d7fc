#include "mesher/surface/topology.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "mesher/base/check.h"
#include "mesher/base/disjoint_sets.h"
#include "mesher/base/sort_unique.h"
#include "mesher/surface/carrier_key.h"
#include "mesher/surface/half_edges.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::surface {
namespace {

// Groups equal keys: class_of[i] is the smallest j whose carrier is verified to be the same as
// i's. A key collision between different carriers only loses an identification.
std::vector<std::uint32_t> classes_of(
    const std::vector<CarrierKey>& keys,
    const std::function<bool(std::uint32_t, std::uint32_t)>& same) {
  std::vector<std::uint32_t> order(keys.size()), class_of(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const auto c = keys[i] <=> keys[j];
    return c != 0 ? c < 0 : i < j;
  });
  std::uint32_t first = kNone;
  for (const std::uint32_t i : order) {
    if (first == kNone || keys[first] != keys[i]) first = i;
    class_of[i] = i == first || same(first, i) ? first : i;
  }
  return class_of;
}

class Builder {
 public:
  Builder(const Surface& surface, PointStore& points, Predicates& predicates, Rules rules)
      : surface_(surface), points_(points), predicates_(predicates), rules_(rules) {}

  SurfaceTopology build() {
    add_points();
    match_half_edges();
    group_facets();
    classify_planes();
    orient_facets();
    classify_lines();
    record_supports();
    return std::move(topology_);
  }

 private:
  void add_points() {
    if (points_.size() == 0) {
      points_.reserve(surface_.vertices.size());
      for (const auto& [x, y, z] : surface_.vertices) points_.add_explicit(x, y, z);
    }
    DELMESHER_CHECK(points_.size() == surface_.vertices.size(),
                    "a topology is built on a store with other points than its vertices");
    topology_.triangles = surface_.triangles;
    topology_.labels = surface_.labels;
    topology_.labels.resize(surface_.triangles.size(), 0);
  }

  void match_half_edges() {
    SurfaceTopology& s = topology_;
    const HalfEdgeGroups groups(s.triangles, surface_.vertices.size());
    s.opposite.assign(3 * s.triangles.size(), kNone);
    s.edge_of.assign(3 * s.triangles.size(), kNone);
    s.edge_half_edge.reserve(groups.size());
    for (std::size_t e = 0; e < groups.size(); ++e) {
      const auto group = groups[e];
      DELMESHER_CHECK(
          rules_ == Rules::complex || (group.size() == 2 && s.from(group[0]) == s.to(group[1])),
          "an edge of a valid surface does not have two triangles with opposite directions");
      for (std::size_t k = 0; k < group.size(); ++k) {
        s.opposite[group[k]] = group[k + 1 < group.size() ? k + 1 : 0];
        s.edge_of[group[k]] = static_cast<std::uint32_t>(e);
      }
      const auto up =
          std::ranges::find_if(group, [&](std::uint32_t h) { return s.from(h) < s.to(h); });
      s.edge_half_edge.push_back(up != group.end() ? *up : group[0]);
    }
    s.vertex_half_edge.assign(surface_.vertices.size(), kNone);
    for (std::uint32_t h = 0; h < s.opposite.size(); ++h) {
      DELMESHER_CHECK(s.opposite[h] != kNone, "a triangle of a valid surface repeats a vertex");
      if (s.vertex_half_edge[s.from(h)] == kNone) s.vertex_half_edge[s.from(h)] = h;
    }
    if (rules_ == Rules::complex) list_outgoing();
  }

  void list_outgoing() {
    SurfaceTopology& s = topology_;
    s.outgoing_begin.assign(surface_.vertices.size() + 1, 0);
    for (std::uint32_t h = 0; h < s.opposite.size(); ++h) ++s.outgoing_begin[s.from(h) + 1];
    std::partial_sum(s.outgoing_begin.begin(), s.outgoing_begin.end(), s.outgoing_begin.begin());
    std::vector<std::uint32_t> at(s.outgoing_begin.begin(), s.outgoing_begin.end() - 1);
    s.outgoing.resize(s.opposite.size());
    for (std::uint32_t h = 0; h < s.opposite.size(); ++h) s.outgoing[at[s.from(h)]++] = h;
  }

  // Being exactly coplanar is transitive along edges because no triangle is degenerate, so one
  // exact test per edge is enough.
  void group_facets() {
    SurfaceTopology& s = topology_;
    s.edge_is_flat.assign(s.edge_count(), 0);
    DisjointSets sets(s.triangles.size());
    for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
      const auto [h, g] = s.edge_half_edges(e);
      if (s.labels[h / 3] != s.labels[g / 3] || !has_two_sides(h, g)) continue;
      const VertexId c = s.to(SurfaceTopology::next(h)), d = s.to(SurfaceTopology::next(g));
      if (predicates_.orient3d(s.from(h), s.to(h), c, d) != 0) continue;
      s.edge_is_flat[e] = 1;
      sets.join(h / 3, g / 3);
    }
    if (rules_ == Rules::complex) take_apart(sets);
    s.facet_of.resize(s.triangles.size());
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      const std::uint32_t root = sets.smallest(t);  // already numbered
      if (root == t) {
        s.facet_of[t] = static_cast<FacetId>(s.facet_triangles.size());
        s.facet_triangles.emplace_back();
      } else {
        s.facet_of[t] = s.facet_of[root];
      }
      s.facet_triangles[s.facet_of[t]].push_back(t);
    }
  }

  // Are these the only half-edges of their edge, in opposite directions?
  bool has_two_sides(std::uint32_t h, std::uint32_t g) const {
    return h != g && topology_.opposite[g] == h && topology_.from(h) == topology_.to(g);
  }

  // Facets that are on more than one side of a constrained edge have an edge inside.
  void take_apart(DisjointSets& sets) {
    SurfaceTopology& s = topology_;
    std::vector<std::uint8_t> falls_apart(s.triangles.size(), 0);  // by the set's smallest
    std::vector<std::uint32_t> roots;
    for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
      if (s.edge_is_flat[e] != 0) continue;
      roots.clear();
      s.for_each_half_edge(e, [&](std::uint32_t h) {
        roots.push_back(sets.smallest(h / 3));
        return true;
      });
      std::ranges::sort(roots);
      for (std::size_t k = 1; k < roots.size(); ++k) {
        if (roots[k] == roots[k - 1]) falls_apart[roots[k]] = 1;
      }
    }
    DisjointSets whole(s.triangles.size());
    for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
      if (s.edge_is_flat[e] == 0) continue;
      const auto [h, g] = s.edge_half_edges(e);
      if (falls_apart[sets.smallest(h / 3)] != 0) {
        s.edge_is_flat[e] = 0;
      } else {
        whole.join(h / 3, g / 3);
      }
    }
    sets = std::move(whole);
  }

  void classify_planes() {
    SurfaceTopology& s = topology_;
    std::vector<CarrierKey> keys;
    keys.reserve(s.facet_triangles.size());
    for (const auto& triangles : s.facet_triangles) {
      const auto& t = s.triangles[triangles[0]];
      keys.push_back(
          plane_key(points_.nearest(t[0]), points_.nearest(t[1]), points_.nearest(t[2])));
    }
    const auto class_of = classes_of(keys, [&](std::uint32_t f, std::uint32_t g) {
      const auto& t = s.triangles[s.facet_triangles[f][0]];
      const auto& u = s.triangles[s.facet_triangles[g][0]];
      return std::all_of(u.begin(), u.end(), [&](VertexId v) {
        return predicates_.orient3d(t[0], t[1], t[2], v) == 0;
      });
    });
    s.facet_plane.resize(keys.size());
    for (FacetId f = 0; f < keys.size(); ++f) {
      s.facet_plane[f] =
          class_of[f] == f ? static_cast<PlaneId>(s.plane_count++) : s.facet_plane[class_of[f]];
    }
  }

  void orient_facets() {
    SurfaceTopology& s = topology_;
    for (const auto& triangles : s.facet_triangles) {
      const Projection projection = find_projection(predicates_, s.triangles[triangles[0]]);
      DELMESHER_CHECK(projection.sign != 0, "a triangle of a valid surface is degenerate");
      s.facet_axis.push_back(projection.axis);
      s.facet_axis_sign.push_back(projection.sign);
    }
  }

  bool collinear(VertexId a, VertexId b, VertexId c) {
    for (int axis = 0; axis < 3; ++axis) {
      if (predicates_.orient2d(axis, a, b, c) != 0) return false;
    }
    return true;
  }

  void classify_lines() {
    SurfaceTopology& s = topology_;
    std::vector<std::uint32_t> edges;
    std::vector<CarrierKey> keys;
    for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
      if (s.edge_is_flat[e] != 0) continue;
      const auto [a, b] = s.edge_vertices(e);
      edges.push_back(e);
      keys.push_back(line_key(points_.nearest(a), points_.nearest(b)));
    }
    const auto class_of = classes_of(keys, [&](std::uint32_t i, std::uint32_t j) {
      const auto [a, b] = s.edge_vertices(edges[i]);
      const auto [c, d] = s.edge_vertices(edges[j]);
      return collinear(a, b, c) && collinear(a, b, d);
    });
    s.edge_line.assign(s.edge_count(), kNone);
    for (std::size_t i = 0; i < edges.size(); ++i) s.edge_line[edges[i]] = edges[class_of[i]];
  }

  void record_supports() {
    const SurfaceTopology& s = topology_;
    std::vector<PlaneId> planes;
    std::vector<std::uint32_t> lines;
    for (VertexId v = 0; v < s.vertex_half_edge.size(); ++v) {
      if (s.vertex_half_edge[v] == kNone) continue;
      planes.clear();
      lines.clear();
      s.for_each_outgoing(v, [&](std::uint32_t h) {
        planes.push_back(s.facet_plane[s.facet_of_half_edge(h)]);
        return true;
      });
      s.for_each_edge_at(v, [&](std::uint32_t e) {
        if (s.edge_is_flat[e] == 0) {
          lines.push_back(e);
          lines.push_back(s.edge_line[e]);
        }
        return true;
      });
      sort_unique(planes);
      sort_unique(lines);
      points_.set_supports(v, planes, lines);
    }
  }

  const Surface& surface_;
  PointStore& points_;
  Predicates& predicates_;
  const Rules rules_;
  SurfaceTopology topology_;
};

}  // namespace

SurfaceTopology build_topology(const Surface& surface, PointStore& points, Predicates& predicates,
                               Rules rules) {
  return Builder(surface, points, predicates, rules).build();
}

SurfaceTopology with_facet_per_triangle(const SurfaceTopology& topology) {
  SurfaceTopology result = topology;
  const auto of_facet = [&](const auto& values) {
    std::decay_t<decltype(values)> per_triangle;
    for (const FacetId f : topology.facet_of) per_triangle.push_back(values[f]);
    return per_triangle;
  };
  result.facet_plane = of_facet(topology.facet_plane);
  result.facet_axis = of_facet(topology.facet_axis);
  result.facet_axis_sign = of_facet(topology.facet_axis_sign);
  result.facet_triangles.clear();
  for (std::uint32_t t = 0; t < topology.triangles.size(); ++t) {
    result.facet_of[t] = t;
    result.facet_triangles.push_back({t});
  }
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_is_flat[e] != 0) result.edge_line[e] = e;
  }
  result.edge_is_flat.assign(topology.edge_count(), 0);
  return result;
}

std::vector<PlaneId> SurfaceTopology::edge_planes(std::uint32_t e) const {
  std::vector<PlaneId> planes;
  for_each_half_edge(e, [&](std::uint32_t h) {
    planes.push_back(facet_plane[facet_of_half_edge(h)]);
    return true;
  });
  sort_unique(planes);
  return planes;
}

std::uint32_t edge_between(const SurfaceTopology& topology, VertexId a, VertexId b) {
  std::uint32_t edge = kNone;
  topology.for_each_edge_at(a, [&](std::uint32_t e) {
    const std::array<VertexId, 2> end = topology.edge_vertices(e);
    if (end[0] == b || end[1] == b) edge = e;
    return edge == kNone;
  });
  return edge;
}

std::vector<Box> triangle_boxes(const SurfaceTopology& topology, const PointStore& points) {
  std::vector<Box> boxes;
  boxes.reserve(topology.triangles.size());
  for (const auto& t : topology.triangles) boxes.push_back(enclosing_box(points, t));
  return boxes;
}

}  // namespace delmesher::surface
