#include "mesher/surface/feature_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/vector.h"

namespace delmesher::surface {
namespace {

// Calls `distance` with the points relative to the first one, scaled by a power of two if products
// of four coordinates could leave the range of doubles otherwise.
template <std::size_t N, class Distance>
double in_safe_range(const std::array<Vec3, N>& points, Distance&& distance) {
  std::array<Vec3, N> relative;
  double largest = 0;
  for (std::size_t n = 0; n < N; ++n) {
    relative[n] = subtract(points[n], points[0]);
    for (const double x : relative[n]) largest = std::max(largest, std::fabs(x));
  }
  if (largest == 0) return 0;
  if (largest > 0x1p-128 && largest < 0x1p128) return distance(relative);
  int exponent = 0;
  if (largest > std::numeric_limits<double>::max()) {
    exponent = 1025;
  } else {
    std::frexp(largest, &exponent);
  }
  for (std::size_t n = 0; n < N; ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      // Halved first, because the difference of huge coordinates overflows.
      relative[n][i] = std::ldexp(points[n][i] * 0.5 - points[0][i] * 0.5, 1 - exponent);
    }
  }
  return std::ldexp(distance(relative), exponent);
}

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 u = subtract(b, a), w = subtract(p, a);
  const double along = dot(w, u), all = dot(u, u);
  if (!(along > 0)) return norm(w);
  if (along >= all) return norm(subtract(p, b));
  // From the nearer end, so that the foot is accurate there.
  return 2 * along <= all ? norm(add_scaled(w, -(along / all), u))
                          : norm(add_scaled(subtract(p, b), (all - along) / all, u));
}

// A normal of the triangle that is exactly perpendicular to its longest edge, which starts at
// `anchor`, up to rounding. For needles the cross product alone is not, and the lever of a long
// edge would magnify that.
struct Normal {
  Vec3 anchor, direction;
  double length;

  explicit Normal(const std::array<Vec3, 3>& t) {
    std::size_t i = 0;
    double longest = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 e = subtract(t[(k + 1) % 3], t[k]);
      if (dot(e, e) > longest) {
        longest = dot(e, e);
        i = k;
      }
    }
    anchor = t[i];
    const Vec3 e = subtract(t[(i + 1) % 3], anchor);
    direction = cross(e, subtract(t[(i + 2) % 3], anchor));
    for (int pass = 0; pass < 2 && longest > 0; ++pass) {
      direction = add_scaled(direction, -dot(direction, e) / longest, e);
    }
    length = norm(direction);
  }

  double height(const Vec3& p) const { return dot(direction, subtract(p, anchor)) / length; }
};

double to_triangle(const Vec3& p, const std::array<Vec3, 3>& t, const Normal& n) {
  double best =
      std::min({to_segment(p, t[0], t[1]), to_segment(p, t[1], t[2]), to_segment(p, t[2], t[0])});
  if (!(n.length > 0)) return best;
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(n.direction, cross(subtract(t[(i + 1) % 3], t[i]), subtract(p, t[i]))) < 0) return best;
  }
  return std::min(best, std::fabs(n.height(p)));
}

