// Where new points go (sections 5.2 to 5.4 and 5.6): on subsegments, in facets, in the volume.
//
// Points are added to the store, with their supports. Besides, the complex and quantities derived
// from it are kept; nothing changes from point to point, except that the locator of facets fills
// its grids when it is first asked.
//
// Laws:
//  - a point of a segment of the input or of the box is exactly on its line, and strictly inside
//    the subsegment;
//  - every other point of a facet is exactly in its plane;
//  - a point in the volume has short coordinates.
#pragma once

#include "mesher/geometry/placement.h"
#include "mesher/predicates/predicates.h"
#include "mesher/refine/goal.h"
#include "mesher/refine/refine.h"
#include "mesher/refine/segment_facets.h"
#include "mesher/refine/shells.h"
#include "mesher/surface/facet_locator.h"

namespace delmesher::refine {

// Thrown by the guard against endless refinement; caught by refine().
struct Runaway {};

// Places inside the circumball of a tetrahedron, as far as doubles can tell: best first.
struct VolumeTargets {
  std::array<Vec3, 3> place{};
  std::size_t count = 0;
  double grid = 0;  // to which a point there is snapped
};

class SteinerPoints {
 public:
  SteinerPoints(const Plc& plc, const SegmentFacets& segment_facets,
                const SurfaceTopology& topology, PointStore& points, Predicates& predicates,
                const RefineOptions& options);

  // The point at which the subsegment ab is to be split: its middle, or where it crosses a shell of
  // an apex. On an artificial segment the point may be off the line, by a share of ab's length
  // (kBendTolerance). Throws Runaway if ab is too short.
  VertexId on_segment(std::uint32_t segment, VertexId a, VertexId b);

  // A point near the circumcentre of a subfacet.
  VertexId in_facet(std::uint32_t facet, const std::array<VertexId, 3>& subfacet);

  // Where a bad tetrahedron may be split. Throws Runaway if its shortest edge is too short.
  VolumeTargets in_tetrahedron(const VertexId* v, const Goal& goal) const;
  VertexId in_volume(const Vec3& target, double grid);

 private:
  // `origin` + `offset`, as the nearest double and the remainder.
  struct Place {
    Vec3 nearest{}, rest{};
  };
  Place beside(VertexId origin, const Vec3& offset) const;
  // In the plane of the facet, within about `tolerance` of `origin` + `offset`.
  VertexId in_plane(std::uint32_t facet, VertexId origin, const Vec3& offset, double tolerance);
  // On the line of the two vertices, strictly between a and b.
  VertexId on_line(const std::array<VertexId, 2>& line, VertexId a, VertexId b, const Vec3& offset,
                   double length);
  // Throws Runaway if an edge of that squared length means that the refinement does not end.
  void guard(double squared_length) const;

  const Plc& plc_;
  const SegmentFacets& segment_facets_;
  const SurfaceTopology& topology_;
  PointStore& points_;
  Predicates& predicates_;
  Shells shells_;
  FacetLocator locator_;
  double runaway_length_;
  bool circumcentres_;
};

}  // namespace delmesher::refine
