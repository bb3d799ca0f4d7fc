#include "mesher/enrich/returning.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/sort_unique.h"
#include "mesher/enrich/enrichment.h"
#include "mesher/geometry/placement.h"
#include "mesher/surface/facet_locator.h"
#include "mesher/surface/feature_size.h"

namespace delmesher::enrich {
namespace {

// The triangles whose corners go back, and how far around them points may have been passed over.
class MovedTriangles {
 public:
  MovedTriangles(const SurfaceTopology& as_given, const PointStore& refined,
                 const PointStore& points)
      : as_given_(as_given), points_(points) {
    const auto moved = [&](VertexId v) { return distance(refined.nearest(v), points.nearest(v)); };
    std::vector<Box> boxes;
    for (std::uint32_t t = 0; t < as_given.triangles.size(); ++t) {
      double farthest = 0;
      for (const VertexId v : as_given.triangles[t]) {
        if (!refined.is_explicit(v)) farthest = std::max(farthest, moved(v));
      }
      const bool stays = std::ranges::all_of(as_given.triangles[t],
                                             [&](VertexId v) { return refined.is_explicit(v); });
      if (stays) continue;
      const std::array<Vec3, 3> at = corners(t);
      const double size = std::max(distance(at[0], at[1]), distance(at[1], at[2]));
      // Twice, and more than doubles err.
      reach_.push_back(2 * farthest + 0x1p-40 * size);
      triangle_.push_back(t);
      boxes.push_back(Box::around(at));
      for (std::size_t k = 0; k < 3; ++k) {
        boxes.back().lo[k] -= reach_.back();
        boxes.back().hi[k] += reach_.back();
      }
    }
    tree_ = BoxTree(boxes);
  }

  bool near(const Vec3& p) const {
    return !tree_.query({p, p}, [&](std::uint32_t n) {
      return !(point_triangle_distance(p, corners(triangle_[n])) <= reach_[n]);
    });
  }

 private:
  std::array<Vec3, 3> corners(std::uint32_t t) const {
    const auto& [a, b, c] = as_given_.triangles[t];
    return {points_.nearest(a), points_.nearest(b), points_.nearest(c)};
  }

  const SurfaceTopology& as_given_;
  const PointStore& points_;
  std::vector<std::uint32_t> triangle_;
  std::vector<double> reach_;
  BoxTree tree_;
};

class Returning {
 public:
  Returning(const ConformingMesh& mesh, const SurfaceTopology& stand_in, const PointStore& refined,
            const SurfaceTopology& as_given, PointStore& points, Predicates& predicates,
            Control& control)
      : mesh_(mesh),
        stand_in_(stand_in),
        refined_(refined),
        as_given_(as_given),
        points_(points),
        predicates_(predicates),
        control_(control),
        locator_(stand_in, refined),
        input_(plain_input(as_given)) {}

  cdt::CdtInput run() {
    measure();
    const MovedTriangles moved(as_given_, refined_, points_);
    for (VertexId v = static_cast<VertexId>(as_given_.vertex_half_edge.size()); v < refined_.size();
         ++v) {
      control_.poll(points_.size());
      if (!(spacing_[v] < HUGE_VAL)) continue;  // not used
      if (facet_[v] != kNone) {
        place(v);
      } else if (!moved.near(points_.nearest(v))) {
        input_.vertices.push_back(v);
      }
    }
    for (std::uint32_t e = 0; e < input_.on_edge.size(); ++e) finish_edge(e);
    finish_facets();
    return std::move(input_);
  }

 private:
  // Nearer to an edge than this share of its spacing, a point is put on it.
  static constexpr double kNear = 0.3;

  void measure() {
    spacing_.assign(refined_.size(), HUGE_VAL);
    for (const auto& t : mesh_.tetrahedra) {
      for (const auto& [i, j] : kEdge) {
        const double length = distance(refined_.nearest(t[i]), refined_.nearest(t[j]));
        spacing_[t[i]] = std::min(spacing_[t[i]], length);
        spacing_[t[j]] = std::min(spacing_[t[j]], length);
      }
    }
    facet_.assign(refined_.size(), kNone);
    for (const SurfaceFace& face : mesh_.boundary) {
      for (const VertexId v : face.vertices) facet_[v] = face.facet;
    }
  }

  void place(VertexId v) {
    const PointDefinition d = points_.definition(v);
    if (d.kind == PointKind::on_segment) {
      const std::uint32_t edge = edge_between(as_given_, d.corner[0], d.corner[1]);
      if (edge != kNone && as_given_.edge_is_flat[edge] == 0) {
        input_.on_edge[edge].push_back(v);
        return;
      }
    }
    const std::uint32_t t = locator_.triangle_at(facet_[v], refined_.nearest(v));
    const Vec3 target = moved_with(t, refined_.nearest(v));
    if (put_on_edge(v, t, target)) return;
    const auto& [p, q, r] = as_given_.triangles[t];
    VertexId at = v;
    if (!std::ranges::all_of(d.corner, [&](VertexId c) {
          return c == kNone || c == as_given_.triangles[t][0] || c == as_given_.triangles[t][1] ||
                 c == as_given_.triangles[t][2];
        })) {
      at = points_.add(place_on_triangle(points_, p, q, r, target, spacing_[v] * 0x1p-20));
    }
    if (is_inside(at, t)) input_.on_facet[as_given_.facet_of[t]].push_back(at);
  }

