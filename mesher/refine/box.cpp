// The outer box (section 5.1).
#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/moved_away.h"
#include "mesher/refine/refine.h"

namespace delmesher::refine {
namespace {

// Margin on each side: half the extent of the axis, but not less than a quarter of the largest
// extent, so that the box is not close to thin models.
constexpr double kMarginOfAxis = 0.5;
constexpr double kMarginOfLargest = 0.25;

struct Interval {
  double low, high;
};

// Corners per face, counter-clockwise seen from outside; corner c has coordinate bit k of c along
// axis k.
constexpr int kBoxFace[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

// moved_away() among the doubles of given coordinates.
double beside(double x, double from, double by, double origin) {
  if (origin == 0) return moved_away(x, from, by);
  return moved_away(origin + x, origin + from, by) - origin;
}

std::array<Interval, 3> box_of(const SurfaceTopology& topology, const PointStore& points,
                               const LocalFrame& frame) {
  std::array<Interval, 3> box;
  for (Interval& axis : box) axis = {HUGE_VAL, -HUGE_VAL};
  for (const auto& triangle : topology.triangles) {
    for (const VertexId v : triangle) {
      const Vec3 p = points.nearest(v);
      for (int k = 0; k < 3; ++k) {
        box[k].low = std::min(box[k].low, p[k]);
        box[k].high = std::max(box[k].high, p[k]);
      }
    }
  }
  double largest = 0;
  for (const Interval& axis : box) largest = std::max(largest, axis.high - axis.low);
  // Coordinates on a coarse power-of-two grid, so that they are short.
  const double grid = std::ldexp(1.0, std::ilogb(largest) - 6);
  for (std::size_t k = 0; k < 3; ++k) {
    Interval& axis = box[k];
    const double margin =
        std::max(kMarginOfAxis * (axis.high - axis.low), kMarginOfLargest * largest);
    const Interval inner = axis;
    axis.low = std::floor((inner.low - margin) / grid) * grid;
    axis.high = std::ceil((inner.high + margin) / grid) * grid;
    // A side of the box on the solid would be refined for ever.
    axis.low = beside(axis.low, inner.low, -margin / 2, frame.origin[k]);
    axis.high = beside(axis.high, inner.high, margin / 2, frame.origin[k]);
  }
  return box;
}

}  // namespace

void add_outer_box(const SurfaceTopology& topology, PointStore& points, Plc& plc,
                   const LocalFrame& frame) {
  const std::array<Interval, 3> box = box_of(topology, points, frame);
  std::array<VertexId, 8> corner;
  for (int c = 0; c < 8; ++c) {
    std::array<double, 3> p;
    for (int k = 0; k < 3; ++k) p[k] = ((c >> k) & 1) != 0 ? box[k].high : box[k].low;
    corner[c] = points.add_explicit(p[0], p[1], p[2]);
    // Planes of the faces that meet here. Their numbers follow the planes of the input.
    std::array<PlaneId, 3> planes;
    for (int k = 0; k < 3; ++k) {
      planes[k] =
          static_cast<PlaneId>(topology.plane_count) + static_cast<PlaneId>(2 * k + ((c >> k) & 1));
    }
    points.set_supports(corner[c], planes, {});
  }
  std::array<std::array<std::uint32_t, 8>, 8> segment_of;
  for (auto& row : segment_of) row.fill(kNone);
  for (int f = 0; f < 6; ++f) {
    PlcFacet facet;
    facet.frame = {corner[kBoxFace[f][0]], corner[kBoxFace[f][1]], corner[kBoxFace[f][2]]};
    facet.axis = f / 2;
    facet.axis_sign = f % 2 == 0 ? -1 : 1;
    for (int n = 0; n < 4; ++n) {
      const int a = kBoxFace[f][n];
      const int b = kBoxFace[f][(n + 1) % 4];
      std::uint32_t& segment = segment_of[std::min(a, b)][std::max(a, b)];
      if (segment == kNone) {
        segment = static_cast<std::uint32_t>(plc.segments.size());
        plc.segments.push_back({{corner[std::min(a, b)], corner[std::max(a, b)]}, kNone});
      }
      facet.boundary.push_back({segment, a > b});
    }
    plc.facets.push_back(std::move(facet));
  }
}

}  // namespace delmesher::refine
