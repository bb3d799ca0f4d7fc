#include "mesher/enrich/enrichment.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/base/sort_unique.h"
#include "mesher/chamfer/removed_surface.h"
#include "mesher/surface/feature_size.h"
#include "mesher/surface/loose_points.h"

namespace delmesher::enrich {
namespace {

// Per point of the store: distance to its nearest neighbour along an edge of the refined mesh.
std::vector<double> spacings(const refine::RefineResult& refined, const PointStore& points) {
  std::vector<double> spacing(points.size(), HUGE_VAL);
  for (const auto& t : refined.tetrahedra) {
    for (const auto& e : kEdge) {
      const Vec3 p = points.nearest(t[e[0]]);
      const double length =
          point_segment_distance(p, points.nearest(t[e[1]]), points.nearest(t[e[1]]));
      for (const int end : e) spacing[t[end]] = std::min(spacing[t[end]], length);
    }
  }
  return spacing;
}

// Adds the points on artificial segments, but not on input edges, as the paper does. By default
// they are left out: beside the edges of the corner that was cut off, inside their diametral balls,
// they have these edges split once more, next to the corner, and three of four small angles come
// from there.
void add_artificial_points(const chamfer::ChamferResult& chamfered,
                           const refine::RefineResult& refined, const PointStore& points,
                           cdt::CdtInput& input) {
  const Plc& plc = chamfered.plc;
  std::vector<std::uint8_t> on_edge(points.size());
  for (std::size_t n = 0; n < plc.segments.size(); ++n) {
    if (plc.segments[n].input_edge == kNone) continue;
    for (const VertexId v : refined.chain[n]) on_edge[v] = 1;
  }
  for (const PlcFacet& facet : plc.facets) {
    if (facet.input_facet == kNone) continue;
    std::vector<VertexId>& inside = input.on_facet[facet.input_facet];
    for (const PlcFacet::Side& side : facet.boundary) {
      if (plc.segments[side.segment].input_edge != kNone) continue;
      for (const VertexId v : refined.chain[side.segment]) {
        if (on_edge[v] == 0 && !points.is_corner(v)) inside.push_back(v);
      }
    }
  }
}

// Adds the points of the refined complex on input edges and inside input facets; what else there is
// on the complex, the box, goes to `vertices` alone.
void add_complex_points(const chamfer::ChamferResult& chamfered,
                        const refine::RefineResult& refined, const PointStore& points,
                        cdt::CdtInput& input) {
  const Plc& plc = chamfered.plc;
  for (std::size_t n = 0; n < plc.segments.size(); ++n) {
    const std::uint32_t e = plc.segments[n].input_edge;
    if (e == kNone) continue;
    for (const VertexId v : refined.chain[n]) {
      if (!points.is_corner(v)) input.on_edge[e].push_back(v);
    }
  }
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
    const FacetId facet = plc.facets[f].input_facet;
    std::vector<VertexId>& inside = facet == kNone ? input.vertices : input.on_facet[facet];
    inside.insert(inside.end(), refined.on_facet[f].begin(), refined.on_facet[f].end());
    if (facet != kNone) continue;
    for (const PlcFacet::Side& side : plc.facets[f].boundary) {
      const std::vector<VertexId>& chain = refined.chain[side.segment];
      inside.insert(inside.end(), chain.begin(), chain.end());
    }
  }
}

// Puts the points on edges in order, without repetition, and lists all on the surface as vertices.
void list_surface_points(Predicates& predicates, cdt::CdtInput& input) {
  for (std::uint32_t e = 0; e < input.on_edge.size(); ++e) {
    std::vector<VertexId>& chain = input.on_edge[e];
    const auto ends = input.topology->edge_vertices(e);
    sort_unique(chain);
    std::sort(chain.begin(), chain.end(), [&](VertexId a, VertexId b) {
      return a != b && predicates.dot_difference_sign(a, b, ends[0], ends[1]) > 0;
    });
    input.vertices.insert(input.vertices.end(), chain.begin(), chain.end());
  }
  for (std::vector<VertexId>& inside : input.on_facet) {
    sort_unique(inside);
    input.vertices.insert(input.vertices.end(), inside.begin(), inside.end());
  }
}

// Drops points that coincide with an input vertex which the complex lacks, e.g. the midpoint of a
// bridge or strip that happens to be a flat vertex: one of coincident points stays, the input
// vertex.
void drop_coincident(const PointStore& points, Predicates& predicates, cdt::CdtInput& input) {
  std::vector<VertexId>& all = input.vertices;
  sort_unique(all);
  std::vector<VertexId> order = all;
  std::sort(order.begin(), order.end(), [&](VertexId a, VertexId b) {
    const Vec3 p = points.nearest(a);
    const Vec3 q = points.nearest(b);
    return p != q ? p < q : a < b;
  });
  std::vector<VertexId> dropped;
  for (std::size_t n = 0; n + 1 < order.size(); ++n) {
    // Equal points have equal nearest doubles. Few points share them, so this loop is short.
    for (std::size_t m = n + 1; m < order.size(); ++m) {
      if (points.nearest(order[m]) != points.nearest(order[n])) break;
      if (predicates.compare_xyz(order[n], order[m]) == 0) dropped.push_back(order[m]);
    }
  }
  if (dropped.empty()) return;
  std::sort(dropped.begin(), dropped.end());
  const auto prune = [&](std::vector<VertexId>& list) {
    std::erase_if(
        list, [&](VertexId v) { return std::binary_search(dropped.begin(), dropped.end(), v); });
  };
  prune(all);
  for (auto& list : input.on_edge) prune(list);
  for (auto& list : input.on_facet) prune(list);
}

// Puts a point on an edge, in its supports as well.
void put_on_edge(VertexId v, std::uint32_t edge, PointStore& points, cdt::CdtInput& input) {
  std::vector<std::uint32_t> lines = {edge, input.topology->edge_line[edge]};
  sort_unique(lines);
  points.set_supports(v, input.topology->edge_planes(edge), lines);
  input.on_edge[edge].push_back(v);
}

// Is a triangle of the surface no farther than `reach` from x?
bool is_near(const Vec3& x, double reach, const BoxTree& tree, const SurfaceTopology& topology,
             const PointStore& points) {
  Box box{x, x};
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] -= reach;
    box.hi[k] += reach;
  }
  return !tree.query(box, [&](std::uint32_t t) {
    const auto& [a, b, c] = topology.triangles[t];
    return point_triangle_distance(x, {points.nearest(a), points.nearest(b), points.nearest(c)}) >
           reach;
  });
}

}  // namespace