  // Where a point of the triangle of the stand-in is after the corners have gone back.
  Vec3 moved_with(std::uint32_t t, const Vec3& x) const {
    const auto& corner = as_given_.triangles[t];
    const Vec3 o = refined_.nearest(corner[2]), u = subtract(refined_.nearest(corner[0]), o),
               v = subtract(refined_.nearest(corner[1]), o), w = subtract(x, o), n = cross(u, v);
    const double area = squared_norm(n), a = dot(cross(w, v), n) / area,
                 b = dot(cross(u, w), n) / area;
    const Vec3 at = points_.nearest(corner[2]);
    return add_scaled(add_scaled(at, a, subtract(points_.nearest(corner[0]), at)), b,
                      subtract(points_.nearest(corner[1]), at));
  }

  bool put_on_edge(VertexId v, std::uint32_t t, const Vec3& target) {
    double nearest = kNear * spacing_[v];
    std::uint32_t edge = kNone;
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t e = as_given_.edge_of[h];
      if (as_given_.edge_is_flat[e] != 0 || stand_in_.edge_is_flat[e] == 0) continue;
      const double d = point_segment_distance(target, points_.nearest(as_given_.from(h)),
                                              points_.nearest(as_given_.to(h)));
      if (d < nearest) {
        nearest = d;
        edge = e;
      }
    }
    if (edge == kNone) return false;
    const auto [p, q] = as_given_.edge_vertices(edge);
    input_.on_edge[edge].push_back(
        points_.add(place_on_segment(points_, p, q, target, spacing_[v] * 0x1p-10)));
    return true;
  }

  // Strictly inside the facet of the triangle, by exact signs of the triangle alone.
  bool is_inside(VertexId v, std::uint32_t t) {
    const FacetId facet = as_given_.facet_of[t];
    const int axis = as_given_.facet_axis[facet], sign = as_given_.facet_axis_sign[facet];
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const int side = sign * predicates_.orient2d(axis, as_given_.from(h), as_given_.to(h), v);
      if (side < 0 || (side == 0 && as_given_.edge_is_flat[as_given_.edge_of[h]] == 0)) {
        return false;
      }
    }
    return true;
  }

  // In order, without repetition, with supports.
  void finish_edge(std::uint32_t e) {
    std::vector<VertexId>& chain = input_.on_edge[e];
    if (chain.empty()) return;
    const auto [p, q] = as_given_.edge_vertices(e);
    const auto before = [&, p = p, q = q](VertexId a, VertexId b) {
      return a != b && predicates_.dot_difference_sign(a, b, p, q) > 0;
    };
    std::ranges::sort(chain, before);
    const auto same = [&](VertexId a, VertexId b) { return !before(a, b) && !before(b, a); };
    chain.erase(std::unique(chain.begin(), chain.end(), same), chain.end());
    const std::vector<PlaneId> planes = as_given_.edge_planes(e);
    std::vector<std::uint32_t> lines = {e, as_given_.edge_line[e]};
    sort_unique(lines);
    for (const VertexId v : chain) points_.set_supports(v, planes, lines);
    input_.vertices.insert(input_.vertices.end(), chain.begin(), chain.end());
  }

  void finish_facets() {
    for (FacetId f = 0; f < input_.on_facet.size(); ++f) {
      std::vector<VertexId>& inside = input_.on_facet[f];
      std::ranges::sort(inside, [&](VertexId a, VertexId b) {
        const int order = predicates_.compare_xyz(a, b);
        return order != 0 ? order < 0 : a < b;
      });
      inside.erase(
          std::unique(inside.begin(), inside.end(),
                      [&](VertexId a, VertexId b) { return predicates_.compare_xyz(a, b) == 0; }),
          inside.end());
      const std::vector<PlaneId> planes = {as_given_.facet_plane[f]};
      for (const VertexId v : inside) points_.set_supports(v, planes, {});
      input_.vertices.insert(input_.vertices.end(), inside.begin(), inside.end());
    }
  }

  const ConformingMesh& mesh_;
  const SurfaceTopology& stand_in_;
  const PointStore& refined_;
  const SurfaceTopology& as_given_;
  PointStore& points_;
  Predicates& predicates_;
  Control& control_;
  FacetLocator locator_;
  cdt::CdtInput input_;
  std::vector<double> spacing_;  // per point of the mesh: its shortest edge; else infinite
  std::vector<FacetId> facet_;   // of the stand-in; kNone in the volume
};

}  // namespace

cdt::CdtInput input_as_given(const ConformingMesh& mesh, const SurfaceTopology& stand_in,
                             const PointStore& refined, const SurfaceTopology& as_given,
                             PointStore& points, Predicates& predicates, Control& control) {
  return Returning(mesh, stand_in, refined, as_given, points, predicates, control).run();
}

}  // namespace delmesher::enrich
