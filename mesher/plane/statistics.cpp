#include "mesher/plane/statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace delmesher::plane {
namespace {

using Point = std::array<double, 2>;
constexpr double kDegrees = 57.29577951308232;  // per radian

struct Angles {
  double least, largest;
  std::array<double, 3> all;
};

// For any coordinates.
Angles careful_angles(const std::array<Point, 3>& p) {
  Angles result{180, 0, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &o = p[i], &a = p[(i + 1) % 3], &b = p[(i + 2) % 3];
    // Halved, so that the largest doubles do not overflow; scaled, so that products do not vanish.
    double ux = a[0] / 2 - o[0] / 2, uy = a[1] / 2 - o[1] / 2;
    double vx = b[0] / 2 - o[0] / 2, vy = b[1] / 2 - o[1] / 2;
    const auto scale = [](double& x, double& y) {
      int exponent = 0;
      std::frexp(std::max(std::fabs(x), std::fabs(y)), &exponent);
      x = std::ldexp(x, -exponent);
      y = std::ldexp(y, -exponent);
    };
    scale(ux, uy);
    scale(vx, vy);
    const double angle = std::atan2(std::max(0.0, ux * vy - uy * vx), ux * vx + uy * vy) * kDegrees;
    result.all[i] = angle;
    result.least = std::min(result.least, angle);
    result.largest = std::max(result.largest, angle);
  }
  return result;
}

Angles angles_of(const std::array<Point, 3>& p) {
  struct Side {
    double x, y, squared;
  };
  const auto side = [&](std::size_t i, std::size_t j) {
    const double x = p[j][0] - p[i][0], y = p[j][1] - p[i][1];
    return Side{x, y, x * x + y * y};
  };
  // With the sides in the order of their lengths, the angle opposite the longest is 180 degrees
  // less the two others, which saves an arc tangent.
  Side a = side(1, 2), b = side(2, 0), c = side(0, 1);
  double sense = 1;
  const auto order = [&](Side& s, Side& t) {
    if (s.squared <= t.squared) return;
    std::swap(s, t);
    sense = -sense;
  };
  order(a, b);
  order(b, c);
  order(a, b);
  if (!(a.squared > 0x1p-500 && c.squared < 0x1p500)) return careful_angles(p);
  // All run around the triangle, so the cross product of any two is its doubled area; the shorter
  // ones make the most of it.
  const double area = std::max(0.0, sense * (a.x * b.y - a.y * b.x));
  const double least = std::atan2(area, -(b.x * c.x + b.y * c.y)) * kDegrees;
  const double middle = std::atan2(area, -(a.x * c.x + a.y * c.y)) * kDegrees;
  const double largest = 180 - least - middle;
  return {least, largest, {least, middle, largest}};
}

class Accumulator {
 public:
  void add(const std::array<Point, 3>& corners) {
    const Angles a = angles_of(corners);
    s.min_angle = s.triangles == 0 ? a.least : std::min(s.min_angle, a.least);
    s.max_angle = std::max(s.max_angle, a.largest);
    s.mean_min_angle += a.least;
    s.mean_max_angle += a.largest;
    for (const double x : a.all) {
      ++s.angle_histogram[std::min<std::size_t>(11, static_cast<std::size_t>(x / 15))];
    }
    ++s.triangles;
  }
  PlaneMeshStatistics finish() {
    if (s.triangles > 0) {
      s.mean_min_angle /= static_cast<double>(s.triangles);
      s.mean_max_angle /= static_cast<double>(s.triangles);
    }
    return s;
  }
  PlaneMeshStatistics s;
};

}  // namespace

PlaneMeshStatistics plane_statistics(std::span<const Point> vertices,
                                     std::span<const std::array<std::uint32_t, 3>> triangles) {
  Accumulator accumulator;
  for (const auto& [a, b, c] : triangles) {
    accumulator.add({vertices[a], vertices[b], vertices[c]});
  }
  accumulator.s.vertices = vertices.size();
  return accumulator.finish();
}

PlaneMeshStatistics refined_statistics(const RefinedMesh& refined, const PointStore& points,
                                       Region region) {
  Accumulator accumulator;
  std::vector<std::uint8_t> used(points.size(), 0);
  for (TriangleId t = 0; t < refined.mesh.size(); ++t) {
    accumulator.s.interior_triangles += refined.side[t] == Side::inside;
    if (region == Region::interior && refined.side[t] == Side::outside) continue;
    std::array<Point, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const VertexId v = refined.mesh[t].vertex[i];
      const Vec3 x = points.nearest(v);
      corners[i] = {x[0], x[1]};
      accumulator.s.vertices += used[v] == 0;
      used[v] = 1;
      const EdgeId e = edge_of(t, static_cast<int>(i)), f = refined.mesh.twin(e);
      const PieceId piece = refined.mesh.piece(e);
      accumulator.s.edges += piece != kNone && piece >= kBoxPieces && (f == kNone || e < f);
    }
    accumulator.add(corners);
  }
  return accumulator.finish();
}

}  // namespace delmesher::plane