cdt::CdtInput plain_input(const SurfaceTopology& topology) {
  cdt::CdtInput input;
  input.topology = &topology;
  input.on_edge.resize(topology.edge_count());
  input.on_facet.resize(topology.facet_triangles.size());
  for (VertexId v = 0; v < topology.vertex_half_edge.size(); ++v) {
    if (topology.vertex_half_edge[v] != kNone) input.vertices.push_back(v);
  }
  return input;
}

cdt::CdtInput plain_input(const SurfaceTopology& topology, const PointStore& points,
                          Predicates& predicates) {
  cdt::CdtInput input = plain_input(topology);
  const std::vector<VertexId> loose = loose_points(topology, points, predicates);
  input.vertices.insert(input.vertices.end(), loose.begin(), loose.end());
  return input;
}

cdt::CdtInput enriched_input(const chamfer::ChamferResult& chamfered,
                             const std::vector<std::uint8_t>& facet_kept,
                             const refine::RefineResult& refined, const SurfaceTopology& topology,
                             const PointStore& points, Predicates& predicates, bool keep_all,
                             Control& control) {
  cdt::CdtInput input = plain_input(topology, points, predicates);
  if (keep_all) add_artificial_points(chamfered, refined, points, input);
  add_complex_points(chamfered, refined, points, input);
  list_surface_points(predicates, input);
  const chamfer::RemovedSurface removed(chamfered, facet_kept, topology, points);
  const std::vector<double> spacing = spacings(refined, points);
  // A vertex in the plane of a dropped facet would have to be one of the facet's, so even the
  // vertices that the paper keeps are a hair away from it.
  const double share = keep_all ? 0x1p-20 : 1;
  for (const VertexId v : refined.in_volume) {
    control.poll(points.size());
    if (!removed.too_near(points.nearest(v), share * spacing[v])) input.vertices.push_back(v);
  }
  drop_coincident(points, predicates, input);
  return input;
}

cdt::CdtInput input_as_given(const ConformingMesh& mesh, const SurfaceTopology& as_given,
                             double reach, PointStore& points, Predicates& predicates,
                             Control& control) {
  cdt::CdtInput input = plain_input(as_given, points, predicates);
  std::vector<std::uint8_t> seen(points.size());
  std::fill_n(seen.begin(), as_given.vertex_half_edge.size(), 1);
  for (const SurfaceFace& face : mesh.boundary) {
    for (const VertexId v : face.vertices) {
      if (std::exchange(seen[v], 1) != 0) continue;
      const PointDefinition d = points.definition(v);
      if (d.kind != PointKind::on_segment) continue;
      const std::uint32_t edge = edge_between(as_given, d.corner[0], d.corner[1]);
      if (edge == kNone || as_given.edge_is_flat[edge] != 0) continue;
      put_on_edge(v, edge, points, input);
    }
  }
  const BoxTree tree(triangle_boxes(as_given, points));
  for (const auto& tetrahedron : mesh.tetrahedra) {
    control.poll(points.size());
    for (const VertexId v : tetrahedron) {
      if (std::exchange(seen[v], 1) != 0) continue;
      if (!is_near(points.nearest(v), reach, tree, as_given, points)) input.vertices.push_back(v);
    }
  }
  list_surface_points(predicates, input);
  return input;
}

}  // namespace delmesher::enrich
