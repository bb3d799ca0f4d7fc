#include "mesher/surface/triangle_contact.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/box_tree.h"

namespace delmesher::surface {
namespace {

// Absolute components of the normal of triangle abc up to a common factor, in doubles. Differences
// are first scaled by a power of two so that products neither overflow nor underflow, which also
// makes the result independent of the scale of the input.
Vec3 approximate_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 u, v;
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = b[i] * 0.5 - a[i] * 0.5;  // halved: the difference of huge coordinates may overflow
    v[i] = c[i] * 0.5 - a[i] * 0.5;
    largest = std::max({largest, std::fabs(u[i]), std::fabs(v[i])});
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = std::ldexp(u[i], -exponent);
    v[i] = std::ldexp(v[i], -exponent);
  }
  Vec3 normal;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    normal[i] = std::fabs(u[j] * v[k] - u[k] * v[j]);
  }
  return normal;
}

class Contact {
 public:
  explicit Contact(Predicates& predicates) : predicates_(predicates) {}

  // Triangles abc and abd: they can only meet elsewhere by lying in one plane on the same side.
  bool sharing_edge(VertexId a, VertexId b, VertexId c, VertexId d, int axis) {
    return predicates_.orient3d(a, b, c, d) == 0 &&
           predicates_.orient2d(axis, a, b, c) == predicates_.orient2d(axis, a, b, d);
  }

  // Triangles abc and ade. Their intersection is convex and contains a; a ray from a into it leaves
  // it through bc or de, so it is more than a iff bc meets ade or de meets abc.
  bool sharing_vertex(const Corners& s, const Projection& ps, const Corners& t,
                      const Projection& pt) {
    const VertexId b = s[1], c = s[2], d = t[1], e = t[2];
    // Rules out nearly all pairs of a large fan, of which there are many.
    const bool maybe_de = boxes_overlap(d, e, s), maybe_bc = boxes_overlap(b, c, t);
    if (!maybe_de && !maybe_bc) return false;
    const int side_d = side(s, d), side_e = side(s, e);
    if (side_d * side_e > 0) return false;
    if (side_d == 0 && side_e == 0) {
      return (maybe_de && segment_in_plane(d, e, s, ps)) ||
             (maybe_bc && segment_in_plane(b, c, t, pt));
    }
    const int side_b = side(t, b), side_c = side(t, c);
    if (side_b * side_c > 0) return false;
    return (maybe_de && segment(d, e, side_d, side_e, s, ps)) ||
           (maybe_bc && segment(b, c, side_b, side_c, t, pt));
  }

  bool disjoint_corners(const Corners& s, const Projection& ps, const Corners& t,
                        const Projection& pt) {
    std::array<int, 3> of_t, of_s;
    for (std::size_t i = 0; i < 3; ++i) of_t[i] = side(s, t[i]);
    if (one_sided(of_t)) return false;
    if (of_t[0] == 0 && of_t[1] == 0 && of_t[2] == 0) {
      if (contains_in_plane(t, pt, s[0])) return true;
      for (std::size_t i = 0; i < 3; ++i) {
        if (segment_in_plane(t[i], t[(i + 1) % 3], s, ps)) return true;
      }
      return false;
    }
    for (std::size_t i = 0; i < 3; ++i) of_s[i] = side(t, s[i]);
    if (one_sided(of_s)) return false;
    // The planes cross: the common part is a segment, and each of its ends lies on an edge.
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (segment(t[i], t[j], of_t[i], of_t[j], s, ps)) return true;
      if (segment(s[i], s[j], of_s[i], of_s[j], t, pt)) return true;
    }
    return false;
  }

 private:
  int side(const Corners& t, VertexId p) { return predicates_.orient3d(t[0], t[1], t[2], p); }

  static bool one_sided(const std::array<int, 3>& sides) {
    return (sides[0] > 0 && sides[1] > 0 && sides[2] > 0) ||
           (sides[0] < 0 && sides[1] < 0 && sides[2] < 0);
  }

  // Closed segment pq against closed triangle t, given the sides of p and q.
  bool segment(VertexId p, VertexId q, int side_p, int side_q, const Corners& t,
               const Projection& projection) {
    if (side_p * side_q > 0) return false;
    if (side_p == 0 && side_q == 0) return segment_in_plane(p, q, t, projection);
    int seen = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const int o = predicates_.orient3d(p, q, t[i], t[(i + 1) % 3]);
      if (o * seen < 0) return false;
      if (o != 0) seen = o;
    }
    return true;
  }

  bool contains_in_plane(const Corners& t, const Projection& projection, VertexId p) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int o = predicates_.orient2d(projection.axis, t[i], t[(i + 1) % 3], p);
      if (o * projection.sign < 0) return false;
    }
    return true;
  }

  // A segment that crosses no edge is inside or outside as a whole.
  bool segment_in_plane(VertexId p, VertexId q, const Corners& t, const Projection& projection) {
    if (!boxes_overlap(p, q, t)) return false;
    if (contains_in_plane(t, projection, p)) return true;
    for (std::size_t i = 0; i < 3; ++i) {
      if (segments_in_plane(projection.axis, p, q, t[i], t[(i + 1) % 3])) return true;
    }
    return false;
  }

  bool boxes_overlap(VertexId p, VertexId q, const Corners& t) const {
    const PointStore& points = predicates_.points();
    return enclosing_box(points, std::array{p, q}).overlaps(enclosing_box(points, t));
  }

  bool segments_in_plane(int axis, VertexId p, VertexId q, VertexId r, VertexId s) {
    const int o1 = predicates_.orient2d(axis, p, q, r), o2 = predicates_.orient2d(axis, p, q, s);
    if (o1 * o2 > 0) return false;
    if (o1 == 0 && o2 == 0) return overlap_on_a_line(p, q, r, s);
    return predicates_.orient2d(axis, r, s, p) * predicates_.orient2d(axis, r, s, q) <= 0;
  }

  bool overlap_on_a_line(VertexId p, VertexId q, VertexId r, VertexId s) {
    if (predicates_.compare_xyz(p, q) > 0) std::swap(p, q);
    if (predicates_.compare_xyz(r, s) > 0) std::swap(r, s);
    return predicates_.compare_xyz(q, r) >= 0 && predicates_.compare_xyz(s, p) >= 0;
  }

  Predicates& predicates_;
};

