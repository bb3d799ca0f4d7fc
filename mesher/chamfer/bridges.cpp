#include "mesher/chamfer/bridges.h"

#include <cmath>
#include <string>

#include "mesher/base/check.h"
#include "mesher/geometry/placement.h"

namespace delmesher::chamfer {

VertexId NewPoints::add(const NewPoint& point) {
  list_.push_back(point);
  append(point);
  return static_cast<VertexId>(points_.size()) - 1;
}

void NewPoints::append(const NewPoint& point) {
  const PointDefinition& d = point.definition;
  if (point.edge == kNone) {
    const VertexId id = points_.add_on_triangle(d.corner[0], d.corner[1], d.corner[2], d.u, d.v);
    const PlaneId planes[] = {topology_.facet_plane[point.facet]};
    points_.set_supports(id, planes, {});
    return;
  }
  const VertexId id = points_.add_on_segment(d.corner[0], d.corner[1], d.u);
  points_.set_supports(id, topology_.edge_planes(point.edge), {&point.edge, 1});
}

std::vector<VertexId> NewPoints::keep(const std::vector<std::uint8_t>& used) {
  std::vector<VertexId> id(used.size());
  for (VertexId v = 0; v < first_; ++v) id[v] = v;
  points_.truncate(first_);
  std::vector<NewPoint> kept;
  for (VertexId v = first_; v < used.size(); ++v) {
    id[v] = kNone;
    if (!used[v]) continue;
    append(list_[v - first_]);
    id[v] = static_cast<VertexId>(points_.size()) - 1;
    kept.push_back(list_[v - first_]);
  }
  list_ = std::move(kept);
  return id;
}

std::vector<VertexId> NewPoints::vertices() const {
  std::vector<VertexId> result;
  result.reserve(list_.size());
  for (const NewPoint& point : list_) result.push_back(point.vertex);
  return result;
}

namespace {

class BridgeBuilder {
 public:
  BridgeBuilder(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                const Thresholds& thresholds, NewPoints& new_points)
      : surface_(surface),
        topology_(surface.topology()),
        acute_(acute),
        cuts_(cuts),
        thresholds_(thresholds),
        new_points_(new_points) {}

  Bridges run(Control& control) {
    bridges_.edge_end.assign(2 * topology_.edge_count(), kNone);
    bridges_.chain.resize(surface_.corners().size());
    // By vertex, so that neighbouring points get neighbouring ids.
    for (VertexId v = 0; v < surface_.vertex_count(); ++v) {
      control.poll();
      const std::vector<std::uint32_t> spokes = surface_.live_half_edges(v);
      for (std::uint32_t h : spokes) place_edge_end(h);
      if (!acute_.vertex[v]) continue;
      for (std::uint32_t h : spokes) {
        const std::uint32_t corner = surface_.corner_of_outgoing(h);
        if (corner != kNone) build_chain(corner);
      }
    }
    return std::move(bridges_);
  }

 private:
  void place_edge_end(std::uint32_t h) {
    const std::uint32_t e = topology_.edge_of[h];
    const VertexId v = topology_.from(h), w = topology_.to(h);
    if (acute_.edge[e]) return;
    VertexId& end = bridges_.edge_end[2 * e + (v > w)];
    if (!acute_.vertex[v]) {
      end = v;
      return;
    }
    const double t = cuts_.fraction_at_tail(topology_, h);
    DELMESHER_CHECK(t > 0 && t < 0.5,
                    "an edge is cut elsewhere than between its end and its middle");
    end = new_points_.add({{PointKind::on_segment, {w, v, kNone}, t, 0}, v, kNone, e});
  }

  void build_chain(std::uint32_t index) {
    const Corner& corner = surface_.corners()[index];
    const SplitCorner& split = cuts_.split[index];
    const double distance = cuts_.distance[corner.vertex];
    std::vector<VertexId>& chain = bridges_.chain[index];

    const std::uint32_t back = topology_.opposite[corner.incoming];  // incoming, away from here
    const VertexId first = bridges_.edge_end_at_tail(topology_, corner.outgoing);
    if (first != kNone) chain.push_back(first);
    for (const CornerPart& part : split) {
      const bool at_outgoing = &part == &split.front(), at_incoming = &part == &split.back();
      const Vec2 a = part.from, b = part.to;
      const double step = part.step * distance;
      const double accuracy = bridge_accuracy(part) * distance;
      const Vec2 p = at_outgoing ? beside_edge(corner, corner.outgoing, a, step)
                                 : distance * a + step * turned(a);
      const Vec2 q =
          at_incoming ? beside_edge(corner, back, b, step) : distance * b - step * turned(b);
      chain.push_back(place(corner, p, accuracy));
      chain.push_back(place(corner, q, accuracy));
    }
    const VertexId last = bridges_.edge_end_at_tail(topology_, back);
    if (last != kNone) chain.push_back(last);
  }

