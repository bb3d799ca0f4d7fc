#include "mesher/refine/steiner_points.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "mesher/arithmetic/bounded.h"
#include "mesher/base/check.h"
#include "mesher/geometry/vector.h"
#include "mesher/refine/tetrahedron_shape.h"

namespace delmesher::refine {
namespace {

// Split points keep within this fraction of the subsegment of its midpoint. On an input line a
// point is exactly on the line wherever it is, so a coarse tolerance will do, and gives short
// parameters. A point of an artificial edge bends it, so it is placed finely. A point of the n-th
// generation adds at most (2/3)^n of the tolerance to its neighbours' distance from the segment.
// All generations together add at most 3 times the tolerance, which is below 2^-20 of the segment.
constexpr double kLineTolerance = 1.0 / 256;
constexpr double kBendTolerance = 1.0 / (1 << 22);
// A facet's Steiner point keeps within this fraction of the circumradius of the circumcentre.
constexpr double kCenterTolerance = 1.0 / 1024;
// Volume points are snapped to a grid of this fraction of the shortest edge, so that their
// coordinates are short. Any point of the circumball may split a tetrahedron (section 5.6).
constexpr double kGridFraction = 1.0 / 1024;
// A circumcentre is one within this fraction of the shortest edge, snapped to the grid. A little
// below 2^-9, as bounds on sums of a few roundings are compared.
constexpr double kCircumcentreFraction = 0.999 / 512;
// Off-centres (Uengoer 2004) a little nearer than necessary, so that the new face passes with a
// margin.
constexpr double kOffcentreFactor = 0.95;

template <typename T>
std::vector<T> intersection(std::span<const T> a, std::span<const T> b) {
  std::vector<T> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common;
}

Vec3 scaled(const Vec3& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}

}  // namespace

SteinerPoints::SteinerPoints(const Plc& plc, const SegmentFacets& segment_facets,
                             const SurfaceTopology& topology, PointStore& points,
                             Predicates& predicates, const RefineOptions& options)
    : plc_(plc),
      segment_facets_(segment_facets),
      topology_(topology),
      points_(points),
      predicates_(predicates),
      shells_(plc, points, options.apex),
      locator_(topology, points),
      runaway_length_(options.runaway_length),
      circumcentres_(options.circumcentres) {}

void SteinerPoints::guard(double squared_length) const {
  if (squared_length < runaway_length_ * runaway_length_) throw Runaway{};
}

SteinerPoints::Place SteinerPoints::beside(VertexId origin, const Vec3& offset) const {
  const Approximation &near = points_.approximation(origin), left = points_.remainder(origin);
  Place place;
  two_sum(near.x, offset[0], place.nearest[0], place.rest[0]);
  two_sum(near.y, offset[1], place.nearest[1], place.rest[1]);
  two_sum(near.z, offset[2], place.nearest[2], place.rest[2]);
  place.rest = {place.rest[0] + left.x, place.rest[1] + left.y, place.rest[2] + left.z};
  return place;
}

VertexId SteinerPoints::on_segment(std::uint32_t segment, VertexId a, VertexId b) {
  const PlcSegment& whole = plc_.segments[segment];
  const Vec3 d = points_.difference(a, b);
  guard(dot(d, d));
  const double length = norm(d);
  const Vec3 offset = scaled(d, shells_.split_fraction(a, b, length));
  if (whole.input_edge != kNone) {
    return on_line(topology_.edge_vertices(whole.input_edge), a, b, offset, length);
  }
  const std::uint32_t facet = segment_facets_.of(segment)[0];
  const bool box = plc_.facets[facet].input_facet == kNone;
  if (box) return on_line(whole.vertex, a, b, offset, length);
  return in_plane(facet, a, offset, length * kBendTolerance);
}

VertexId SteinerPoints::on_line(const std::array<VertexId, 2>& line, VertexId a, VertexId b,
                                const Vec3& offset, double length) {
  const auto [middle, rest] = beside(a, offset);
  for (double tolerance = length * kLineTolerance; tolerance > 0; tolerance /= 1 << 12) {
    const PointDefinition p =
        place_on_segment(points_, line[0], line[1], middle, tolerance, true, rest);
    const VertexId v = points_.add_on_segment(p.corner[0], p.corner[1], p.u);
    if (predicates_.dot_difference_sign(a, v, a, b) > 0 &&
        predicates_.dot_difference_sign(v, b, a, b) > 0) {
      points_.set_supports(v, intersection(points_.planes(a), points_.planes(b)),
                           intersection(points_.lines(a), points_.lines(b)));
      return v;
    }
    points_.pop_back();
    if (tolerance < length * 1e-12) break;
  }
  stop_at_precision("edge " + std::to_string(line[0]) + "-" + std::to_string(line[1]));
}

VertexId SteinerPoints::in_facet(std::uint32_t facet, const std::array<VertexId, 3>& subfacet) {
  const VertexId origin = subfacet[0];
  const Vec3 a = points_.difference(origin, subfacet[1]);
  const Vec3 b = points_.difference(origin, subfacet[2]);
  const Vec3 n = cross(a, b);
  const double aa = dot(a, a);
  const double bb = dot(b, b);
  const Vec3 towards =
      cross({aa * b[0] - bb * a[0], aa * b[1] - bb * a[1], aa * b[2] - bb * a[2]}, n);
  const Vec3 offset = scaled(towards, 0.5 / dot(n, n));
  const double radius = norm(offset);
  DELMESHER_CHECK(std::isfinite(radius), "a subfacet is too flat for its circumcentre");
  return in_plane(facet, origin, offset, radius * kCenterTolerance);
}

VertexId SteinerPoints::in_plane(std::uint32_t facet, VertexId origin, const Vec3& offset,
                                 double tolerance) {
  const PlcFacet& f = plc_.facets[facet];
  const auto [target, rest] = beside(origin, offset);
  std::array<VertexId, 3> frame = f.frame;
  if (f.input_facet != kNone) {
    frame = topology_.triangles[locator_.triangle_at(f.input_facet, target)];
  }
  const PointDefinition p =
      place_on_triangle(points_, frame[0], frame[1], frame[2], target, tolerance, rest);
  const VertexId v = points_.add_on_triangle(p.corner[0], p.corner[1], p.corner[2], p.u, p.v);
  const PlaneId plane = f.input_facet != kNone
                            ? topology_.facet_plane[f.input_facet]
                            : static_cast<PlaneId>(topology_.plane_count) +
                                  static_cast<PlaneId>(2 * f.axis + (f.axis_sign > 0 ? 1 : 0));
  points_.set_supports(v, std::array<PlaneId, 1>{plane}, {});
  return v;
}

VolumeTargets SteinerPoints::in_tetrahedron(const VertexId* v, const Goal& goal) const {
  const Vec3 origin = points_.nearest(v[0]);
  TetrahedronShape s = shape_of(points_, v);
  add_circumsphere(s);
  guard(s.shortest2());
  VolumeTargets targets;
  targets.grid = std::sqrt(s.shortest2()) * kGridFraction;
  const auto add = [&](const Vec3& x) {
    targets.place[targets.count++] = {origin[0] + x[0], origin[1] + x[1], origin[2] + x[2]};
  };
  if (circumcentres_) {
    const auto center = certain_circumcentre(points_, v, targets.grid, kCircumcentreFraction);
    if (center) targets.place[targets.count++] = *center;
  } else if (std::isfinite(s.radius2)) {
    // From the midpoint of the shortest edge towards the circumcentre, not farther than where the
    // new triangle on that edge just meets the angle bound.
    const Vec3& a = s.p[kEdge[s.shortest][0]];
    const Vec3& b = s.p[kEdge[s.shortest][1]];
    const Vec3 middle = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    const Vec3 d = subtract(s.center, middle);
    const double far2 = dot(d, d);
    const double reach2 = kOffcentreFactor * kOffcentreFactor * goal.offcentre2() * s.shortest2();
    if (reach2 < far2) add(add_scaled(middle, std::sqrt(reach2 / far2), d));
    add(s.center);
  }
  // Where the circumcentre of one that is nearly flat cannot be told, its centroid is inside the
  // circumball.
  Vec3 centroid{};
  for (const Vec3& q : s.p) {
    for (int k = 0; k < 3; ++k) centroid[k] += q[k] / 4;
  }
  add(centroid);
  return targets;
}

VertexId SteinerPoints::in_volume(const Vec3& target, double grid) {
  const Vec3 p = snap_to_grid(target, grid);
  return points_.add_explicit(p[0], p[1], p[2]);
}

}  // namespace delmesher::refine
