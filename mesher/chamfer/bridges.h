// The new boundary of facets around acute vertices (section 4.2): cut points on edges and chains of
// bridge points inside facets.
#pragma once

#include <vector>

#include "mesher/chamfer/cuts.h"

namespace delmesher::chamfer {

// A point to be appended to the store, with its supports.
struct NewPoint {
  PointDefinition definition;
  VertexId vertex = kNone;     // the acute vertex it belongs to
  FacetId facet = kNone;       // for a point in a facet
  std::uint32_t edge = kNone;  // for a point on an edge
};

// The points made by chamfering: appended to the store while they are examined, so that the exact
// predicates apply, and again, without the unused ones, at the end.
class NewPoints {
 public:
  NewPoints(const SurfaceTopology& topology, PointStore& points)
      : topology_(topology), points_(points), first_(static_cast<VertexId>(points.size())) {}

  VertexId add(const NewPoint& point);
  // Removes the points with used[id] == 0 and renumbers the others; gives the new ids.
  std::vector<VertexId> keep(const std::vector<std::uint8_t>& used);

  VertexId first() const { return first_; }
  // The acute vertex of every point.
  std::vector<VertexId> vertices() const;

 private:
  void append(const NewPoint& point);

  const SurfaceTopology& topology_;
  PointStore& points_;
  VertexId first_;
  std::vector<NewPoint> list_;
};

struct Bridges {
  // At index 2 e + k: the point that replaces end k of edge e, the vertex itself if it is not
  // acute, kNone if the edge is gone.
  std::vector<VertexId> edge_end;
  // Per corner of an acute vertex: the chain of points replacing the vertex, counter-clockwise
  // around it: from the cut point on the outgoing edge (or, if that edge is acute, from the end of
  // its strip) to that on the incoming edge. Empty elsewhere.
  std::vector<std::vector<VertexId>> chain;

  VertexId edge_end_at_tail(const SurfaceTopology& topology, std::uint32_t h) const {
    return edge_end[2 * topology.edge_of[h] + (topology.from(h) > topology.to(h))];
  }
};

Bridges build_bridges(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                      const Thresholds& thresholds, NewPoints& new_points, Control& control);

}  // namespace delmesher::chamfer
