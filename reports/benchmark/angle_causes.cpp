#include "reports/benchmark/angle_causes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/base/vectors.h"

namespace tetproof::benchmark {
namespace {

using delmesher::ExactRecord;
using oracles::cross;
using oracles::dot;
using oracles::length;
using oracles::minus;
using Point = oracles::Position;

double degrees_between(const Point& u, const Point& v) {
  return std::atan2(length(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi;
}

double angle_at(const Point& a, const Point& b, const Point& c) {
  return degrees_between(minus(b, a), minus(c, a));
}

// At the edge ab of the tetrahedron abcd.
double dihedral_at(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point edge = minus(b, a);
  return degrees_between(cross(edge, minus(c, a)), cross(edge, minus(d, a)));
}

// Angles of the surface where its facets end.
class FacetAngles {
 public:
  FacetAngles(const delmesher::Surface& surface, const ExactRecord& record) : surface_(surface) {
    points_.assign(surface.vertices);
    facet_.resize(surface.triangles.size());
    for (std::uint32_t f = 0; f < record.facets.size(); ++f) {
      for (const std::uint32_t t : record.facets[f].triangles) facet_[t] = f;
    }
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& v = surface.triangles[t];
      for (int i = 0; i < 3; ++i) triangle_at_[{v[i], v[(i + 1) % 3]}] = t;
      volume6_ += volume6(v);
    }
  }

  AngleBounds bounds() const {
    AngleBounds least;
    for (const auto& [edge, t] : triangle_at_) {
      if (!is_boundary(edge[0], edge[1], t)) continue;
      least.face = std::min(least.face, corner(edge[0], edge[1], t));
      if (edge[0] < edge[1]) least.dihedral = std::min(least.dihedral, wedge(edge[0], edge[1], t));
    }
    return least;
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;

  bool is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
    const auto beyond = triangle_at_.find({b, a});
    return beyond == triangle_at_.end() || facet_[beyond->second] != facet_[t];
  }

  // Volume, times 6, of the tetrahedron with the first vertex.
  double volume6(const std::array<std::uint32_t, 3>& triangle) const {
    double u[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        u[i][k] = surface_.vertices[triangle[i]][k] - surface_.vertices[0][k];
      }
    }
    return u[0][0] * (u[1][1] * u[2][2] - u[1][2] * u[2][1]) +
           u[0][1] * (u[1][2] * u[2][0] - u[1][0] * u[2][2]) +
           u[0][2] * (u[1][0] * u[2][1] - u[1][1] * u[2][0]);
  }

  std::uint32_t opposite(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
    const auto& v = surface_.triangles[t];
    return v[0] != a && v[0] != b ? v[0] : v[1] != a && v[1] != b ? v[1] : v[2];
  }

  // Between the triangle t at edge ab and the one beyond, on their inner side. The tetrahedron of
  // the two has this angle there, or the rest of 360 degrees; two coplanar triangles have 180.
  double wedge(std::uint32_t a, std::uint32_t b, std::uint32_t t) const {
    const auto beyond = triangle_at_.find({b, a});
    if (beyond == triangle_at_.end()) return 180;
    const auto at = [&](std::uint32_t v) { return surface_.vertices[v]; };
    const std::uint32_t c = opposite(a, b, t), d = opposite(a, b, beyond->second);
    // Of the other triangle, seen from this one.
    const int outside = oracles::exact::orient3d(points_, a, b, c, d);
    const double angle = outside == 0 ? 180 : dihedral_at(at(a), at(b), at(c), at(d));
    const bool reflex = volume6_ > 0 ? outside > 0 : outside < 0;  // else it is inside out
    return reflex ? 360 - angle : angle;
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
  oracles::ExactPoints points_;
  std::vector<std::uint32_t> facet_;
  std::map<Edge, std::uint32_t> triangle_at_;
  double volume6_ = 0;
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

AngleBounds find_bounds(const delmesher::Surface& surface, const ExactRecord& record) {
  return FacetAngles(surface, record).bounds();
}

AngleCauses find_angle_causes(const delmesher::Surface& surface, const delmesher::Result& result) {
  const ExactRecord& record = result.exact;
  AngleCauses causes;
  causes.bounds = find_bounds(surface, record);
  const Marks marks(surface, record);
  const delmesher::TetMesh& mesh = result.mesh;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.inside[t] == 0) continue;
    const auto& tet = mesh.tetrahedra[t];
    constexpr int kEdges[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                  {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
    for (const auto& e : kEdges) {
      const auto at = [&](int k) { return mesh.vertices[tet[e[k]]]; };
      causes.smallest_dihedral =
          std::min(causes.smallest_dihedral, dihedral_at(at(0), at(1), at(2), at(3)));
    }
    for (int skip = 0; skip < 4; ++skip) {
      std::array<std::uint32_t, 3> face{};
      for (int k = 0, i = 0; k < 4; ++k) {
        if (k != skip) face[i++] = tet[k];
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
