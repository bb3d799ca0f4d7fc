#include "mesher/enrich/enrichment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mesher/chamfer/removed_surface.h"
#include "mesher/enrich/test_input.h"
#include "mesher/refine/test_complexes.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::enrich {
namespace {

using surface::test_surfaces::box;

Surface brick() {
  return box({0, 0, 0}, {3, 2, 1});
}

bool is_at_the_top(const SurfaceTopology& topology, const PointStore& points, FacetId f) {
  return std::ranges::all_of(topology.triangles[topology.facet_triangles[f].front()],
                             [&](VertexId v) { return points.nearest(v)[2] == 1; });
}

struct Shape {
  bool without_top = false;  // the filter has dropped the facet at z = 1
  double max_edge = 0;
  double clearance = 0;  // of flat vertices
};

// A surface, the complex of what is kept of it, and the refined mesh of that.
struct Case {
  explicit Case(const Surface& surface, const Shape& shape = {}) {
    topology = build_topology(surface, points, predicates);
    for (FacetId f = 0; f < topology.facet_triangles.size(); ++f) {
      kept.push_back(shape.without_top && is_at_the_top(topology, points, f) ? 0 : 1);
    }
    chamfer::ChamferOptions chamfering;
    chamfering.facet_kept = kept;
    chamfering.isolated_clearance = shape.clearance;
    chamfered = chamfer::chamfer(topology, points, predicates, chamfering, control);
    refine::add_outer_box(topology, points, chamfered.plc);
    refine::RefineOptions options;
    options.max_edge = shape.max_edge;
    options.apex = chamfered.vertex_is_apex;
    options.removed = chamfer::removed_boxes(chamfered, kept, topology, points);
    refined = refine::refine(chamfered.plc, topology, points, predicates, options, control);
  }

  cdt::CdtInput input(bool keep_all) {
    return enriched_input(chamfered, kept, refined, topology, points, predicates, keep_all,
                          control);
  }
  // A volume vertex of the refined mesh, whose neighbours are input vertices.
  VertexId put_in_volume(double x, double y, double z) {
    const VertexId v = points.add_explicit(x, y, z);
    refined.in_volume.push_back(v);
    refined.tetrahedra.push_back({v, 0, 1, 2});
    return v;
  }

  PointStore points;
  Predicates predicates{points};
  Limits limits;
  Control control{limits};
  SurfaceTopology topology;
  std::vector<std::uint8_t> kept;
  chamfer::ChamferResult chamfered;
  refine::RefineResult refined;
};

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = subtract(b, a), ap = subtract(p, a);
  const double length2 = squared_norm(ab);
  const double t = length2 > 0 ? std::clamp(dot(ap, ab) / length2, 0.0, 1.0) : 0;
  return norm(subtract(ap, {t * ab[0], t * ab[1], t * ab[2]}));
}

double distance_to_the_top(const Vec3& p) {
  return std::hypot(p[0] - std::clamp(p[0], 0.0, 3.0), p[1] - std::clamp(p[1], 0.0, 2.0), p[2] - 1);
}

bool is_in_a_chamfer(const Case& c, const Vec3& p) {
  for (VertexId v = 0; v < c.chamfered.vertex_radius.size(); ++v) {
    const Vec3 at = c.points.nearest(v);
    if (distance_to_segment(p, at, at) < c.chamfered.vertex_radius[v]) return true;
  }
  for (std::uint32_t e = 0; e < c.chamfered.edge_radius.size(); ++e) {
    const auto [a, b] = c.topology.edge_vertices(e);
    const double d = distance_to_segment(p, c.points.nearest(a), c.points.nearest(b));
    if (d < c.chamfered.edge_radius[e]) return true;
  }
  return false;
}

double shortest_edge_at(const Case& c, VertexId v) {
  double shortest = HUGE_VAL;
  for (const auto& t : c.refined.tetrahedra) {
    if (std::ranges::find(t, v) == t.end()) continue;
    for (const VertexId w : t) {
      if (w == v) continue;
      shortest = std::min(shortest, norm(subtract(c.points.nearest(v), c.points.nearest(w))));
    }
  }
  return shortest;
}

std::set<VertexId> artificial_points(const Case& c) {
  const Plc& plc = c.chamfered.plc;
  std::set<VertexId> on_edges, result;
  for (std::size_t n = 0; n < plc.segments.size(); ++n) {
    if (plc.segments[n].input_edge == kNone) continue;
    on_edges.insert(c.refined.chain[n].begin(), c.refined.chain[n].end());
  }
  for (const PlcFacet& facet : plc.facets) {
    if (facet.input_facet == kNone) continue;  // of the outer box
    for (const PlcFacet::Side& side : facet.boundary) {
      if (plc.segments[side.segment].input_edge != kNone) continue;
      for (const VertexId v : c.refined.chain[side.segment]) {
        if (on_edges.count(v) == 0 && !c.points.is_explicit(v)) result.insert(v);
      }
    }
  }
  return result;
}

