// Adjacency and exact facets of a valid input surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/delmesher/surface.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::surface {

// A valid surface (closed, manifold, oriented, not self-intersecting) with its adjacency. Points 0
// .. vertices-1 of the store are the input vertices.
//
// Directed half-edge h = 3 t + k goes from triangles[t][k] to triangles[t][(k + 1) % 3].
struct SurfaceTopology {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::int32_t> labels;           // per triangle
  std::vector<std::uint32_t> opposite;        // half-edge -> half-edge of the neighbouring triangle
  std::vector<std::uint32_t> edge_of;         // half-edge -> undirected edge
  std::vector<std::uint32_t> edge_half_edge;  // edge -> the one half-edge with from < to
  std::vector<std::uint32_t> vertex_half_edge;  // vertex -> an outgoing half-edge, kNone if unused

  // Facets: edge-connected groups of exactly coplanar triangles of one label, in the order of their
  // smallest triangle.
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
    return {from(edge_half_edge[e]), to(edge_half_edge[e])};
  }
  // The two half-edges of an edge.
  std::array<std::uint32_t, 2> edge_half_edges(std::uint32_t e) const {
    return {edge_half_edge[e], opposite[edge_half_edge[e]]};
  }
  // The planes of the facets on both sides of an edge, one or two: supports of points on it.
  std::vector<PlaneId> edge_planes(std::uint32_t e) const;
};

// Builds the adjacency and the facets (exactly), and records as supports of every vertex the planes
// of its facets and the lines of its non-flat edges (both the edge itself and edge_line of it are
// ids of the line that contains an edge). The surface must have passed check_validity and be
// oriented outwards. Points 0 .. vertices-1 of the store are its vertices; an empty store gets them
// where they are.
SurfaceTopology build_topology(const Surface& surface, PointStore& points, Predicates& predicates);

// The same surface with a facet of its own for every triangle, so that all edges are constrained.
// Planes and lines keep their numbers.
SurfaceTopology with_facet_per_triangle(const SurfaceTopology& topology);

// The undirected edge between two vertices; kNone if there is none.
std::uint32_t edge_between(const SurfaceTopology& topology, VertexId a, VertexId b);

// Boxes of the triangles, in their order.
std::vector<Box> triangle_boxes(const SurfaceTopology& topology, const PointStore& points);

}  // namespace delmesher::surface
