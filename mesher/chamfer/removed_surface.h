// The parts of the surface that chamfering and filtering remove before the refinement: spheres and
// cylinders of the chamfers, and the dropped facets.
#pragma once

#include <array>
#include <vector>

#include "mesher/chamfer/chamfer.h"
#include "mesher/geometry/box_tree.h"

namespace delmesher::chamfer {

// Boxes that cover the removed parts.
std::vector<Box> removed_boxes(const ChamferResult& chamfered,
                               const std::vector<std::uint8_t>& facet_kept,
                               const SurfaceTopology& topology, const PointStore& points);

// Tells which points of the refined mesh are too near to the removed parts for the last step
// (section 6): a volume vertex inside a chamfer, or one within 0.3 of its spacing of a dropped
// facet, would make needless bad tetrahedra when the surface returns. `facet_kept`: per facet;
// empty: all.
class RemovedSurface {
 public:
  RemovedSurface(const ChamferResult& chamfered, const std::vector<std::uint8_t>& facet_kept,
                 const SurfaceTopology& topology, const PointStore& points);

  // `spacing` is the distance of p to its nearest neighbour in the refined mesh.
  bool too_near(const Vec3& p, double spacing) const;

 private:
  struct Chamfer {
    Vec3 a, b;  // the same for a sphere
    double radius;
  };

  std::array<Vec3, 3> corners(std::uint32_t triangle) const;
  void add(VertexId a, VertexId b, double radius, std::vector<Box>& boxes);
  BoxTree build_chamfers(const ChamferResult& chamfered);
  BoxTree build_dropped(const std::vector<std::uint8_t>& facet_kept);

  const PointStore& points_;
  const SurfaceTopology& topology_;
  std::vector<Chamfer> items_;
  std::vector<std::uint32_t> dropped_triangles_;
  BoxTree chamfers_, dropped_;
};

}  // namespace delmesher::chamfer
