// Piecewise linear complexes: the input of the refinement (section 5), in terms of points of a
// store.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/base/ids.h"

namespace delmesher::surface {

// A straight constraint between two points.
struct PlcSegment {
  std::array<VertexId, 2> vertex;
  // Input edge that contains it (undirected edge of SurfaceTopology). kNone for an edge of the
  // outer box, and for an artificial segment, which chamfering makes inside one facet.
  std::uint32_t input_edge = kNone;
};

// A flat polygonal region, possibly with holes, several parts and isolated points; lies in the
// plane of an input facet (or of the outer box).
struct PlcFacet {
  FacetId input_facet = kNone;  // kNone for the outer box
  // Corners of the surface (or the box) that span the plane, counter-clockwise seen from outside.
  std::array<VertexId, 3> frame;
  int axis = 0;       // projection axis for orient2d
  int axis_sign = 1;  // sign of the frame's normal along it
  // Directed boundary: segment index and whether it is traversed backwards, with the interior of
  // the facet on the left seen from outside.
  struct Side {
    std::uint32_t segment;
    bool reversed;
  };
  std::vector<Side> boundary;
  std::vector<VertexId> isolated;  // vertices strictly inside (flat input vertices)
};

// Every point used by a segment or facet becomes a vertex of the mesh.
struct Plc {
  std::vector<PlcSegment> segments;
  std::vector<PlcFacet> facets;
};

}  // namespace delmesher::surface
