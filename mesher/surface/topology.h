// Adjacency and exact facets of a valid input surface, or complex of triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/delmesher/surface.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/rules.h"

namespace delmesher::surface {

// A valid surface (closed, manifold, oriented, not self-intersecting), or a valid complex
// (validity.h) with its adjacency. Points 0 .. vertices-1 of the store are the input vertices.
//
// Directed half-edge h = 3 t + k goes from triangles[t][k] to triangles[t][(k + 1) % 3]. An edge of
// a surface has two, in opposite directions; an edge of a complex any number, in any directions.
struct SurfaceTopology {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::int32_t> labels;  // per triangle
  // half-edge -> the next one of its edge, after the last one the first: of a surface that of the
  // neighbouring triangle, of a free edge of a complex itself.
  std::vector<std::uint32_t> opposite;
  std::vector<std::uint32_t> edge_of;         // half-edge -> undirected edge
  std::vector<std::uint32_t> edge_half_edge;  // edge -> a half-edge, with from < to if there is one
  std::vector<std::uint32_t> vertex_half_edge;  // vertex -> an outgoing half-edge, kNone if unused
  // Of a complex: the outgoing half-edges of vertex v are outgoing[outgoing_begin[v]] and on, to
  // outgoing_begin[v + 1]. Of a surface empty: they follow each other across edges.
  std::vector<std::uint32_t> outgoing_begin, outgoing;

  // Facets: edge-connected groups of exactly coplanar triangles of one label, in the order of their
  // smallest triangle. In a complex they end at edges of more than two triangles, and where
  // triangles are turned differently; one that surrounds such an edge falls apart into its
  // triangles.
  std::vector<FacetId> facet_of;                            // triangle -> facet
  std::vector<std::vector<std::uint32_t>> facet_triangles;  // ascending
  std::vector<PlaneId> facet_plane;  // facets in the same plane (either orientation) share the id
  std::size_t plane_count = 0;
  std::vector<int> facet_axis;       // coordinate axis along which the normal has a large component
  std::vector<int> facet_axis_sign;  // exact sign of that component (of the outward normal)
  // Constrained (non-flat) edges: between different facets.
  std::vector<std::uint8_t> edge_is_flat;  // per undirected edge
  // Non-flat edges on exactly one line share it: the smallest such edge, or kNone for a flat edge.
  std::vector<std::uint32_t> edge_line;

  std::size_t edge_count() const { return edge_half_edge.size(); }
  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
  std::uint32_t from(std::uint32_t h) const { return triangles[h / 3][h % 3]; }
  std::uint32_t to(std::uint32_t h) const { return triangles[h / 3][(h + 1) % 3]; }
  FacetId facet_of_half_edge(std::uint32_t h) const { return facet_of[h / 3]; }
  // The two end points of an undirected edge, smaller id first.
  std::array<VertexId, 2> edge_vertices(std::uint32_t e) const {
    const VertexId a = from(edge_half_edge[e]), b = to(edge_half_edge[e]);
    return a < b ? std::array{a, b} : std::array{b, a};
  }
  // Is it an edge of one triangle alone?
  bool is_free(std::uint32_t e) const { return opposite[edge_half_edge[e]] == edge_half_edge[e]; }
  // Until visit(half-edge of e) is false.
  template <class Visit>
  void for_each_half_edge(std::uint32_t e, Visit&& visit) const {
    std::uint32_t h = edge_half_edge[e];
    do {
      if (!visit(h)) return;
      h = opposite[h];
    } while (h != edge_half_edge[e]);
  }
  // Until visit(half-edge from v) is false. Every edge at v is that of one of them, or, in a
  // complex, of the half-edge before one.
  template <class Visit>
  void for_each_outgoing(VertexId v, Visit&& visit) const {
    if (outgoing_begin.empty()) {
      const std::uint32_t first = vertex_half_edge[v];
      std::uint32_t h = first;
      while (h != kNone && visit(h)) {
        h = opposite[previous(h)];
        if (h == first) return;
      }
      return;
    }
    for (std::uint32_t n = outgoing_begin[v]; n < outgoing_begin[v + 1]; ++n) {
      if (!visit(outgoing[n])) return;
    }
  }
  // Until visit(edge at v) is false; in a complex some come twice.
  template <class Visit>
  void for_each_edge_at(VertexId v, Visit&& visit) const {
    for_each_outgoing(v, [&](std::uint32_t h) {
      return visit(edge_of[h]) && (outgoing_begin.empty() || visit(edge_of[previous(h)]));
    });
  }
  // Two half-edges of an edge: of a surface both.
  std::array<std::uint32_t, 2> edge_half_edges(std::uint32_t e) const {
    return {edge_half_edge[e], opposite[edge_half_edge[e]]};
  }
  // The planes of the facets at an edge: supports of points on it.
  std::vector<PlaneId> edge_planes(std::uint32_t e) const;
};

// Builds the adjacency and the facets (exactly), and records as supports of every vertex the planes
// of its facets and the lines of its non-flat edges (both the edge itself and edge_line of it are
// ids of the line that contains an edge). A surface must have passed check_validity and be oriented
// outwards; a complex must have passed it as one. Points 0 .. vertices-1 of the store are its
// vertices; an empty store gets them where they are.
SurfaceTopology build_topology(const Surface& surface, PointStore& points, Predicates& predicates,
                               Rules rules = Rules::solid);

// The same surface with a facet of its own for every triangle, so that all edges are constrained.
// Planes and lines keep their numbers.
SurfaceTopology with_facet_per_triangle(const SurfaceTopology& topology);

// The undirected edge between two vertices; kNone if there is none.
std::uint32_t edge_between(const SurfaceTopology& topology, VertexId a, VertexId b);

// Boxes of the triangles, in their order.
std::vector<Box> triangle_boxes(const SurfaceTopology& topology, const PointStore& points);

}  // namespace delmesher::surface
