#include "mesher/plane/rounding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesher/base/sort_unique.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::plane {
namespace {

using Point = std::array<double, 2>;

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
    sort_unique(result.disturbed);
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
  // The triangles that fail then, perhaps others than before, are added to `failing`.
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

// Vertices in the order in which they are written, and the number of each id. `movable` says which
// of them are Steiner points.
struct Numbering {
  std::vector<std::uint32_t> number;
  std::vector<VertexId> vertices;
  std::vector<std::uint8_t> movable;
};

// The input vertices in the order of the input, the others in that in which they were made.
Numbering number_vertices(const InputGraph& graph, const MeshToWrite& exact,
                          const PointStore& points) {
  Numbering result;
  result.number.assign(points.size(), kNone);
  for (const auto& triangle : exact.triangles) {
    for (const VertexId v : triangle) result.number[v] = 0;
  }
  for (VertexId n = 0; n < points.size(); ++n) {
    const VertexId v = n < graph.vertices ? graph.id[n] : n;
    if (result.number[v] == kNone) continue;
    result.number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.vertices.push_back(v);
    result.movable.push_back(v >= graph.vertices + 4);
  }
  return result;
}

// The distance of written vertices from their exact places.
double max_deviation(const InputGraph& graph, const RoundedPlane& rounded,
                     const PointStore& points) {
  double largest = 0;
  for (std::size_t i = 0; i < rounded.vertices.size(); ++i) {
    const VertexId v = rounded.vertices[i];
    if (points.is_explicit(v)) continue;
    const Vec3 x = points.nearest(v);
    const Approximation rest = points.remainder(v);
    const Point& p = rounded.mesh.vertices[i];
    const double dx = std::ldexp(p[0], -graph.scale) - x[0] - rest.x;
    const double dy = std::ldexp(p[1], -graph.scale) - x[1] - rest.y;
    largest = std::max(largest, std::ldexp(std::hypot(dx, dy), graph.scale));
  }
  return largest;
}

}  // namespace

Point in_input_units(const InputGraph& graph, const PointStore& points, VertexId v) {
  const Vec3 x = points.nearest(v);
  return {std::ldexp(x[0], graph.scale), std::ldexp(x[1], graph.scale)};
}

RoundedPlane round_plane(const InputGraph& graph, const MeshToWrite& exact,
                         const PointStore& points, Control& control) {
  Numbering numbering = number_vertices(graph, exact, points);
  const std::vector<std::uint32_t>& number = numbering.number;
  RoundedPlane result;
  result.vertices = std::move(numbering.vertices);
  for (const VertexId v : result.vertices) {
    result.mesh.vertices.push_back(in_input_units(graph, points, v));
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
  Repairer(result.mesh, numbering.movable).run(result, control);
  result.max_deviation = max_deviation(graph, result, points);
  return result;
}

}  // namespace delmesher::plane
