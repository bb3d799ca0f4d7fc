#include "mesher/chamfer/removed_surface.h"

#include <span>

#include "mesher/surface/feature_size.h"

namespace delmesher::chamfer {
namespace {

Box enlarged(Box box, double by) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] -= by;
    box.hi[k] += by;
  }
  return box;
}

}  // namespace

std::vector<Box> removed_boxes(const ChamferResult& chamfered,
                               const std::vector<std::uint8_t>& facet_kept,
                               const SurfaceTopology& topology, const PointStore& points) {
  // The refinement bends artificial edges by a millionth of their length; a hundredth of the radius
  // is ample.
  constexpr double kMargin = 1.01;
  std::vector<Box> boxes;
  const auto add = [&](std::span<const VertexId> corners, double radius) {
    boxes.push_back(enlarged(enclosing_box(points, corners), radius));
  };
  for (VertexId v = 0; v < chamfered.vertex_radius.size(); ++v) {
    const double radius = chamfered.vertex_radius[v];
    if (radius > 0) add(std::array{v}, radius * kMargin);
  }
  for (std::uint32_t e = 0; e < chamfered.edge_radius.size(); ++e) {
    const double radius = chamfered.edge_radius[e];
    if (radius > 0) add(topology.edge_vertices(e), radius * kMargin);
  }
  for (std::uint32_t t = 0; t < topology.triangles.size(); ++t) {
    if (!facet_kept.empty() && facet_kept[topology.facet_of[t]] == 0) add(topology.triangles[t], 0);
  }
  return boxes;
}

RemovedSurface::RemovedSurface(const ChamferResult& chamfered,
                               const std::vector<std::uint8_t>& facet_kept,
                               const SurfaceTopology& topology, const PointStore& points)
    : points_(points),
      topology_(topology),
      chamfers_(build_chamfers(chamfered)),
      dropped_(build_dropped(facet_kept)) {}

bool RemovedSurface::too_near(const Vec3& p, double spacing) const {
  const bool in_chamfer = !chamfers_.query({p, p}, [&](std::uint32_t n) {
    return !(point_segment_distance(p, items_[n].a, items_[n].b) < items_[n].radius);
  });
  if (in_chamfer) return true;
  // Nearer than this fraction of its spacing, a vertex sees a filtered facet under too small
  // angles.
  constexpr double kTooNear = 0.3;
  const double reach = kTooNear * spacing;
  return !dropped_.query(enlarged({p, p}, reach), [&](std::uint32_t n) {
    return !(point_triangle_distance(p, corners(dropped_triangles_[n])) <= reach);
  });
}

std::array<Vec3, 3> RemovedSurface::corners(std::uint32_t t) const {
  const auto& v = topology_.triangles[t];
  return {points_.nearest(v[0]), points_.nearest(v[1]), points_.nearest(v[2])};
}

void RemovedSurface::add(VertexId a, VertexId b, double radius, std::vector<Box>& boxes) {
  if (!(radius > 0)) return;
  items_.push_back({points_.nearest(a), points_.nearest(b), radius});
  const Box box = Box::around(std::array<Vec3, 2>{items_.back().a, items_.back().b});
  boxes.push_back(enlarged(box, radius));
}

BoxTree RemovedSurface::build_chamfers(const ChamferResult& chamfered) {
  std::vector<Box> boxes;
  for (VertexId v = 0; v < chamfered.vertex_radius.size(); ++v) {
    add(v, v, chamfered.vertex_radius[v], boxes);
  }
  for (std::uint32_t e = 0; e < chamfered.edge_radius.size(); ++e) {
    const auto ends = topology_.edge_vertices(e);
    add(ends[0], ends[1], chamfered.edge_radius[e], boxes);
  }
  return BoxTree(boxes);
}

BoxTree RemovedSurface::build_dropped(const std::vector<std::uint8_t>& facet_kept) {
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < topology_.triangles.size() && !facet_kept.empty(); ++t) {
    if (facet_kept[topology_.facet_of[t]] != 0) continue;
    dropped_triangles_.push_back(t);
    boxes.push_back(Box::around(corners(t)));
  }
  return BoxTree(boxes);
}

}  // namespace delmesher::chamfer
