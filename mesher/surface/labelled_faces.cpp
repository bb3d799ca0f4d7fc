#include "mesher/delmesher/labelled_faces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "mesher/base/control.h"
#include "mesher/base/disjoint_sets.h"
#include "mesher/base/guarded.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/half_edges.h"

namespace delmesher::surface {
namespace {

Status defect_of(const Surface& surface, double degrees) {
  if (!(degrees > 0 && degrees <= 90)) {
    return {StatusCode::invalid_options, "the angle of labels is above 0 and at most 90 degrees"};
  }
  const auto& labels = surface.labels;
  if (std::adjacent_find(labels.begin(), labels.end(), std::not_equal_to<>()) != labels.end()) {
    return {StatusCode::invalid_options,
            "the surface has labels already; an angle labels surfaces that have none"};
  }
  for (const auto& p : surface.vertices) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      return {StatusCode::invalid_surface, "a vertex is not finite"};
    }
  }
  for (const auto& corners : surface.triangles) {
    for (const std::uint32_t v : corners) {
      if (v >= surface.vertices.size()) {
        return {StatusCode::invalid_surface, "a triangle has a vertex that is not there"};
      }
    }
  }
  return {};
}

// Of a surface without a defect.
std::vector<std::int32_t> labels_by_angle(const Surface& surface, double degrees) {
  PointStore points;
  for (const auto& [x, y, z] : surface.vertices) points.add_explicit(x, y, z);
  Predicates predicates(points);
  const double cosine = cosine_squared(degrees);
  const auto corner = [&](std::uint32_t h, std::uint32_t ahead) {
    return surface.triangles[h / 3][(h + ahead) % 3];
  };
  DisjointSets faces(surface.triangles.size());
  const HalfEdgeGroups edges(surface.triangles, surface.vertices.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges[e].size() != 2) continue;
    const std::uint32_t h = edges[e][0], g = edges[e][1];
    if (corner(h, 0) != corner(g, 1) || corner(h, 1) != corner(g, 0)) continue;
    if (predicates.bends_below(corner(h, 2), corner(g, 2), corner(h, 0), corner(h, 1), cosine)) {
      faces.join(h / 3, g / 3);
    }
  }
  std::vector<std::int32_t> labels(surface.triangles.size());
  std::int32_t last = 0;
  for (std::uint32_t t = 0; t < labels.size(); ++t) {
    const std::uint32_t first = faces.smallest(t);
    labels[t] = first == t ? ++last : labels[first];
  }
  return labels;
}

// A face of the surface while it is measured.
class Measured {
 public:
  Measured(const Surface& surface, const std::vector<std::uint32_t>& triangles)
      : surface_(surface), triangles_(triangles) {
    for (const std::uint32_t t : triangles) {
      const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
      area_vectors_.push_back(cross(subtract(b, a), subtract(c, a)));
      area_ += norm(area_vectors_.back()) / 2;
    }
  }

  LabelledFace face() {
    LabelledFace face{.triangles = triangles_.size(), .area = area_};
    face.lower = face.upper = corner(triangles_[0], 0);
    for_each_corner([&](const Vec3& p) {
      for (std::size_t i = 0; i < 3; ++i) {
        face.lower[i] = std::min(face.lower[i], p[i]);
        face.upper[i] = std::max(face.upper[i], p[i]);
      }
    });
    const double tolerance = kTolerance * distance(face.lower, face.upper);
    Vec3 sum{};
    for (const Vec3& normal : area_vectors_) sum = add(sum, normal);
    if (to_unit(sum) && is_flat(sum, tolerance)) {
      face.shape = LabelledFace::Shape::planar;
      face.direction = sum;
    } else if (Vec3 axis = likely_axis(); to_unit(axis) && is_round(axis, tolerance)) {
      face.shape = LabelledFace::Shape::cylindrical;
      const double along = *std::max_element(
          axis.begin(), axis.end(), [](double a, double b) { return std::fabs(a) < std::fabs(b); });
      face.direction = along < 0 ? subtract({}, axis) : axis;
    }
    return face;
  }

 private:
  static constexpr double kTolerance = 1e-3;

  const Vec3& corner(std::uint32_t t, std::size_t k) const {
    return surface_.vertices[surface_.triangles[t][k]];
  }
  template <class Visit>
  void for_each_corner(const Visit& visit) const {
    for (const std::uint32_t t : triangles_) {
      for (std::size_t k = 0; k < 3; ++k) visit(corner(t, k));
    }
  }
  static bool to_unit(Vec3& v) {
    const double length = norm(v);
    for (double& x : v) x /= length;
    return std::isfinite(v[0] + v[1] + v[2]);
  }

