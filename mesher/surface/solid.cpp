#include "mesher/surface/solid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "mesher/arithmetic/bounded.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/exact_point.h"
#include "mesher/surface/approximate_plane.h"
#include "mesher/surface/tetrahedron_contact.h"
#include "mesher/surface/triangle_contact.h"

namespace delmesher::surface {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Tetrahedron = std::array<VertexId, 4>;

// The faces of a positive tetrahedron, seen from inside counter-clockwise.
constexpr int kInwardFaces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

// At least one unit in the last place beyond, whatever the rounding of the first operation.
double lower(double x, double error) {
  const double y = x - error;
  return y - (std::fabs(y) * 0x1p-51 + 0x1p-1050);
}
double upper(double x, double error) {
  const double y = x + error;
  return y + (std::fabs(y) * 0x1p-51 + 0x1p-1050);
}

// Around the tetrahedron, slightly larger if its corners are rounded.
Box closed_box(const PointStore& points, const Tetrahedron& tetrahedron) {
  Box box;
  for (const VertexId v : tetrahedron) {
    const Approximation& a = points.approximation(v);
    if (a.error == 0) {
      box.extend({{a.x, a.y, a.z}, {a.x, a.y, a.z}});
    } else {
      box.extend({{lower(a.x, a.error), lower(a.y, a.error), lower(a.z, a.error)},
                  {upper(a.x, a.error), upper(a.y, a.error), upper(a.z, a.error)}});
    }
  }
  return box;
}

DyadicPoint operator-(const DyadicPoint& a, const DyadicPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// ray_crosses() for a point that is not a double: the same decisions in exact arithmetic.
bool exact_ray_crosses(const DyadicPoint& p, std::size_t axis, int direction,
                       const std::array<DyadicPoint, 3>& triangle) {
  const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
  const std::array<DyadicPoint, 3> r{triangle[0] - p, triangle[1] - p, triangle[2] - p};
  const auto perturbed = [&](const DyadicPoint& a, const DyadicPoint& b) {
    const int o = (a[i] * b[j] - a[j] * b[i]).sign();
    if (o != 0) return o;
    const int along_j = (a[j] - b[j]).sign();
    return along_j != 0 ? along_j : (b[i] - a[i]).sign();
  };
  const int sign = perturbed(r[0], r[1]);
  if (sign == 0 || perturbed(r[1], r[2]) != sign || perturbed(r[2], r[0]) != sign) return false;
  // orient3d(a, b, c, p) = -det(a - p, b - p, c - p).
  Dyadic determinant;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
    determinant = determinant + r[0][k] * (r[1][l] * r[2][m] - r[1][m] * r[2][l]);
  }
  return -determinant.sign() * sign * direction < 0;
}

// The planes of a tetrahedron's faces, to reject triangles beyond one of them.
class TetrahedronFaces {
 public:
  TetrahedronFaces(Predicates& predicates, const Tetrahedron& tetrahedron)
      : predicates_(predicates), corner_(tetrahedron) {
    const PointStore& points = predicates.points();
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& face = kInwardFaces[k];
      plane_[k] = {points.approximation(corner_[static_cast<std::size_t>(face[0])]),
                   points.approximation(corner_[static_cast<std::size_t>(face[1])]),
                   points.approximation(corner_[static_cast<std::size_t>(face[2])])};
    }
  }

  // Is no corner of the triangle on the inner side of some face?
  bool separate(const std::array<VertexId, 3>& triangle) const {
    for (std::size_t k = 0; k < 4; ++k) {
      if (std::ranges::all_of(triangle, [&](VertexId v) { return !is_inside(k, v); })) return true;
    }
    return false;
  }

 private:
  bool is_inside(std::size_t face, VertexId v) const {
    const int side = plane_[face].side(predicates_.points().approximation(v));
    if (side != 0) return side > 0;
    const auto corner = std::ranges::find(corner_, v);
    if (corner != corner_.end()) return corner - corner_.begin() == std::ptrdiff_t(face);
    std::array<VertexId, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = corner_[static_cast<std::size_t>(kInwardFaces[face][i])];
    }
    return predicates_.orient3d(c[0], c[1], c[2], v) > 0;
  }

  Predicates& predicates_;
  Tetrahedron corner_;
  std::array<ApproximatePlane, 4> plane_;
};

