#include "reports/benchmark/angle_causes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

namespace tetproof::benchmark {
namespace {

using delmesher::ExactRecord;
using Point = std::array<double, 3>;

double angle_at(const Point& a, const Point& b, const Point& c) {
  double u[3], v[3], dot = 0, cross = 0;
  for (int k = 0; k < 3; ++k) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - a[k];
    dot += u[k] * v[k];
  }
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    const double x = u[l] * v[m] - u[m] * v[l];
    cross += x * x;
  }
  return std::atan2(std::sqrt(cross), dot) * 180 / std::numbers::pi;
}

// The least sum of triangle angles between two edges of a facet's boundary.
class FacetCorners {
 public:
  FacetCorners(const delmesher::Surface& surface, const ExactRecord& record) : surface_(surface) {
    facet_.resize(surface.triangles.size());
    for (std::uint32_t f = 0; f < record.facets.size(); ++f) {
      for (const std::uint32_t t : record.facets[f].triangles) facet_[t] = f;
    }
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& v = surface.triangles[t];
      for (int i = 0; i < 3; ++i) triangle_at_[{v[i], v[(i + 1) % 3]}] = t;
    }
  }

  double smallest() const {
    double least = 180;
    for (const auto& [edge, t] : triangle_at_) {
      if (is_boundary(edge[0], edge[1], t)) least = std::min(least, corner(edge[0], edge[1], t));
    }
    return least;
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;

  bool is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
    const auto beyond = triangle_at_.find({b, a});
    return beyond == triangle_at_.end() || facet_[beyond->second] != facet_[t];
  }

  // From the boundary edge ab, counter-clockwise around a, to the next one.
  double corner(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
    const auto at = [&](std::uint32_t v) { return surface_.vertices[v]; };
    double sum = 0;
    for (;;) {
      const auto& v = surface_.triangles[t];
      const std::uint32_t c = v[0] == a ? v[2] : v[1] == a ? v[0] : v[1];
      sum += angle_at(at(a), at(b), at(c));
      if (is_boundary(c, a, t)) return sum;
      t = triangle_at_.at({a, c});
      b = c;
    }
  }

  const delmesher::Surface& surface_;
  std::vector<std::uint32_t> facet_;
  std::map<Edge, std::uint32_t> triangle_at_;
};

// Marks per point of the record.
struct Marks {
  explicit Marks(const delmesher::Surface& surface, const ExactRecord& record)
      : steiner(record.points.size(), 0),
        chamfered(record.points.size(), 0),
        filtered(record.points.size(), 0) {
    for (std::size_t v = surface.vertices.size(); v < steiner.size(); ++v) steiner[v] = 1;
    for (const auto& tet : record.refined) {
      for (const std::uint32_t v : tet.vertices) steiner[v] = 0;
    }
    for (const auto& corner : record.corners) chamfered[corner.vertex] = 1;
    std::set<std::uint32_t> dropped;
    for (const auto& facet : record.facets) {
      if (facet.filtered != 0) dropped.insert(facet.id);
    }
    for (const auto& [a, b, c, id] : record.final_facets) {
      if (dropped.contains(id)) filtered[a] = filtered[b] = filtered[c] = 1;
    }
  }

  AngleCause cause(const std::array<std::uint32_t, 3>& face) const {  // the angle is at face[0]
    const auto any = [&](const std::vector<std::uint8_t>& mark) {
      return std::ranges::any_of(face, [&](std::uint32_t v) { return mark[v] != 0; });
    };
    if (chamfered[face[0]] != 0) return AngleCause::input_corner;
    if (any(steiner)) return AngleCause::cdt_steiner;
    return any(filtered) ? AngleCause::filtered : AngleCause::refill;
  }

  std::vector<std::uint8_t> steiner, chamfered, filtered;
};

}  // namespace

AngleCauses find_angle_causes(const delmesher::Surface& surface, const delmesher::Result& result) {
  const ExactRecord& record = result.exact;
  AngleCauses causes;
  causes.bound = FacetCorners(surface, record).smallest();
  const Marks marks(surface, record);
  const delmesher::TetMesh& mesh = result.mesh;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.inside[t] == 0) continue;
    for (int skip = 0; skip < 4; ++skip) {
      std::array<std::uint32_t, 3> face{};
      for (int k = 0, i = 0; k < 4; ++k) {
        if (k != skip) face[i++] = mesh.tetrahedra[t][k];
      }
      double least = 180;
      std::array<std::uint32_t, 3> at{};
      for (int i = 0; i < 3; ++i) {
        const std::array<std::uint32_t, 3> turned{face[i], face[(i + 1) % 3], face[(i + 2) % 3]};
        const double angle =
            angle_at(mesh.vertices[turned[0]], mesh.vertices[turned[1]], mesh.vertices[turned[2]]);
        if (angle < least) {
          least = angle;
          at = turned;
        }
      }
      ++causes.faces;
      if (least >= record.parameters.delta - 1e-6 && least >= causes.smallest) continue;
      for (std::uint32_t& v : at) v = record.mesh_vertices[v];
      const AngleCause cause = marks.cause(at);
      if (least < record.parameters.delta - 1e-6) ++causes.below[static_cast<std::size_t>(cause)];
      if (least >= causes.smallest) continue;
      causes.smallest = least;
      causes.cause = cause;
    }
  }
  return causes;
}

}  // namespace tetproof::benchmark