double between_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double best = std::min(
      {to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Vec3 u = subtract(b, a), v = subtract(d, c), w = subtract(c, a);
  // With cross products the parameters of nearly parallel segments lose half as many digits as
  // with the usual Gram determinant. The distance of actual points is never too small.
  const Vec3 n = cross(u, v);
  const double square = dot(n, n);
  if (!(square > 0)) return best;
  const double s = dot(cross(w, v), n) / square, t = dot(cross(w, u), n) / square;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return best;
  const Vec3 p = add_scaled(a, s, u), q = add_scaled(c, t, v);
  // The two parameters are off by roundings over the sine, each in its own way: below this sine,
  // the points that belong to them do not face each other any more, digit by digit.
  constexpr double kParallel = 1.0 / 16;
  if (square < kParallel * kParallel * dot(u, u) * dot(v, v)) {
    return std::min({best, to_segment(p, c, d), to_segment(q, a, b)});
  }
  return std::min(best, norm(subtract(p, q)));
}

// Closest non-incident elements: the minimum is attained by a vertex and a vertex, edge or facet,
// or by two edges, because a facet's closest point to an element that it does not touch is such a
// point or on one of its edges.
class ClosestElements {
 public:
  ClosestElements(const SurfaceTopology& topology, const PointStore& points, Control& control)
      : topology_(topology), points_(points), control_(control) {}

  double run() {
    for (std::uint32_t e = 0; e < topology_.edge_count(); ++e) {
      const auto [a, b] = topology_.edge_vertices(e);
      best_ = std::min(best_, point_segment_distance(at(a), at(b), at(b)));
      if (topology_.edge_is_flat[e] == 0) edges_.push_back(e);
    }
    examine_vertices();
    examine_edges();
    return best_;
  }

 private:
  Vec3 at(VertexId v) const { return points_.nearest(v); }

  Box box_of(std::span<const VertexId> vertices) const {
    Box box;
    for (const VertexId v : vertices) box.extend({at(v), at(v)});
    return box;
  }

  // Everything closer than the best so far meets this box.
  Box grown(Box box) const {
    for (std::size_t i = 0; i < 3; ++i) {
      box.lo[i] -= best_;
      box.hi[i] += best_;
    }
    return box;
  }

  void examine_vertices() {
    std::vector<VertexId> used;
    std::vector<Box> vertex_boxes, edge_boxes, triangle_boxes;
    for (VertexId v = 0; v < topology_.vertex_half_edge.size(); ++v) {
      if (topology_.vertex_half_edge[v] == kNone) continue;
      used.push_back(v);
      vertex_boxes.push_back({at(v), at(v)});
    }
    for (const std::uint32_t e : edges_) edge_boxes.push_back(box_of(topology_.edge_vertices(e)));
    for (const auto& t : topology_.triangles) triangle_boxes.push_back(box_of(t));
    const BoxTree vertices(vertex_boxes), edges(edge_boxes), triangles(triangle_boxes);
    for (const VertexId v : used) {
      control_.poll();
      const Vec3 p = at(v);
      vertices.query(grown({p, p}), [&](std::uint32_t i) {
        if (used[i] != v)
          best_ = std::min(best_, point_segment_distance(p, at(used[i]), at(used[i])));
        return true;
      });
      edges.query(grown({p, p}), [&](std::uint32_t i) {
        const auto [a, b] = topology_.edge_vertices(edges_[i]);
        if (a != v && b != v) best_ = std::min(best_, point_segment_distance(p, at(a), at(b)));
        return true;
      });
      collect_facets(v);
      triangles.query(grown({p, p}), [&](std::uint32_t t) {
        if (!std::binary_search(facets_.begin(), facets_.end(), topology_.facet_of[t])) {
          best_ = std::min(best_, point_triangle_distance(p, corners(t)));
        }
        return true;
      });
    }
  }

  void examine_edges() {
    std::vector<Box> boxes;
    for (const std::uint32_t e : edges_) boxes.push_back(box_of(topology_.edge_vertices(e)));
    const BoxTree tree(boxes);
    for (std::uint32_t i = 0; i < edges_.size(); ++i) {
      control_.poll();
      const auto [a, b] = topology_.edge_vertices(edges_[i]);
      tree.query(grown(boxes[i]), [&, a = a, b = b](std::uint32_t j) {
        const auto [c, d] = topology_.edge_vertices(edges_[j]);
        if (j > i && a != c && a != d && b != c && b != d) {
          best_ = std::min(best_, segment_segment_distance(at(a), at(b), at(c), at(d)));
        }
        return true;
      });
    }
  }

  void collect_facets(VertexId v) {
    facets_.clear();
    topology_.for_each_outgoing(v, [&](std::uint32_t h) {
      facets_.push_back(topology_.facet_of_half_edge(h));
      return true;
    });
    std::sort(facets_.begin(), facets_.end());
  }

  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto [a, b, c] = topology_.triangles[t];
    return {at(a), at(b), at(c)};
  }

  const SurfaceTopology& topology_;
  const PointStore& points_;
  Control& control_;
  std::vector<std::uint32_t> edges_;  // the non-flat ones
  std::vector<FacetId> facets_;       // of the present vertex
  double best_ = std::numeric_limits<double>::infinity();
};

}  // namespace

double point_segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  return in_safe_range<3>({p, a, b}, [](const auto& x) { return to_segment(x[0], x[1], x[2]); });
}

double point_triangle_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  return in_safe_range<4>({p, t[0], t[1], t[2]}, [](const auto& x) {
    const std::array<Vec3, 3> triangle{x[1], x[2], x[3]};
    return to_triangle(x[0], triangle, Normal(triangle));
  });
}

double segment_segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return in_safe_range<4>({a, b, c, d},
                          [](const auto& x) { return between_segments(x[0], x[1], x[2], x[3]); });
}

double smallest_local_feature_size(const SurfaceTopology& topology, const PointStore& points,
                                   Control& control) {
  return ClosestElements(topology, points, control).run();
}

}  // namespace delmesher::surface
