#include "mesher/policies/thinning.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesher/base/sort_unique.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::policies {
namespace {

using Face = std::array<VertexId, 3>;

template <class Simplex>
bool has(const Simplex& simplex, VertexId v) {
  return std::find(simplex.begin(), simplex.end(), v) != simplex.end();
}

class Thinning {
 public:
  Thinning(std::size_t fixed_vertices, const LocalFrame& frame, const PointStore& points,
           Predicates& predicates, ConformingMesh& mesh)
      : fixed_vertices_(fixed_vertices),
        frame_(frame),
        points_(points),
        predicates_(predicates),
        mesh_(mesh) {
    tets_.resize(points.size());
    faces_.resize(points.size());
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      for (const VertexId v : mesh.tetrahedra[t]) tets_[v].push_back(t);
    }
    for (std::uint32_t f = 0; f < mesh.boundary.size(); ++f) {
      for (const VertexId v : mesh.boundary[f].vertices) faces_[v].push_back(f);
    }
  }

  std::vector<VertexId> removable_around(std::span<const VertexId> around, int rings) const {
    std::vector<VertexId> reached(around.begin(), around.end());
    sort_unique(reached);
    for (int i = 0; i < rings; ++i) {
      std::vector<VertexId> next = reached;
      for (const VertexId v : reached) {
        for (const std::uint32_t t : tets_[v]) {
          next.insert(next.end(), mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end());
        }
      }
      sort_unique(next);
      reached = std::move(next);
    }
    std::erase_if(reached, [&](VertexId v) {
      return v < fixed_vertices_ || (points_.is_explicit(v) && !points_.planes(v).empty());
    });
    return reached;
  }

  // Collapses v to the best of its neighbours, if there is one to which it can go.
  bool remove(VertexId v) {
    const std::vector<VertexId> neighbours = possible_targets(v);
    VertexId best = kNone;
    Score best_score{bad_around(v) + 1, -HUGE_VAL};
    for (const VertexId w : neighbours) {
      const std::optional<Score> score = try_collapse(v, w);
      if (!score || !(*score < best_score)) continue;
      best_score = *score;
      best = w;
    }
    if (best != kNone) collapse(v, best);
    return best != kNone;
  }

  // Closes the gaps that the removed ones leave.
  void finish() {
    std::size_t tets = 0, faces = 0;
    for (std::size_t t = 0; t < mesh_.tetrahedra.size(); ++t) {
      if (mesh_.tetrahedra[t][0] == kNone) continue;
      mesh_.tetrahedra[tets] = mesh_.tetrahedra[t];
      mesh_.region[tets++] = mesh_.region[t];
    }
    for (const SurfaceFace& face : mesh_.boundary) {
      if (face.vertices[0] != kNone) mesh_.boundary[faces++] = face;
    }
    mesh_.tetrahedra.resize(tets);
    mesh_.region.resize(tets);
    mesh_.boundary.resize(faces);
    mesh_.repeated_faces.clear();
  }

 private:
  // How many tetrahedra are not positive on nearest doubles, then minus the worst shape.
  using Score = std::pair<std::size_t, double>;

