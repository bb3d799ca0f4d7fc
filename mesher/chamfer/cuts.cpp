#include "mesher/chamfer/cuts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "mesher/chamfer/boundary_distance.h"
#include "mesher/chamfer/closest.h"
#include "mesher/geometry/placement.h"

namespace delmesher::chamfer {

namespace {

// Bisector of the sector counter-clockwise from a to b (unit vectors), at most 180 degrees wide if
// `convex`. Each formula is used where it is well conditioned.
Vec2 bisector(Vec2 a, Vec2 b, bool convex) {
  if (dot(a, b) > 0) return unit((convex ? 1.0 : -1.0) * (a + b));
  return unit(turned(a) - turned(b));
}

CornerPart part_between(Vec2 from, Vec2 to, double half_sine) {
  half_sine = std::clamp(half_sine, 0.0, 1.0);
  const double half_cosine = std::sqrt(1 - half_sine * half_sine);
  return {from, to, half_sine, half_sine / (half_cosine + 0.5)};
}

class Cutter {
 public:
  Cutter(const KeptSurface& surface, const Acuteness& acute, const CutOptions& options)
      : surface_(surface),
        topology_(surface.topology()),
        acute_(acute),
        options_(options),
        boundary_(surface) {}

  Cuts run(Predicates& predicates, Control& control) {
    const std::vector<Corner>& corners = surface_.corners();
    cuts_.split.resize(corners.size());
    cuts_.distance.assign(surface_.vertex_count(), 0);
    for (std::uint32_t c = 0; c < corners.size(); ++c) {
      control.poll();
      if (!acute_.vertex[corners[c].vertex]) continue;
      cuts_.split[c] = options_.per_triangle ? split_by_triangles(surface_, corners[c])
                                             : split_corner(surface_, corners[c], predicates);
      bound_distance(c);
    }
    cuts_.fraction.assign(2 * topology_.edge_count(), 0);
    for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
      if (acute_.vertex[v]) cut_edges(v);
    }
    if (options_.per_triangle) even_out_steps();
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
    double bound = (options_.to_link ? distance_to_link(corner)
                                     : boundary_.from_vertex(corner.facet, corner.vertex)) /
                   3;
    // The inner points of a bridge are farther away than its ends.
    if (options_.max_radius > 0) {
      for (const CornerPart& part : cuts_.split[index]) {
        bound = std::min(bound, options_.max_radius / std::sqrt(1 + part.step * part.step));
      }
    }
    double& distance = cuts_.distance[corner.vertex];
    distance = distance > 0 ? std::min(distance, bound) : bound;
  }

  // From the vertex to the opposite edges of the corner's triangles.
  double distance_to_link(const Corner& corner) const {
    double smallest = std::numeric_limits<double>::infinity();
    for (const std::uint32_t h : surface_.fan(corner)) {
      const Vec3& p = surface_.position(topology_.to(h));
      const Vec3& q = surface_.position(topology_.from(SurfaceTopology::previous(h)));
      smallest = std::min(
          smallest, closest_on_segment(surface_.position(corner.vertex), p, q).squared_distance);
    }
    return std::sqrt(smallest);
  }

  // Section 4.2: where a triangle has an acute edge, all points inside it are as far from their
  // edges as the nearest one.
  void even_out_steps() {
    std::vector<double> least(topology_.triangles.size(), std::numeric_limits<double>::infinity());
    const auto for_each_part = [this](auto&& visit) {
      for (std::uint32_t c = 0; c < cuts_.split.size(); ++c) {
        if (cuts_.split[c].empty()) continue;
        const Corner& corner = surface_.corners()[c];
        const std::vector<std::uint32_t> fan = surface_.fan(corner);
        for (std::size_t n = 0; n < fan.size(); ++n) {
          visit(fan[n] / 3, cuts_.split[c][fan.size() - 1 - n], cuts_.distance[corner.vertex]);
        }
      }
    };
    for_each_part([&](std::uint32_t t, const CornerPart& part, double distance) {
      least[t] = std::min(least[t], part.step * distance);
    });
    for_each_part([&](std::uint32_t t, CornerPart& part, double distance) {
      bool acute = false;
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) acute |= acute_.edge[topology_.edge_of[h]];
      if (acute) part.step = least[t] / distance;
    });
  }