// Rotates a triangle so that its corner i comes first: the projection stays valid.
Corners rotated(const Corners& t, std::size_t i) {
  return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

}  // namespace

Projection find_projection(Predicates& predicates, const Corners& triangle) {
  const auto [a, b, c] = triangle;
  const PointStore& points = predicates.points();
  const Vec3 n = approximate_normal(points.nearest(a), points.nearest(b), points.nearest(c));
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int i, int j) {
    return n[static_cast<std::size_t>(i)] > n[static_cast<std::size_t>(j)];
  });
  for (const int axis : axes) {
    const int sign = predicates.orient2d(axis, a, b, c);
    if (sign != 0) return {axis, sign};
  }
  return {axes[0], 0};
}

bool meet_outside_shared(Predicates& predicates, const Corners& s, const Corners& t,
                         const Projection& projection_s, const Projection& projection_t) {
  std::size_t shared = 0, i = 0, j = 0;  // how many, and the last one in s and in t
  std::size_t rest_s = 0, rest_t = 3;    // with two shared: the remaining corners
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(std::find(t.begin(), t.end(), s[k]) - t.begin());
    if (at == 3) {
      rest_s = k;
      continue;
    }
    ++shared;
    i = k;
    j = at;
    rest_t -= std::min(at, rest_t);
  }
  Contact contact(predicates);
  if (shared == 0) return contact.disjoint_corners(s, projection_s, t, projection_t);
  if (shared == 1) {
    return contact.sharing_vertex(rotated(s, i), projection_s, rotated(t, j), projection_t);
  }
  const auto [c, a, b] = rotated(s, rest_s);
  return contact.sharing_edge(a, b, c, t[rest_t], projection_s.axis);
}

bool ray_crosses(Predicates& predicates, VertexId p, int axis, int direction,
                 const Corners& triangle) {
  const int axis_i = (axis + 1) % 3, axis_j = (axis + 2) % 3;
  // Sign of the projected area of a, b and p moved by (eps, eps^2) along axes i and j.
  const auto perturbed = [&](VertexId a, VertexId b) {
    const int o = predicates.orient2d(axis, a, b, p);
    if (o != 0) return o;
    const int along_j = predicates.compare_coordinate(axis_j, a, b);
    return along_j != 0 ? along_j : predicates.compare_coordinate(axis_i, b, a);
  };
  const auto [a, b, c] = triangle;
  const int sign = perturbed(a, b);
  if (sign == 0 || perturbed(b, c) != sign || perturbed(c, a) != sign) return false;
  return predicates.orient3d(a, b, c, p) * sign * direction < 0;
}

}  // namespace delmesher::surface
