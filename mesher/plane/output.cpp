#include "mesher/plane/output.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::plane {
namespace {

using Point = std::array<double, 2>;
constexpr double kDegrees = 57.29577951308232;  // per radian

Point scaled(const InputGraph& graph, const PointStore& points, VertexId v) {
  const Vec3 x = points.nearest(v);
  return {std::ldexp(x[0], graph.scale), std::ldexp(x[1], graph.scale)};
}

// Makes triangles positive that rounding flattened or inverted.
class Repairer {
 public:
  Repairer(PlaneMesh& mesh, const std::vector<std::uint8_t>& movable)
      : mesh_(mesh), movable_(movable) {}

  void run(RoundedPlane& result, Control& control) {
    std::vector<std::uint32_t> bad;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      control.poll();
      if (sign(t) <= 0) bad.push_back(t);
    }
    if (bad.empty()) return;
    index_triangles();
    for (int round = 0; round < 4 && !bad.empty(); ++round) {
      std::vector<std::uint32_t> still;
      for (const std::uint32_t t : bad) {
        control.poll();
        if (sign(t) > 0) continue;
        if (repair(t, 1 << round, still)) {
          ++result.repaired;
        } else {
          still.push_back(t);
        }
      }
      bad = std::move(still);
    }
    sort_unique(bad);
    for (const std::uint32_t t : bad) {
      const int s = sign(t);
      if (s > 0) continue;
      result.flat += s == 0;
      result.inverted += s < 0;
      for (const std::uint32_t v : mesh_.triangles[t]) {
        result.disturbed.push_back(result.vertices[v]);
      }
    }
    std::vector<VertexId>& disturbed = result.disturbed;
    sort_unique(disturbed);
  }

 private:
  int sign(std::uint32_t t) {
    const auto& [a, b, c] = mesh_.triangles[t];
    return orient2d_sign(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
  }

  void index_triangles() {
    first_.assign(mesh_.vertices.size() + 1, 0);
    for (const auto& triangle : mesh_.triangles) {
      for (const std::uint32_t v : triangle) ++first_[v + 1];
    }
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) first_[v + 1] += first_[v];
    at_.resize(3 * mesh_.triangles.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (const std::uint32_t v : mesh_.triangles[t]) at_[next[v]++] = t;
    }
  }

  // Triangles at v that are not positive.
  int failures(std::uint32_t v) {
    int count = 0;
    for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k) count += sign(at_[k]) <= 0;
    return count;
  }

  static double stepped(double x, int steps) {
    const double towards = steps < 0 ? -HUGE_VAL : HUGE_VAL;
    for (int k = std::abs(steps); k > 0; --k) x = std::nextafter(x, towards);
    return x;
  }

  // Moves a corner to a double nearby with which fewer triangles around it fail, and t does not.
  // Those that do then, perhaps others than before, are added to `failing`.
  bool repair(std::uint32_t t, int reach, std::vector<std::uint32_t>& failing) {
    for (const std::uint32_t v : mesh_.triangles[t]) {
      if (movable_[v] == 0) continue;
      const Point old = mesh_.vertices[v];
      const int before = failures(v);
      for (int size = 1; size <= reach; ++size) {
        for (int dx = -size; dx <= size; ++dx) {
          for (int dy = -size; dy <= size; ++dy) {
            if (std::max(std::abs(dx), std::abs(dy)) != size) continue;
            mesh_.vertices[v] = {stepped(old[0], dx), stepped(old[1], dy)};
            if (!(sign(t) > 0) || failures(v) >= before) continue;
            for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k) {
              if (sign(at_[k]) <= 0) failing.push_back(at_[k]);
            }
            return true;
          }
        }
      }
      mesh_.vertices[v] = old;
    }
    return false;
  }

  PlaneMesh& mesh_;
  const std::vector<std::uint8_t>& movable_;
  std::vector<std::uint32_t> first_, at_;
};

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
  // With the sides in the order of their lengths, the angle opposite the longest is what the two
  // others leave: one arc tangent less.
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

MeshToWrite select(const Triangulation& mesh, const std::vector<Side>& side,
                   const std::vector<double>& attributes, Region region) {
  MeshToWrite result;
  const auto wanted = [&](TriangleId t) {
    return region == Region::hull || side[t] == Side::inside;
  };
  for (TriangleId t = 0; t < mesh.size(); ++t) {
    if (!wanted(t)) continue;
    result.triangles.push_back(mesh[t].vertex);
    result.inside.push_back(side[t] == Side::inside);
    if (!attributes.empty()) result.attributes.push_back(attributes[t]);
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i), f = mesh.twin(e);
      if (mesh.piece(e) == kNone || mesh.piece(e) < kBoxPieces) continue;
      if (f != kNone && f < e && wanted(triangle_of(f))) continue;
      result.edges.push_back({mesh.origin(e), mesh.target(e)});
      result.edge_pieces.push_back(mesh.piece(e));
    }
  }
  return result;
}