// A triangle that may cut tetrahedra, with planes that reject most of them without exact
// arithmetic: its own, and one through each edge, orthogonal to it except for rounding.
class CuttingTriangle {
 public:
  CuttingTriangle(const SurfaceTopology& topology, const PointStore& points, std::uint32_t t)
      : corner_(topology.triangles[t]) {
    std::array<Approximation, 3> p;
    std::array<Vec3, 3> x;
    for (std::size_t i = 0; i < 3; ++i) {
      line_[i] = topology.edge_of[3 * t + i];
      p[i] = points.approximation(corner_[i]);
      x[i] = {p[i].x, p[i].y, p[i].z};
    }
    plane_ = {p[0], p[1], p[2]};
    const Vec3 u = subtract(x[1], x[0]), normal = cross(u, subtract(x[2], x[0]));
    const double scale = norm(u) / norm(normal);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      const Approximation above{x[i][0] + scale * normal[0], x[i][1] + scale * normal[1],
                                x[i][2] + scale * normal[2], 0};
      fence_[i] = {p[i], p[j], above};
      has_fence_[i] = fence_[i].side(p[k]) < 0;
    }
  }

  const ApproximatePlane& plane() const { return plane_; }

  // Is there an edge with no corner of the tetrahedron on this side of it? False if in doubt.
  bool is_apart(const PointStore& points, const Tetrahedron& tetrahedron) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (has_fence_[i] && std::ranges::all_of(tetrahedron, [&](VertexId v) {
            const int side = fence_[i].side(points.approximation(v));
            return side != 0 ? side > 0 : is_on_edge(points, i, v);
          })) {
        return true;
      }
    }
    return false;
  }

 private:
  bool is_on_edge(const PointStore& points, std::size_t i, VertexId v) const {
    const auto lines = points.lines(v);
    return v == corner_[i] || v == corner_[(i + 1) % 3] ||
           std::binary_search(lines.begin(), lines.end(), line_[i]);
  }

  std::array<VertexId, 3> corner_;
  std::array<std::uint32_t, 3> line_{};  // edge i is from corner i to the next
  ApproximatePlane plane_;
  std::array<ApproximatePlane, 3> fence_;
  std::array<bool, 3> has_fence_{};
};

// Is the double point certainly inside the tetrahedron? Running error bounds, no exact stage.
bool certainly_inside(const PointStore& points, const Tetrahedron& tetrahedron, const Vec3& p) {
  std::array<std::array<Bounded, 3>, 4> r;
  for (std::size_t k = 0; k < 4; ++k) {
    const Approximation& a = points.approximation(tetrahedron[k]);
    const std::array<double, 3> x{a.x, a.y, a.z};
    for (std::size_t i = 0; i < 3; ++i) r[k][i] = Bounded{x[i], a.error} - Bounded{p[i], 0};
  }
  for (const auto& face : kInwardFaces) {
    const auto &a = r[static_cast<std::size_t>(face[0])], &b = r[static_cast<std::size_t>(face[1])],
               &c = r[static_cast<std::size_t>(face[2])];
    const Bounded determinant = a[0] * (b[1] * c[2] - b[2] * c[1]) +
                                a[1] * (b[2] * c[0] - b[0] * c[2]) +
                                a[2] * (b[0] * c[1] - b[1] * c[0]);
    if (determinant.sign() != -1) return false;
  }
  return true;
}

// The triangles that meet one of the boxes; all triangles if there are no boxes.
std::vector<std::uint32_t> cutting_triangles(std::span<const Box> triangles,
                                             std::span<const Box> open) {
  const BoxTree where(open);
  std::vector<std::uint32_t> result;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const bool elsewhere = where.query(triangles[t], [](std::uint32_t) { return false; });
    if (open.empty() || !elsewhere) result.push_back(t);
  }
  return result;
}

std::vector<Box> boxes_of(std::span<const std::uint32_t> items, std::span<const Box> boxes) {
  std::vector<Box> result;
  result.reserve(items.size());
  for (const std::uint32_t i : items) result.push_back(boxes[i]);
  return result;
}

}  // namespace