  bool is_flat(const Vec3& normal, double tolerance) const {
    const Vec3& origin = corner(triangles_[0], 0);
    double lowest = 0, highest = 0;
    for_each_corner([&](const Vec3& p) {
      const double height = dot(normal, subtract(p, origin));
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    });
    return highest - lowest <= tolerance;
  }

  // Two normals of a cylinder span the plane across its axis.
  Vec3 likely_axis() const {
    const Vec3& first = *std::max_element(
        area_vectors_.begin(), area_vectors_.end(),
        [](const Vec3& a, const Vec3& b) { return squared_norm(a) < squared_norm(b); });
    Vec3 axis{};
    for (const Vec3& normal : area_vectors_) {
      const Vec3 across = cross(first, normal);
      axis = add_scaled(axis, dot(axis, across) < 0 ? -1 : 1, across);
    }
    return axis;
  }

  // Are the corners as far from a line along the axis, and the triangles along it? Two strips are
  // on a cylinder in any case, so there must be three.
  bool is_round(const Vec3& axis, double tolerance) const {
    double along_axis = 0;
    std::vector<Vec3> strips;  // their normals, at most three
    for (Vec3 normal : area_vectors_) {
      along_axis += std::fabs(dot(normal, axis)) / 2;
      if (norm(normal) <= kTolerance * area_ || strips.size() == 3 || !to_unit(normal)) continue;
      if (std::all_of(strips.begin(), strips.end(), [&](const Vec3& strip) {
            return distance(strip, normal) > 10 * kTolerance;
          })) {
        strips.push_back(normal);
      }
    }
    if (along_axis > kTolerance * area_ || strips.size() < 3) return false;

    Vec3 u = cross(axis, strips[0]);
    if (!to_unit(u)) return false;
    const Vec3 v = cross(axis, u);
    Vec3 middle{};
    for_each_corner([&](const Vec3& p) { middle = add(middle, p); });
    for (double& x : middle) x /= static_cast<double>(3 * triangles_.size());
    const auto across = [&](const Vec3& p) {
      const Vec3 d = subtract(p, middle);
      return Vec2{dot(u, d), dot(v, d)};
    };
    // The circle of least squares (Kasa 1976), whose equation is linear in its centre.
    double uu = 0, uv = 0, vv = 0, right_u = 0, right_v = 0;
    for_each_corner([&](const Vec3& p) {
      const Vec2 q = across(p);
      const double square = dot(q, q);
      uu += q.x * q.x;
      uv += q.x * q.y;
      vv += q.y * q.y;
      right_u += q.x * square / 2;
      right_v += q.y * square / 2;
    });
    const double determinant = uu * vv - uv * uv;
    const Vec2 centre{(right_u * vv - right_v * uv) / determinant,
                      (right_v * uu - right_u * uv) / determinant};
    const double radius =
        std::sqrt(dot(centre, centre) + (uu + vv) / static_cast<double>(3 * triangles_.size()));
    bool round = std::isfinite(radius);
    for_each_corner([&](const Vec3& p) {
      round = round && std::fabs(norm(across(p) - centre) - radius) <= tolerance;
    });
    return round;
  }

  const Surface& surface_;
  const std::vector<std::uint32_t>& triangles_;
  std::vector<Vec3> area_vectors_;  // of twice the length
  double area_ = 0;
};

}  // namespace
}  // namespace delmesher::surface

namespace delmesher {

Status label_by_angle(Surface& surface, double degrees) {
  base::Control control{Limits()};
  return base::guarded(control, [&]() -> Status {
    Status defect = surface::defect_of(surface, degrees);
    if (defect.ok()) surface.labels = surface::labels_by_angle(surface, degrees);
    return defect;
  });
}

std::vector<LabelledFace> labelled_faces(const Surface& surface) {
  std::map<std::int32_t, std::vector<std::uint32_t>> triangles;
  for (std::uint32_t t = 0; t < surface.labels.size(); ++t) {
    triangles[surface.labels[t]].push_back(t);
  }
  std::vector<LabelledFace> faces;
  for (const auto& [label, of_label] : triangles) {
    faces.push_back(surface::Measured(surface, of_label).face());
    faces.back().label = label;
  }
  return faces;
}

}  // namespace delmesher