  void cut_edges(VertexId v) {
    for (std::uint32_t h : surface_.live_half_edges(v)) {
      double accuracy = std::ldexp(1.0, -20);
      if (const std::uint32_t c = surface_.corner_of_outgoing(h); c != kNone) {
        accuracy = std::min(accuracy, bridge_accuracy(cuts_.split[c].front()));
      }
      if (const std::uint32_t c = surface_.corner_of_incoming(topology_.opposite[h]); c != kNone) {
        accuracy = std::min(accuracy, bridge_accuracy(cuts_.split[c].back()));
      }
      const double exact = cuts_.distance[v] / norm(surface_.edge_vector(v, topology_.to(h)));
      if (!(exact > 0 && exact < 0.5)) stop_at_precision("vertex " + std::to_string(v));
      const double slack = accuracy * exact;
      cuts_.fraction[2 * topology_.edge_of[h] + (v > topology_.to(h))] =
          shortest_dyadic(exact - slack, exact + slack);
    }
  }

  // The height is the step of the lower of the two bridges, so that the strip is a rectangle, but
  // at most a third of the distance to the boundary beyond in the same facet. With a bridge per
  // triangle that is not asked for: the rectangle is inside the edge's own triangle.
  double strip_height(std::uint32_t h) {
    const std::uint32_t tail = surface_.corner_of_outgoing(h);
    const std::uint32_t head = surface_.corners()[tail].next;
    const VertexId v = topology_.from(h), w = topology_.to(h);
    double height = std::min(cuts_.split[tail].front().step * cuts_.distance[v],
                             cuts_.split[head].back().step * cuts_.distance[w]);
    if (!options_.per_triangle) height = std::min(height, distance_beyond(h) / 3);
    if (options_.max_radius > 0) height = std::min(height, options_.max_radius);
    return height;
  }

  double distance_beyond(std::uint32_t h) {
    const VertexId v = topology_.from(h), w = topology_.to(h);
    const Vec3 direction = surface_.edge_vector(v, w);
    const double at_tail = cuts_.fraction_at_tail(topology_, h);
    const double at_head = cuts_.fraction_at_tail(topology_, topology_.opposite[h]);
    const std::array<Vec3, 2> part = {add_scaled(surface_.position(v), at_tail, direction),
                                      add_scaled(surface_.position(v), 1 - at_head, direction)};
    const double beyond =
        boundary_.from_edge_part(topology_.facet_of_half_edge(h), topology_.edge_of[h], part);
    if (!options_.to_link) return beyond;
    const Vec3& apex = surface_.position(topology_.to(SurfaceTopology::next(h)));
    return std::min(
        beyond,
        std::sqrt(
            closest_on_segment(apex, surface_.position(v), surface_.position(w)).squared_distance));
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const Acuteness& acute_;
  const CutOptions& options_;
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
  const Vec2 middle = bisector(a, b, convex);
  if (convex && dot(a, b) >= -0.5 - kSlack) return {part_between(a, b, cross(a, middle))};
  const Vec2 quarter = bisector(a, middle, true);
  if (convex || dot(a, b) <= -0.5 + kSlack) {
    const double half_sine = cross(a, quarter);
    return {part_between(a, middle, half_sine), part_between(middle, b, half_sine)};
  }
  const Vec2 last_quarter = bisector(middle, b, true);
  const double half_sine = cross(a, bisector(a, quarter, true));
  return {part_between(a, quarter, half_sine), part_between(quarter, middle, half_sine),
          part_between(middle, last_quarter, half_sine), part_between(last_quarter, b, half_sine)};
}

SplitCorner split_by_triangles(const KeptSurface& surface, const Corner& corner) {
  const SurfaceTopology& topology = surface.topology();
  const auto direction = [&](VertexId to) {
    return unit(surface.planar(corner.facet, surface.edge_vector(corner.vertex, to)));
  };
  const std::vector<std::uint32_t> fan = surface.fan(corner);
  SplitCorner split;
  for (auto h = fan.rbegin(); h != fan.rend(); ++h) {
    const Vec2 a = direction(topology.to(*h));
    const Vec2 b = direction(topology.from(SurfaceTopology::previous(*h)));
    split.push_back(part_between(a, b, cross(a, bisector(a, b, true))));
  }
  return split;
}

double bridge_accuracy(const CornerPart& part) {
  // A fixed fraction of the bridge's edges. In very narrow corners the angles exceed a right angle
  // by no more than half the corner's, so rounding must stay below that.
  constexpr double kFraction = 0x1p-20, kNarrow = 0x1p12;
  return kFraction * part.step * std::min(1.0, kNarrow * part.half_sine);
}

Cuts find_cuts(const KeptSurface& surface, const Acuteness& acute, Predicates& predicates,
               const CutOptions& options, Control& control) {
  return Cutter(surface, acute, options).run(predicates, control);
}

}  // namespace delmesher::chamfer