// Data that never change, shared by all threads.
struct Solid::Shared {
  Shared(const SurfaceTopology& surface, const PointStore& points, std::span<const Box> boxes,
         std::span<const Box> open)
      : topology(surface),
        tree(boxes),
        cutting(cutting_triangles(boxes, open)),
        cutting_tree(boxes_of(cutting, boxes)) {
    triangle.reserve(cutting.size());
    for (const std::uint32_t t : cutting) triangle.emplace_back(surface, points, t);
  }

  const SurfaceTopology& topology;
  BoxTree tree;                        // of all triangles
  std::vector<std::uint32_t> cutting;  // triangles that may meet the interior of a tetrahedron
  BoxTree cutting_tree;                // of these
  std::vector<CuttingTriangle> triangle;
};

struct Solid::Impl {
  Impl(std::shared_ptr<const Shared> data, Predicates& mesh_predicates)
      : shared(std::move(data)), predicates(mesh_predicates) {
    const std::size_t n = topology.vertex_half_edge.size();
    input.reserve(n + 1);
    input.copy_corners(predicates.points(), n);
  }

  Cut cut(const Tetrahedron& tetrahedron) {
    const PointStore& points = predicates.points();
    std::optional<TetrahedronFaces> faces;
    Cut result;
    const auto passes_by = [&](std::uint32_t n) {
      const CuttingTriangle& triangle = shared->triangle[n];
      const std::uint32_t t = shared->cutting[n];
      const Position position = position_of(tetrahedron, t, triangle.plane());
      if (position.one_side && !position.has_face()) return true;
      if (triangle.is_apart(points, tetrahedron)) return true;
      for (unsigned i = 0; position.has_face() && i < 4; ++i) {
        if ((position.near | 1U << i) == 0b1111) result.faces |= 1U << i;
      }
      if (position.one_side) return true;
      if (!faces) faces.emplace(predicates, tetrahedron);
      return faces->separate(topology.triangles[t]) ||
             !meets_interior(predicates, tetrahedron, topology.triangles[t]);
    };
    result.straddles = !shared->cutting_tree.query(closed_box(points, tetrahedron), passes_by);
    return result;
  }

  bool is_inside(const Tetrahedron& tetrahedron) {
    if (tree.empty()) return false;
    const PointStore& points = predicates.points();
    Vec3 center{0, 0, 0};
    for (const VertexId v : tetrahedron) {
      const Vec3 p = points.nearest(v);
      for (std::size_t i = 0; i < 3; ++i) center[i] += 0.25 * p[i];
    }
    return certainly_inside(points, tetrahedron, center) ? contains(center)
                                                         : contains_centroid(tetrahedron);
  }

  // Of a tetrahedron and the plane of a triangle.
  struct Position {
    unsigned near = 0;      // its corners that are not certainly off the plane, by bit; some of
                            // them if it has corners on both sides
    bool one_side = false;  // no corner is off the plane on the other side; false if in doubt
    bool has_face() const { return std::popcount(near) >= 3; }  // that may be in the plane
  };

  Position position_of(const Tetrahedron& tetrahedron, std::uint32_t t,
                       const ApproximatePlane& plane) const {
    const PointStore& points = predicates.points();
    const PlaneId own = topology.facet_plane[topology.facet_of[t]];
    Position result;
    bool above = false, below = false, known = true;
    for (unsigned k = 0; k < 4 && !(above && below); ++k) {
      const int side = plane.side(points.approximation(tetrahedron[k]));
      above |= side > 0;
      below |= side < 0;
      if (side != 0) continue;
      result.near |= 1U << k;
      const auto planes = points.planes(tetrahedron[k]);
      known = known && std::binary_search(planes.begin(), planes.end(), own);
    }
    result.one_side = known && above != below;
    return result;
  }

  struct Ray {
    std::size_t axis = 0;
    int direction = 1;
    Box box;  // of the doubles that the ray may meet
  };

