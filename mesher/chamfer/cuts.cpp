#include "mesher/chamfer/cuts.h"

#include <algorithm>
#include <string>

#include "mesher/chamfer/boundary_distance.h"
#include "mesher/predicates/placement.h"

namespace delmesher::chamfer {

namespace {

// Bisector of the sector counter-clockwise from a to b (unit vectors), at most 180 degrees wide if
// `convex`. Each formula is used where it is well conditioned.
Vec2 bisector(Vec2 a, Vec2 b, bool convex) {
  if (dot(a, b) > 0) return unit((convex ? 1.0 : -1.0) * (a + b));
  return unit(turned(a) - turned(b));
}

class Cutter {
 public:
  Cutter(const KeptSurface& surface, const Acuteness& acute, double max_radius)
      : surface_(surface),
        topology_(surface.topology()),
        acute_(acute),
        max_radius_(max_radius),
        boundary_(surface) {}

  Cuts run(Predicates& predicates, Control& control) {
    const std::vector<Corner>& corners = surface_.corners();
    cuts_.split.resize(corners.size());
    cuts_.distance.assign(surface_.vertex_count(), 0);
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
      control.poll();
      if (!acute_.vertex[corners[c].vertex]) continue;
      cuts_.split[c] = split_corner(surface_, corners[c], predicates);
      bound_distance(c);
    }
    cuts_.fraction.assign(2 * topology_.edge_count(), 0);
    for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
      if (acute_.vertex[v]) cut_edges(v);
    }
    cuts_.height.assign(topology_.opposite.size(), 0);
    for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) {
      if (!acute_.edge[e]) continue;
      control.poll();
      for (std::uint32_t h : topology_.edge_half_edges(e)) cuts_.height[h] = strip_height(h);
    }
    return std::move(cuts_);
  }

 private:
  void bound_distance(std::uint32_t index) {
    const Corner& corner = surface_.corners()[index];
    double bound = boundary_.from_vertex(corner.facet, corner.vertex) / 3;
    const double step = cuts_.split[index].step;
    // The inner points of a bridge are farther away than its ends.
    if (max_radius_ > 0) bound = std::min(bound, max_radius_ / std::sqrt(1 + step * step));
    double& distance = cuts_.distance[corner.vertex];
    distance = distance > 0 ? std::min(distance, bound) : bound;
  }

  void cut_edges(VertexId v) {
    for (std::uint32_t h : surface_.live_half_edges(v)) {
      double accuracy = std::ldexp(1.0, -20);
      for (std::uint32_t c :
           {surface_.corner_of_outgoing(h), surface_.corner_of_incoming(topology_.opposite[h])}) {
        if (c != kNone) accuracy = std::min(accuracy, bridge_accuracy(cuts_.split[c]));
      }
      const double exact = cuts_.distance[v] / norm(surface_.edge_vector(v, topology_.to(h)));
      if (!(exact > 0 && exact < 0.5)) stop_at_precision("vertex " + std::to_string(v));
      const double slack = accuracy * exact;
      cuts_.fraction[2 * topology_.edge_of[h] + (v > topology_.to(h))] =
          shortest_dyadic(exact - slack, exact + slack);
    }
  }

  // The step is that of the lower of the two bridges, so that the strip is a rectangle, and a third
  // of the distance to what lies beyond in the same facet.
  double strip_height(std::uint32_t h) {
    const std::uint32_t tail = surface_.corner_of_outgoing(h);
    const std::uint32_t head = surface_.corners()[tail].next;
    const VertexId v = topology_.from(h), w = topology_.to(h);
    const Vec3 direction = surface_.edge_vector(v, w);
    const double at_tail = cuts_.fraction_at_tail(topology_, h);
    const double at_head = cuts_.fraction_at_tail(topology_, topology_.opposite[h]);
    const std::array<Vec3, 2> part = {add_scaled(surface_.position(v), at_tail, direction),
                                      add_scaled(surface_.position(v), 1 - at_head, direction)};
    const double beyond =
        boundary_.from_edge_part(surface_.corners()[tail].facet, topology_.edge_of[h], part);
    double height = std::min({cuts_.split[tail].step * cuts_.distance[v],
                              cuts_.split[head].step * cuts_.distance[w], beyond / 3});
    if (max_radius_ > 0) height = std::min(height, max_radius_);
    return height;
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const Acuteness& acute_;
  double max_radius_;
  BoundaryDistance boundary_;
  Cuts cuts_;
};

}  // namespace

SplitCorner split_corner(const KeptSurface& surface, const Corner& corner, Predicates& predicates) {
  const SurfaceTopology& topology = surface.topology();
  const VertexId v = corner.vertex;
  const VertexId first = topology.to(corner.outgoing), last = topology.from(corner.incoming);
  const Vec2 a = unit(surface.planar(corner.facet, surface.edge_vector(v, first)));
  const Vec2 b = unit(surface.planar(corner.facet, surface.edge_vector(v, last)));
  const int sine = predicates.orient2d(topology.facet_axis[corner.facet], v, first, last) *
                   topology.facet_axis_sign[corner.facet];
  const bool convex = sine >= 0;
  // Rounding must not split the corners of a hexagon.
  constexpr double kSlack = 1e-9;
  SplitCorner split;
  split.direction[0] = a;
  const Vec2 middle = bisector(a, b, convex);
  double half_sine;
  if (convex && dot(a, b) >= -0.5 - kSlack) {
    split.parts = 1;
    split.direction[1] = b;
    half_sine = cross(a, middle);
  } else if (convex || dot(a, b) <= -0.5 + kSlack) {
    split.parts = 2;
    split.direction[1] = middle;
    split.direction[2] = b;
    half_sine = cross(a, bisector(a, middle, true));
  } else {
    split.parts = 4;
    split.direction = {a, bisector(a, middle, true), middle, bisector(middle, b, true), b};
    half_sine = cross(a, bisector(a, split.direction[1], true));
  }
  split.half_sine = std::clamp(half_sine, 0.0, 1.0);
  const double half_cosine = std::sqrt(1 - split.half_sine * split.half_sine);
  split.step = split.half_sine / (half_cosine + 0.5);
  return split;
}

double bridge_accuracy(const SplitCorner& split) {
  // A fixed fraction of the bridge's edges. In very narrow corners the angles exceed a right angle
  // by no more than half the corner's, so rounding must stay below that.
  constexpr double kFraction = 0x1p-20, kNarrow = 0x1p12;
  return kFraction * split.step * std::min(1.0, kNarrow * split.half_sine);
}

Cuts find_cuts(const KeptSurface& surface, const Acuteness& acute, Predicates& predicates,
               double max_radius, Control& control) {
  return Cutter(surface, acute, max_radius).run(predicates, control);
}

}  // namespace delmesher::chamfer