// By brute force, from the words of the header.
std::set<VertexId> vertices_promised(const Case& c, bool keep_all) {
  std::set<VertexId> result;
  for (const auto& t : c.refined.tetrahedra) result.insert(t.begin(), t.end());
  for (const auto& t : c.topology.triangles) result.insert(t.begin(), t.end());
  if (!keep_all) {
    for (const VertexId v : artificial_points(c)) result.erase(v);
  }
  const bool some_dropped = std::ranges::find(c.kept, 0) != c.kept.end();
  const double share = keep_all ? 0.3 * 0x1p-20 : 0.3;
  for (const VertexId v : c.refined.in_volume) {
    const Vec3 p = c.points.nearest(v);
    const bool at_dropped =
        some_dropped && distance_to_the_top(p) <= share * shortest_edge_at(c, v);
    if (at_dropped || is_in_a_chamfer(c, p)) result.erase(v);
  }
  return result;
}

std::set<VertexId> as_set(const std::vector<VertexId>& list) {
  return {list.begin(), list.end()};
}

TEST(PlainInput, IsTheSurfaceAlone) {
  Surface surface = brick();
  surface.vertices.insert(surface.vertices.begin() + 3, {9, 9, 9});  // of no triangle
  for (auto& t : surface.triangles) {
    for (std::uint32_t& v : t) v += v >= 3 ? 1 : 0;
  }
  PointStore points;
  Predicates predicates(points);
  const SurfaceTopology topology = build_topology(surface, points, predicates);
  const cdt::CdtInput input = plain_input(topology);
  EXPECT_EQ(input.topology, &topology);
  EXPECT_EQ(input.vertices, (std::vector<VertexId>{0, 1, 2, 4, 5, 6, 7, 8}));
  EXPECT_EQ(input.on_edge, std::vector<std::vector<VertexId>>(18));
  EXPECT_EQ(input.on_facet, std::vector<std::vector<VertexId>>(6));
}

TEST(Enrichment, HasTheVerticesThatItPromises) {
  std::size_t artificial = 0, in_chamfers = 0;
  for (const Surface& surface : {brick(), refine::wedge(), refine::tent(), refine::ell()}) {
    Case c(surface, {.max_edge = 0.3});
    artificial += artificial_points(c).size();
    for (const VertexId v : c.refined.in_volume) {
      in_chamfers += is_in_a_chamfer(c, c.points.nearest(v));
    }
    for (const bool keep_all : {false, true}) {
      const cdt::CdtInput input = c.input(keep_all);
      EXPECT_EQ(wrong(input, c.points), "");
      EXPECT_EQ(as_set(input.vertices), vertices_promised(c, keep_all));
    }
  }
  EXPECT_GT(artificial, 10U);
  EXPECT_GT(in_chamfers, 10U);
}

// Without the facet at the top the refinement puts points beside it, and even into its plane.
TEST(Enrichment, LeavesOutWhatIsTooNearToDroppedFacets) {
  Case c(brick(), {.without_top = true, .max_edge = 0.4});
  const VertexId near = c.put_in_volume(1.5, 1, 1 - 0x1p-10), far = c.put_in_volume(1, 1, 0.25),
                 hair = c.put_in_volume(2, 1, 1 + 0x1p-30);
  std::array<std::set<VertexId>, 2> found;
  for (const bool keep_all : {false, true}) {
    const cdt::CdtInput input = c.input(keep_all);
    EXPECT_EQ(wrong(input, c.points), "");
    found[keep_all] = as_set(input.vertices);
    EXPECT_EQ(found[keep_all], vertices_promised(c, keep_all));
    EXPECT_EQ(found[keep_all].count(near), keep_all ? 1U : 0U);
    EXPECT_EQ(found[keep_all].count(far), 1U);
    EXPECT_EQ(found[keep_all].count(hair), 0U);
  }
  EXPECT_GT(found[1].size(), found[0].size() + 10);
}

// Flat vertices in the middle of faces are not in the complex, so that its points may fall on them.
TEST(Enrichment, OfPointsThatCoincideTheInputVertexStays) {
  Case c(box({0, 0, 0}, {2, 2, 2}, 2), {.clearance = 10});
  const auto vertex_at = [&](const Vec3& x) {
    VertexId v = 0;
    while (c.points.nearest(v) != x) ++v;
    return v;
  };
  const VertexId flat = vertex_at({1, 1, 0}), a = vertex_at({0, 0, 0}), b = vertex_at({2, 2, 0}),
                 d = vertex_at({2, 0, 0});
  ASSERT_LT(flat, c.topology.vertex_half_edge.size());
  const FacetId facet = c.topology.facet_of_half_edge(c.topology.vertex_half_edge[flat]);
  std::vector<VertexId>& inside = c.refined.on_facet[c.chamfered.plc_facet[facet]];
  const VertexId on_it = c.points.add_on_segment(a, b, 0.5),
                 beside_it = c.points.add_on_triangle(a, b, d, 0.5 - 0x1p-54, 0.5),
                 in_volume = c.points.add_explicit(1, 1, 0);
  ASSERT_EQ(c.points.nearest(beside_it), c.points.nearest(flat));  // but it is somewhere else
  inside.insert(inside.end(), {on_it, beside_it});
  c.refined.in_volume.push_back(in_volume);
  for (const bool keep_all : {false, true}) {
    const cdt::CdtInput input = c.input(keep_all);
    EXPECT_EQ(wrong(input, c.points), "");
    const std::set<VertexId> all = as_set(input.vertices);
    EXPECT_EQ(all.count(flat), 1U);
    EXPECT_EQ(all.count(on_it), 0U);
    EXPECT_EQ(all.count(in_volume), 0U);
    EXPECT_EQ(as_set(input.on_facet[facet]).count(beside_it), 1U);
  }
}

}  // namespace
}  // namespace delmesher::enrich
