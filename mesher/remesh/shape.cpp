#include "mesher/remesh/shape.h"

#include <algorithm>
#include <tuple>

#include "mesher/geometry/box_tree.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::remesh {

void Quadric::add_plane(const Vec3& n, double offset, double area) {
  a[0] += area * n[0] * n[0];
  a[1] += area * n[0] * n[1];
  a[2] += area * n[0] * n[2];
  a[3] += area * n[1] * n[1];
  a[4] += area * n[1] * n[2];
  a[5] += area * n[2] * n[2];
  for (std::size_t i = 0; i < 3; ++i) b[i] += area * offset * n[i];
  c += area * offset * offset;
  weight += area;
}

void Quadric::operator+=(const Quadric& other) {
  for (std::size_t i = 0; i < 6; ++i) a[i] += other.a[i];
  for (std::size_t i = 0; i < 3; ++i) b[i] += other.b[i];
  c += other.c;
  weight += other.weight;
}

double Quadric::at(const Vec3& p) const {
  const Vec3 ap{a[0] * p[0] + a[1] * p[1] + a[2] * p[2], a[1] * p[0] + a[3] * p[1] + a[4] * p[2],
                a[2] * p[0] + a[4] * p[1] + a[5] * p[2]};
  return std::max(0.0, dot(p, ap) - 2 * dot(b, p) + c);
}

Vec3 Quadric::least(const Vec3& middle) const {
  const double more = 1e-3 * (a[0] + a[3] + a[5]);
  const Vec3 x{a[0] + more, a[1], a[2]}, y{a[1], a[3] + more, a[4]}, z{a[2], a[4], a[5] + more};
  const Vec3 right = add_scaled(b, more, middle);
  const Vec3 yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
  const double det = dot(x, yz);
  if (!(det > 0)) return middle;
  Vec3 p{};
  for (std::size_t i = 0; i < 3; ++i) {
    p[i] = (right[0] * yz[i] + right[1] * zx[i] + right[2] * xy[i]) / det;
  }
  return p;
}

double largest_coordinate(const Surface& surface) {
  const geometry::Box box = geometry::Box::around(surface.vertices);
  return std::max(geometry::largest_component(box.lo), geometry::largest_component(box.hi));
}

std::vector<Side> sides_of(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), t, a > b});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.a, s.b, s.triangle); });
  return sides;
}

namespace {

// An angle from 0 to 180 degrees, or more, by its cosine and sine: roots are the same everywhere,
// arcs are not.
struct Bend {
  double cosine, sine;
  bool is_more_than_straight = false;

  explicit Bend(double of) : cosine(of), sine(std::sqrt(1 - of * of)) {}
  // More by the angle, below 90 degrees, that has this tangent.
  Bend turned(double tangent) const {
    const double c = 1 / std::sqrt(1 + tangent * tangent), s = tangent * c;
    Bend more = *this;
    more.cosine = cosine * c - sine * s;
    more.sine = sine * c + cosine * s;
    more.is_more_than_straight = is_more_than_straight || !(more.sine >= 0);
    return more;
  }
  bool is_less_than(double other_cosine) const {
    return !is_more_than_straight && other_cosine < cosine;
  }
};

}  // namespace

SurfaceLines lines_of(const Surface& surface, double feature, double tolerance) {
  const double steepest = std::sqrt(predicates::cosine_squared(feature));
  const auto corners = [&](const Side& side) -> Corners {
    const auto& [a, b, c] = surface.triangles[side.triangle];
    return {surface.vertices[a], surface.vertices[b], surface.vertices[c]};
  };
  const auto normal = [&](const Side& side) { return normal_of(corners(side)); };
  // The tangent of what a triangle turns by if its vertices move by half of the tolerance.
  const auto sway = [&](const Side& side) { return tolerance / least_height(corners(side)); };
  const auto differ = [&](const Side& s, const Side& t) {
    return !surface.labels.empty() && surface.labels[s.triangle] != surface.labels[t.triangle];
  };
  const std::vector<Side> sides = sides_of(surface.triangles);
  SurfaceLines found;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].is_beside(sides[i])) ++j;
    const Side &s = sides[i], &t = sides[j - 1];
    const bool always = j - i != 2 || differ(s, t);
    const double cosine = always ? -1 : cosine_of_bend(normal(s), s.turned, normal(t), t.turned);
    if (!always && !(cosine < steepest)) continue;
    found.lines.push_back({s.a, s.b});
    found.counts.push_back(
        always || Bend{steepest}.turned(sway(s)).turned(sway(t)).is_less_than(cosine) ? 1 : 0);
  }
  return found;
}

}  // namespace delmesher::remesh