  // The bridge point next to the cut of half-edge h, which leaves the corner's vertex in the given
  // direction: orthogonally off the edge, to the corner's side.
  Vec2 beside_edge(const Corner& corner, std::uint32_t h, Vec2 direction, double step) const {
    const bool outgoing = h == corner.outgoing;
    const Vec3 edge = surface_.edge_vector(corner.vertex, topology_.to(h));
    const double along = cuts_.fraction_at_tail(topology_, h) * norm(edge);
    const Vec2 inward = outgoing ? turned(direction) : -1.0 * turned(direction);
    if (acute_.edge[topology_.edge_of[h]]) {
      const double height = cuts_.height[outgoing ? h : corner.incoming];
      return along * direction + height * inward;
    }
    // Where the threshold is a right angle, rounding must not leave less: lean towards the vertex
    // by more than the points' accuracy.
    constexpr double kLean = 0x1p-18;
    const bool lean = thresholds_.with_facets < kLean;
    return (along - (lean ? kLean * step : 0)) * direction + step * inward;
  }

  VertexId place(const Corner& corner, Vec2 target, double accuracy) {
    return new_points_.add({anchor(corner, target, accuracy), corner.vertex, corner.facet, kNone});
  }

  // Gives the point (relative to the corner's vertex) by coordinates in a triangle of the fan that
  // contains it near the vertex, or in a better shaped one of the fan, or of the facet.
  PointDefinition anchor(const Corner& corner, Vec2 target, double accuracy) const {
    constexpr double kGoodSine = 0.1, kPoorSine = 0x1p-12;
    std::uint32_t best = kNone;
    double best_sine = -1;
    for (std::uint32_t h : surface_.fan(corner)) {
      const Vec2 b = planar_edge(corner, topology_.to(h));
      const Vec2 c = planar_edge(corner, topology_.from(SurfaceTopology::previous(h)));
      double sine = cross(b, c) / (norm(b) * norm(c));
      const bool contains = cross(b, target) >= 0 && cross(target, c) >= 0;
      if (contains && sine >= kGoodSine) sine = 2;
      if (sine <= best_sine) continue;
      best_sine = sine;
      best = h;
    }
    if (best_sine < kPoorSine) return anchor_in_frame(corner, target, accuracy);
    const VertexId b = topology_.to(best), c = topology_.from(SurfaceTopology::previous(best));
    return in_triangle(b, c, corner.vertex, planar_edge(corner, b), planar_edge(corner, c), target,
                       accuracy);
  }

  PointDefinition anchor_in_frame(const Corner& corner, Vec2 target, double accuracy) const {
    const std::uint32_t triangle = surface_.frame(corner.facet).triangle;
    int nearest = 0;
    double nearest_distance = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double there = norm(planar_edge(corner, topology_.triangles[triangle][k]) - target);
      if (there >= nearest_distance) continue;
      nearest_distance = there;
      nearest = k;
    }
    const VertexId r = topology_.triangles[triangle][nearest];
    const VertexId b = topology_.triangles[triangle][(nearest + 1) % 3];
    const VertexId c = topology_.triangles[triangle][(nearest + 2) % 3];
    const Vec2 origin = planar_edge(corner, r);
    const auto from_r = [&](VertexId v) {
      return surface_.planar(corner.facet, surface_.edge_vector(r, v));
    };
    return in_triangle(b, c, r, from_r(b), from_r(c), target - origin, accuracy);
  }

  // Fails in triangles so thin that products of their coordinates underflow.
  static PointDefinition in_triangle(VertexId p, VertexId q, VertexId r, Vec2 b, Vec2 c,
                                     Vec2 target, double accuracy) {
    const double area = cross(b, c);
    const double u = cross(target, c) / area, v = cross(b, target) / area;
    if (!std::isfinite(u) || !std::isfinite(v)) stop_at_precision("vertex " + std::to_string(r));
    const double u_slack = accuracy / (2 * norm(b)), v_slack = accuracy / (2 * norm(c));
    return {PointKind::on_triangle,
            {p, q, r},
            shortest_dyadic(u - u_slack, u + u_slack),
            shortest_dyadic(v - v_slack, v + v_slack)};
  }

  Vec2 planar_edge(const Corner& corner, VertexId to) const {
    return surface_.planar(corner.facet, surface_.edge_vector(corner.vertex, to));
  }

  const KeptSurface& surface_;
  const SurfaceTopology& topology_;
  const Acuteness& acute_;
  const Cuts& cuts_;
  const Thresholds& thresholds_;
  NewPoints& new_points_;
  Bridges bridges_;
};

}  // namespace

Bridges build_bridges(const KeptSurface& surface, const Acuteness& acute, const Cuts& cuts,
                      const Thresholds& thresholds, NewPoints& new_points, Control& control) {
  return BridgeBuilder(surface, acute, cuts, thresholds, new_points).run(control);
}

}  // namespace delmesher::chamfer
