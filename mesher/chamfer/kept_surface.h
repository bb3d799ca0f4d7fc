// The part of the surface that chamfering sees: kept facets as planar polygons, their corners, and
// the edges and vertices on their boundaries.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/geometry/vector.h"
#include "mesher/predicates/points.h"
#include "mesher/surface/topology.h"

namespace delmesher::chamfer {

// A sector of a kept facet at a vertex of its boundary, between two boundary edges. A vertex may
// have several in one facet. The sector extends counter-clockwise (seen from outside) from the
// outgoing boundary half-edge to the reversed incoming one; its triangles are visited by fan().
struct Corner {
  VertexId vertex;
  FacetId facet;
  std::uint32_t outgoing, incoming;  // half-edges of the facet
  std::uint32_t next, previous;      // corners along the boundary loop, interior on the left
};

// Orthonormal coordinates in the plane of a facet, counter-clockwise seen from outside.
struct FacetFrame {
  Vec3 x_axis, y_axis;
  std::uint32_t triangle;  // the one whose height above its longest side is the largest
};

class KeptSurface {
 public:
  // `facet_kept` empty: all.
  KeptSurface(const SurfaceTopology& topology, const PointStore& points,
              const std::vector<std::uint8_t>& facet_kept);

  const SurfaceTopology& topology() const { return topology_; }
  std::size_t vertex_count() const { return position_.size(); }
  bool facet_is_kept(FacetId f) const { return kept_[f] != 0; }

  // Positions times scale(), a power of two that brings all coordinates into [-1, 1], so that
  // products neither overflow nor depend on the unit of the input. Relative to vertex 0 if the
  // surface is so far from the origin that the nearest doubles of moved vertices are too coarse.
  const Vec3& position(VertexId v) const { return position_[v]; }
  // The same of any point of the store.
  Vec3 place(const PointStore& points, VertexId v) const;
  double scale() const { return scale_; }
  Vec3 edge_vector(VertexId from, VertexId to) const {
    return subtract(position_[to], position_[from]);
  }

  const FacetFrame& frame(FacetId f) const { return frame_[f]; }
  Vec2 planar(FacetId f, const Vec3& vector) const {
    return {dot(vector, frame_[f].x_axis), dot(vector, frame_[f].y_axis)};
  }

  // All corners. The corners of one boundary loop are consecutive, in its order; so are the corners
  // of one facet.
  const std::vector<Corner>& corners() const { return corners_; }
  // The corners of facet f are first_corner(f) .. first_corner(f + 1) - 1.
  std::uint32_t first_corner(FacetId f) const { return first_corner_[f]; }
  // The corner at the tail of a boundary half-edge of a kept facet, or kNone.
  std::uint32_t corner_of_outgoing(std::uint32_t h) const { return corner_of_outgoing_[h]; }
  // The corner at its head, or kNone.
  std::uint32_t corner_of_incoming(std::uint32_t h) const {
    const std::uint32_t corner = corner_of_outgoing_[h];
    return corner == kNone ? kNone : corners_[corner].next;
  }

  // The spokes of v: outgoing half-edges, in order around it, of edges that are not flat and have a
  // kept facet (such edges are called live).
  std::vector<std::uint32_t> live_half_edges(VertexId v) const;
  // The outgoing half-edges at a corner's vertex, one per triangle of the sector (each leads its
  // triangle counter-clockwise), from the incoming side to the outgoing one.
  std::vector<std::uint32_t> fan(const Corner& corner) const;

 private:
  void scale_positions(const PointStore& points);
  void find_frames();
  void find_corners();

  const SurfaceTopology& topology_;
  std::vector<std::uint8_t> kept_;
  std::vector<std::uint8_t> edge_is_live_;  // constrained, and on the boundary of a kept facet
  double scale_ = 1;
  bool far_ = false;  // from the origin
  Vec3 origin_{0, 0, 0};
  std::vector<Vec3> position_;
  std::vector<FacetFrame> frame_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> first_corner_;
  std::vector<std::uint32_t> corner_of_outgoing_;
};

}  // namespace delmesher::chamfer