RoundedPlane round_plane(const InputGraph& graph, const MeshToWrite& exact,
                         const PointStore& points, Control& control) {
  RoundedPlane result;
  std::vector<std::uint32_t> number(points.size(), kNone);
  for (const auto& triangle : exact.triangles) {
    for (const VertexId v : triangle) number[v] = 0;
  }
  std::vector<std::uint8_t> movable;
  std::uint32_t count = 0;
  // The input vertices in the order of the input, the others in that in which they were made.
  for (VertexId n = 0; n < points.size(); ++n) {
    const VertexId v = n < graph.vertices ? graph.id[n] : n;
    if (number[v] == kNone) continue;
    number[v] = count++;
    result.vertices.push_back(v);
    result.mesh.vertices.push_back(scaled(graph, points, v));
    movable.push_back(v >= graph.vertices + 4);
  }
  for (const auto& [a, b, c] : exact.triangles) {
    result.mesh.triangles.push_back({number[a], number[b], number[c]});
  }
  for (std::size_t i = 0; i < exact.edges.size(); ++i) {
    const auto& [a, b] = exact.edges[i];
    result.mesh.edges.push_back({number[a], number[b]});
    const std::uint32_t segment = graph.pieces[exact.edge_pieces[i]].segment;
    result.mesh.edge_segments.push_back(segment);
    const auto& markers = graph.input->markers;
    result.mesh.edge_markers.push_back(markers.empty() ? 0 : markers[segment]);
  }
  result.mesh.inside = exact.inside;
  result.mesh.attributes = exact.attributes;
  Repairer(result.mesh, movable).run(result, control);
  for (std::uint32_t i = 0; i < count; ++i) {
    const VertexId v = result.vertices[i];
    if (points.is_explicit(v)) continue;
    const Vec3 x = points.nearest(v);
    const Approximation rest = points.remainder(v);
    const auto& p = result.mesh.vertices[i];
    const double dx = std::ldexp(p[0], -graph.scale) - x[0] - rest.x;
    const double dy = std::ldexp(p[1], -graph.scale) - x[1] - rest.y;
    result.max_deviation =
        std::max(result.max_deviation, std::ldexp(std::hypot(dx, dy), graph.scale));
  }
  return result;
}

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

void record_points(const InputGraph& graph, const PointStore& points, PlaneRecord& record) {
  record.points.reserve(points.size());
  for (VertexId n = 0; n < points.size(); ++n) {
    const VertexId v = n < graph.vertices ? graph.id[n] : n;
    const PointDefinition d = points.definition(v);
    ExactPoint p;
    if (d.kind == PointKind::explicit_point) {
      const Point x = scaled(graph, points, v);
      p.x = x[0];
      p.y = x[1];
    } else {
      p.kind = ExactPoint::Kind::on_segment;
      p.i = graph.number_of(d.corner[0]);
      p.j = graph.number_of(d.corner[1]);
      p.x = d.u;
    }
    record.points.push_back(p);
  }
}

void record_triangles(const InputGraph& graph, const Triangulation& mesh,
                      const std::vector<Side>& side, std::vector<PlaneRecord::Triangle>& triangles,
                      std::vector<PlaneRecord::Edge>& edges) {
  triangles.clear();
  edges.clear();
  for (TriangleId t = 0; t < mesh.size(); ++t) {
    const auto& [a, b, c] = mesh[t].vertex;
    triangles.push_back({{graph.number_of(a), graph.number_of(b), graph.number_of(c)}, side[t]});
    for (int i = 0; i < 3; ++i) {
      const EdgeId e = edge_of(t, i), f = mesh.twin(e);
      if (mesh.piece(e) == kNone || (f != kNone && f < e)) continue;
      const std::uint32_t segment = graph.pieces[mesh.piece(e)].segment;
      edges.push_back(
          {{graph.number_of(mesh.origin(e)), graph.number_of(mesh.target(e))}, segment});
    }
  }
}

PlanarGraph chamfered_graph(const InputGraph& graph, const Chamfered& chamfered,
                            const PointStore& points) {
  PlanarGraph result;
  result.insideness = graph.input->insideness;
  result.holes = graph.input->holes;
  std::vector<std::uint32_t> number(points.size(), kNone);
  const auto vertex = [&](VertexId v) {
    if (number[v] == kNone) {
      number[v] = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(scaled(graph, points, v));
    }
    return number[v];
  };
  for (PieceId id = kBoxPieces; id < graph.pieces.size(); ++id) {
    const auto [a, b] = chamfered.ends[id];
    if (a == kNone) continue;
    const std::uint32_t segment = graph.pieces[id].segment;
    result.segments.push_back({vertex(a), vertex(b)});
    const auto& markers = graph.input->markers;
    result.markers.push_back(markers.empty() ? 0 : markers[segment]);
    const auto& partitions = graph.input->partitions;
    if (!partitions.empty()) result.partitions.push_back(partitions[segment]);
  }
  return result;
}

}  // namespace delmesher::plane
