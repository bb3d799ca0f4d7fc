#include "mesher/chamfer/kept_surface.h"

#include <algorithm>

#include "mesher/base/check.h"

namespace delmesher::chamfer {

namespace {

FacetFrame frame_of_triangle(std::uint32_t triangle, const std::array<Vec3, 3>& corner) {
  int longest = 0;
  double length = -1;
  for (int k = 0; k < 3; ++k) {
    const double side = squared_norm(subtract(corner[(k + 1) % 3], corner[k]));
    if (side > length) {
      length = side;
      longest = k;
    }
  }
  const Vec3 base = subtract(corner[(longest + 1) % 3], corner[longest]);
  const Vec3 side = subtract(corner[(longest + 2) % 3], corner[longest]);
  const Vec3 up = cross(cross(base, side), base);
  const Vec3 origin{};
  return {add_scaled(origin, 1 / norm(base), base), add_scaled(origin, 1 / norm(up), up), triangle};
}

// An error of the doubles next to a vertex above this share of the surface's extent is too large.
constexpr double kFewDigits = 0x1p-36;

// The square of the smallest height.
double least_height2(const std::array<Vec3, 3>& corner) {
  double longest = 0;
  for (int k = 0; k < 3; ++k) {
    longest = std::max(longest, squared_norm(subtract(corner[(k + 1) % 3], corner[k])));
  }
  const Vec3 normal = cross(subtract(corner[1], corner[0]), subtract(corner[2], corner[0]));
  return squared_norm(normal) / longest;
}

}  // namespace

KeptSurface::KeptSurface(const SurfaceTopology& topology, const PointStore& points,
                         const std::vector<std::uint8_t>& facet_kept)
    : topology_(topology), kept_(facet_kept) {
  if (kept_.empty()) kept_.assign(topology.facet_triangles.size(), 1);
  DELMESHER_CHECK(kept_.size() == topology.facet_triangles.size(),
                  "there are not as many flags as facets");
  edge_is_live_.resize(topology.edge_count());
  for (std::uint32_t e = 0; e < topology.edge_count(); ++e) {
    const auto [h, g] = topology.edge_half_edges(e);
    edge_is_live_[e] = !topology.edge_is_flat[e] && (kept_[topology.facet_of_half_edge(h)] ||
                                                     kept_[topology.facet_of_half_edge(g)]);
  }
  scale_positions(points);
  find_frames();
  find_corners();
}

void KeptSurface::scale_positions(const PointStore& points) {
  const std::size_t count = topology_.vertex_half_edge.size();
  double largest = 0, extent = 0, error = 0;
  for (VertexId v = 0; v < count; ++v) {
    for (double coordinate : points.nearest(v)) largest = std::max(largest, std::abs(coordinate));
    extent = std::max(extent, largest_component(subtract(points.nearest(v), points.nearest(0))));
    error = std::max(error, points.approximation(v).error);
  }
  far_ = error > kFewDigits * extent;
  if (far_) {
    origin_ = points.nearest(0);
    largest = extent;
  }
  int exponent = 0;
  if (largest > 0) std::frexp(largest, &exponent);
  // Within the range in which the scale and its inverse are normal numbers.
  exponent = std::clamp(exponent, -1000, 1000);
  scale_ = std::ldexp(1.0, -exponent);
  position_.reserve(count);
  for (VertexId v = 0; v < count; ++v) position_.push_back(place(points, v));
}

Vec3 KeptSurface::place(const PointStore& points, VertexId v) const {
  Vec3 p = points.nearest(v);
  if (far_) {
    const Approximation rest = points.remainder(v);
    p = add(subtract(p, origin_), Vec3{rest.x, rest.y, rest.z});
  }
  return {scale_ * p[0], scale_ * p[1], scale_ * p[2]};
}

void KeptSurface::find_frames() {
  frame_.resize(kept_.size());
  for (FacetId f = 0; f < kept_.size(); ++f) {
    double best = -1;
    std::array<Vec3, 3> best_corner{};
    std::uint32_t best_triangle = topology_.facet_triangles[f].front();
    for (std::uint32_t t : topology_.facet_triangles[f]) {
      std::array<Vec3, 3> corner;
      for (int k = 0; k < 3; ++k) corner[k] = position_[topology_.triangles[t][k]];
      const double height2 = least_height2(corner);
      if (!(height2 > best)) continue;
      best = height2;
      best_corner = corner;
      best_triangle = t;
    }
    frame_[f] = frame_of_triangle(best_triangle, best_corner);
  }
}

void KeptSurface::find_corners() {
  const SurfaceTopology& t = topology_;
  corner_of_outgoing_.assign(3 * t.triangles.size(), kNone);
  first_corner_.assign(1, 0);
  for (FacetId f = 0; f < kept_.size(); ++f) {
    for (std::uint32_t triangle : t.facet_triangles[f]) {
      for (std::uint32_t start = 3 * triangle; start < 3 * triangle + 3 && kept_[f]; ++start) {
        if (t.edge_is_flat[t.edge_of[start]] || corner_of_outgoing_[start] != kNone) continue;
        const auto first = static_cast<std::uint32_t>(corners_.size());
        std::uint32_t incoming = start;
        do {
          // Around the head of the half-edge to the next boundary edge of the same facet.
          std::uint32_t outgoing = SurfaceTopology::next(incoming);
          while (t.edge_is_flat[t.edge_of[outgoing]]) {
            outgoing = SurfaceTopology::next(t.opposite[outgoing]);
          }
          const auto index = static_cast<std::uint32_t>(corners_.size());
          corner_of_outgoing_[outgoing] = index;
          corners_.push_back({t.from(outgoing), f, outgoing, incoming, index + 1, index - 1});
          incoming = outgoing;
        } while (incoming != start);
        corners_.back().next = first;
        corners_[first].previous = static_cast<std::uint32_t>(corners_.size()) - 1;
      }
    }
    first_corner_.push_back(static_cast<std::uint32_t>(corners_.size()));
  }
}

std::vector<std::uint32_t> KeptSurface::live_half_edges(VertexId v) const {
  std::vector<std::uint32_t> result;
  topology_.for_each_outgoing(v, [&](std::uint32_t h) {
    if (edge_is_live_[topology_.edge_of[h]]) result.push_back(h);
    return true;
  });
  return result;
}

std::vector<std::uint32_t> KeptSurface::fan(const Corner& corner) const {
  std::vector<std::uint32_t> result;
  std::uint32_t h = SurfaceTopology::next(corner.incoming);
  result.push_back(h);
  while (h != corner.outgoing) {
    h = SurfaceTopology::next(topology_.opposite[h]);
    result.push_back(h);
  }
  return result;
}

}  // namespace delmesher::chamfer