  // Faces of the hull around v, which only one tetrahedron has.
  std::vector<Face> hull_faces(VertexId v) const {
    std::vector<Face> faces;
    for (const std::uint32_t t : tets_[v]) {
      for (const auto& f : kFace) {
        Face face;
        for (int k = 0; k < 3; ++k) face[k] = mesh_.tetrahedra[t][f[k]];
        if (!has(face, v)) continue;
        std::sort(face.begin(), face.end());
        faces.push_back(face);
      }
    }
    std::sort(faces.begin(), faces.end());
    std::vector<Face> once;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const bool again = i + 1 < faces.size() && faces[i + 1] == faces[i];
      if (!again) once.push_back(faces[i]);
      i += again ? 1 : 0;
    }
    return once;
  }

  // Neighbours in every plane of the surface and the hull that v is in; along the edge if v is on
  // one.
  std::vector<VertexId> possible_targets(VertexId v) {
    std::vector<VertexId> result;
    for (const std::uint32_t t : tets_[v]) {
      result.insert(result.end(), mesh_.tetrahedra[t].begin(), mesh_.tetrahedra[t].end());
    }
    sort_unique(result);
    const std::vector<Face> hull = hull_faces(v);
    const bool on_edge = std::any_of(faces_[v].begin(), faces_[v].end(), [&](std::uint32_t f) {
      return mesh_.boundary[f].facet != mesh_.boundary[faces_[v][0]].facet;
    });
    std::erase_if(result, [&](VertexId w) {
      return w == v || !stays_on_surface(v, w, on_edge) || !stays_on_hull(w, hull);
    });
    return result;
  }

  bool stays_on_surface(VertexId v, VertexId w, bool on_edge) {
    if (faces_[v].empty()) return true;
    std::vector<FacetId> along;
    for (const std::uint32_t f : faces_[v]) {
      if (has(mesh_.boundary[f].vertices, w)) along.push_back(mesh_.boundary[f].facet);
    }
    if (along.size() != 2 || (along[0] != along[1]) != on_edge) return false;
    return std::all_of(faces_[v].begin(), faces_[v].end(),
                       [&](std::uint32_t f) { return coplanar(mesh_.boundary[f].vertices, w); });
  }

  bool stays_on_hull(VertexId w, const std::vector<Face>& hull) {
    if (hull.empty()) return true;
    const auto along =
        std::count_if(hull.begin(), hull.end(), [&](const Face& f) { return has(f, w); });
    return along == 2 &&
           std::all_of(hull.begin(), hull.end(), [&](const Face& f) { return coplanar(f, w); });
  }

  bool coplanar(const Face& f, VertexId w) {
    return has(f, w) || predicates_.orient3d(f[0], f[1], f[2], w) == 0;
  }

  bool bad_as_written(const std::array<VertexId, 4>& t) {
    const auto at = [&](int i) { return frame_.written(points_.nearest(t[i])); };
    return orient3d_sign(at(0), at(1), at(2), at(3)) <= 0;
  }

  std::size_t bad_around(VertexId v) {
    return static_cast<std::size_t>(
        std::count_if(tets_[v].begin(), tets_[v].end(),
                      [&](std::uint32_t t) { return bad_as_written(mesh_.tetrahedra[t]); }));
  }

  // Volume by the third power of the longest edge, roughly.
  double shape(const std::array<VertexId, 4>& t) const {
    double longest2 = 0;
    for (int i = 0; i < 4; ++i) {
      for (int j = i + 1; j < 4; ++j) {
        const Vec3 e = points_.difference(t[i], t[j]);
        longest2 = std::max(longest2, squared_norm(e));
      }
    }
    const double longest = std::sqrt(longest2);
    const Vec3 u = points_.difference(t[0], t[1]), v = points_.difference(t[0], t[2]),
               w = points_.difference(t[0], t[3]);
    double volume = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      volume += (u[j] / longest * (v[k] / longest) - u[k] / longest * (v[j] / longest)) *
                (w[i] / longest);
    }
    return std::isfinite(volume) ? std::fabs(volume) : 0;
  }

  // A cone from w over the link of v. If its tetrahedra are positive, they fill the star of v.
  std::optional<Score> try_collapse(VertexId v, VertexId w) {
    Score score{0, -HUGE_VAL};
    for (const std::uint32_t t : tets_[v]) {
      std::array<VertexId, 4> moved = mesh_.tetrahedra[t];
      if (has(moved, w)) continue;
      std::replace(moved.begin(), moved.end(), v, w);
      if (predicates_.orient3d(moved[0], moved[1], moved[2], moved[3]) <= 0) return std::nullopt;
      score.first += bad_as_written(moved) ? 1 : 0;
      score.second = std::max(score.second, -shape(moved));
    }
    return score;
  }

  void collapse(VertexId v, VertexId w) {
    move_star(
        v, w, tets_, [&](std::uint32_t t) -> auto& { return mesh_.tetrahedra[t]; });
    move_star(
        v, w, faces_, [&](std::uint32_t f) -> auto& { return mesh_.boundary[f].vertices; });
  }

  // Simplices at v get w instead of v. Simplices with both vertices vanish.
  template <class Vertices>
  static void move_star(VertexId v, VertexId w, std::vector<std::vector<std::uint32_t>>& stars,
                        const Vertices& vertices_of) {
    for (const std::uint32_t s : stars[v]) {
      auto& vertices = vertices_of(s);
      if (has(vertices, w)) {
        for (const VertexId x : vertices) {
          if (x != v) std::erase(stars[x], s);
        }
        vertices.fill(kNone);
      } else {
        std::replace(vertices.begin(), vertices.end(), v, w);
        stars[w].push_back(s);
      }
    }
    stars[v].clear();
  }

  std::size_t fixed_vertices_;
  const LocalFrame& frame_;
  const PointStore& points_;
  Predicates& predicates_;
  ConformingMesh& mesh_;
  std::vector<std::vector<std::uint32_t>> tets_, faces_;  // around each vertex
};

}  // namespace

std::size_t thin_out(std::span<const VertexId> around, int rings, std::size_t fixed_vertices,
                     const LocalFrame& frame, const PointStore& points, Predicates& predicates,
                     Control& control, ConformingMesh& mesh) {
  Thinning thinning(fixed_vertices, frame, points, predicates, mesh);
  std::vector<VertexId> left = thinning.removable_around(around, rings);
  const std::size_t candidates = left.size();
  // One that could not go may be able to when its neighbours have gone.
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](VertexId v) {
      control.poll_now(0, -1);
      return thinning.remove(v);
    });
  }
  thinning.finish();
  return candidates - left.size();
}

}  // namespace delmesher::policies