  // From a point within the box towards the nearest side of the solid's bounding box.
  Ray shortest_ray(const Box& start) const {
    const Box& all = tree.node(0).box;
    Ray ray;
    double least = kInfinity;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int direction : {1, -1}) {
        const double length = direction > 0 ? all.hi[axis] * 0.5 - start.lo[axis] * 0.5
                                            : start.hi[axis] * 0.5 - all.lo[axis] * 0.5;
        if (length >= least) continue;
        least = length;
        ray.axis = axis;
        ray.direction = direction;
      }
    }
    ray.box = start;
    (ray.direction > 0 ? ray.box.hi : ray.box.lo)[ray.axis] = ray.direction * kInfinity;
    return ray;
  }

  // For a point off the surface.
  bool contains(const Vec3& p) {
    const Box start{p, p};
    if (!tree.node(0).box.overlaps(start)) return false;
    const Ray ray = shortest_ray(start);
    const VertexId id = input.add_explicit(p[0], p[1], p[2]);
    bool inside = false;
    tree.query(ray.box, [&](std::uint32_t t) {
      inside ^= ray_crosses(input_predicates, id, static_cast<int>(ray.axis), ray.direction,
                            topology.triangles[t]);
      return true;
    });
    input.pop_back();
    return inside;
  }

  // All coordinates times the same number, and four: the sum of the corners is the centroid then.
  bool centroid_ray_crosses(const Tetrahedron& tetrahedron, const Ray& ray,
                            const std::array<VertexId, 3>& triangle) const {
    std::array<VertexId, 7> ids;
    std::copy(tetrahedron.begin(), tetrahedron.end(), ids.begin());
    std::copy(triangle.begin(), triangle.end(), ids.begin() + 4);
    const std::vector<DyadicPoint> exact = scaled_exact_points(predicates.points(), ids);
    const auto sum = [&](std::size_t i) {
      return exact[0][i] + exact[1][i] + exact[2][i] + exact[3][i];
    };
    const Dyadic four = Dyadic::from_double(4);
    const auto corner = [&](std::size_t n) {
      return DyadicPoint{exact[n][0] * four, exact[n][1] * four, exact[n][2] * four};
    };
    return exact_ray_crosses({sum(0), sum(1), sum(2)}, ray.axis, ray.direction,
                             {corner(4), corner(5), corner(6)});
  }

  // For tetrahedra so thin that the rounded centroid is not certainly inside.
  bool contains_centroid(const Tetrahedron& tetrahedron) {
    const PointStore& points = predicates.points();
    Box start;
    for (std::size_t i = 0; i < 3; ++i) {
      Dyadic sum;
      for (const VertexId v : tetrahedron) sum = sum + dyadic_point(points, v)[i];
      const double middle = round_to_double(sum * Dyadic::from_double(0.25)).value;
      start.lo[i] = std::nextafter(middle, -kInfinity);
      start.hi[i] = std::nextafter(middle, kInfinity);
    }
    const Ray ray = shortest_ray(start);
    bool inside = false;
    tree.query(ray.box, [&](std::uint32_t t) {
      inside ^= centroid_ray_crosses(tetrahedron, ray, topology.triangles[t]);
      return true;
    });
    return inside;
  }

  const std::shared_ptr<const Shared> shared;
  const SurfaceTopology& topology = shared->topology;
  const BoxTree& tree = shared->tree;
  Predicates& predicates;  // of the mesh's points
  // A copy of the input vertices, with room for the start of a ray.
  PointStore input;
  Predicates input_predicates{input};
};

Solid::Solid(const SurfaceTopology& topology, Predicates& predicates, std::span<const Box> open)
    : impl_(std::make_unique<Impl>(
          std::make_shared<const Shared>(topology, predicates.points(),
                                         triangle_boxes(topology, predicates.points()), open),
          predicates)) {}

Solid::Solid(const Solid& other, Predicates& predicates)
    : impl_(std::make_unique<Impl>(other.impl_->shared, predicates)) {}

Solid::~Solid() = default;

Solid::Cut Solid::cut(const std::array<VertexId, 4>& tetrahedron) {
  return impl_->cut(tetrahedron);
}

bool Solid::is_inside(const std::array<VertexId, 4>& tetrahedron) {
  return impl_->is_inside(tetrahedron);
}

Side Solid::classify(const std::array<VertexId, 4>& tetrahedron) {
  if (impl_->cut(tetrahedron).straddles) return Side::straddling;
  return impl_->is_inside(tetrahedron) ? Side::inside : Side::outside;
}

}  // namespace delmesher::surface
