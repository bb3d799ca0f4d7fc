// Plain rational arithmetic for the tests of this folder; shares nothing with the predicates.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesher/cdt/cdt.h"

namespace delmesher::cdt::rational {

using Vector = std::array<mpq_class, 3>;

inline Vector minus(const Vector& a, const Vector& b) {
  return {mpq_class(a[0] - b[0]), mpq_class(a[1] - b[1]), mpq_class(a[2] - b[2])};
}
inline Vector cross(const Vector& a, const Vector& b) {
  return {mpq_class(a[1] * b[2] - a[2] * b[1]), mpq_class(a[2] * b[0] - a[0] * b[2]),
          mpq_class(a[0] * b[1] - a[1] * b[0])};
}
inline mpq_class dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline bool is_zero(const Vector& a) {
  return sgn(a[0]) == 0 && sgn(a[1]) == 0 && sgn(a[2]) == 0;
}
inline Vector area(const Vector& a, const Vector& b, const Vector& c) {
  return cross(minus(b, a), minus(c, a));
}
// Six times the signed volume.
inline mpq_class volume(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  return dot(area(a, b, c), minus(d, a));
}

inline Vector exact(const PointStore& points, VertexId v) {
  const auto given = [&](VertexId w) {
    const Vec3 p = points.nearest(w);
    return Vector{mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
  };
  const PointDefinition& d = points.definition(v);
  if (d.kind == PointKind::explicit_point) return given(v);
  const Vector p = given(d.corner[0]), q = given(d.corner[1]);
  const bool segment = d.kind == PointKind::on_segment;
  const Vector r = segment ? q : given(d.corner[2]);
  Vector x;
  for (int k = 0; k < 3; ++k) {
    x[k] = r[k] + mpq_class(d.u) * (p[k] - r[k]);
    if (!segment) x[k] += mpq_class(d.v) * (q[k] - r[k]);
  }
  return x;
}

// sign of the insphere determinant of a positive tetrahedron: +1 if e is inside.
inline int in_sphere(const Vector& a, const Vector& b, const Vector& c, const Vector& d,
                     const Vector& e) {
  const Vector r[4] = {minus(a, e), minus(b, e), minus(c, e), minus(d, e)};
  mpq_class w[4];
  for (int i = 0; i < 4; ++i) w[i] = dot(r[i], r[i]);
  const auto det = [&](int i, int j, int k) { return dot(cross(r[i], r[j]), r[k]); };
  const mpq_class s =
      w[0] * det(1, 2, 3) - w[1] * det(0, 2, 3) + w[2] * det(0, 1, 3) - w[3] * det(0, 1, 2);
  return sgn(s);
}

// Everything that makes the result a constrained Delaunay tetrahedrization of the surface, or a
// mesh just any that conforms to it; returns a description of the first defect, or an empty string.
class Checker {
 public:
  Checker(const SurfaceTopology& surface, const PointStore& points, const CdtResult& result)
      : Checker(surface, points, result.mesh) {
    delaunay_ = &result;
  }
  Checker(const SurfaceTopology& surface, const PointStore& points, const ConformingMesh& mesh)
      : s_(surface), mesh_(mesh) {
    for (VertexId v = 0; v < points.size(); ++v) x_.push_back(exact(points, v));
  }

  std::string run() {
    std::string what = volumes();
    if (what.empty()) what = facets();
    if (what.empty() && delaunay_ != nullptr) what = chains();
    if (what.empty()) what = faces();
    return what;
  }

 private:
  std::string volumes() {
    mpq_class inside = 0, surface = 0;
    for (std::size_t n = 0; n < mesh_.tetrahedra.size(); ++n) {
      const auto& t = mesh_.tetrahedra[n];
      const mpq_class v = volume(x_[t[0]], x_[t[1]], x_[t[2]], x_[t[3]]);
      if (sgn(v) <= 0) return "tetrahedron not positive";
      if (mesh_.region[n] != kOutside) inside += v;
    }
    for (const auto& t : s_.triangles) surface += dot(cross(x_[t[0]], x_[t[1]]), x_[t[2]]);
    return inside == surface ? "" : "volume inside differs from the solid's";
  }

  std::string facets() {
    std::vector<Vector> left(s_.facet_triangles.size(), Vector{0, 0, 0});
    for (std::size_t t = 0; t < s_.triangles.size(); ++t)
      add(left[s_.facet_of[t]], s_.triangles[t], 1);
    for (const SurfaceFace& f : mesh_.boundary) {
      const auto& frame = s_.triangles[s_.facet_triangles[f.facet][0]];
      const Vector normal = area(x_[frame[0]], x_[frame[1]], x_[frame[2]]);
      const auto& v = f.vertices;
      if (sgn(dot(normal, area(x_[v[0]], x_[v[1]], x_[v[2]]))) <= 0) return "face turned over";
      for (const VertexId w : v) {
        if (sgn(dot(normal, minus(x_[w], x_[frame[0]]))) != 0)
          return "face not in its facet's plane";
      }
      add(left[f.facet], v, -1);
    }
    for (const Vector& a : left) {
      if (!is_zero(a)) return "facet not covered exactly";
    }
    return "";
  }
  void add(Vector& sum, const std::array<VertexId, 3>& t, int sign) const {
    const Vector a = area(x_[t[0]], x_[t[1]], x_[t[2]]);
    for (int k = 0; k < 3; ++k) sum[k] += sign * a[k];
  }

  std::string chains() {
    for (std::uint32_t e = 0; e < s_.edge_count(); ++e) {
      const std::vector<VertexId>& c = delaunay_->chain[e];
      if (s_.edge_is_flat[e] != 0) {
        if (!c.empty()) return "chain of a flat edge";
        continue;
      }
      const auto end = s_.edge_vertices(e);
      if (c.size() < 2 || c.front() != end[0] || c.back() != end[1])
        return "chain without its ends";
      const Vector d = minus(x_[end[1]], x_[end[0]]);
      mpq_class last = -1;
      for (const VertexId v : c) {
        const Vector w = minus(x_[v], x_[end[0]]);
        if (!is_zero(cross(d, w))) return "chain not straight";
        const mpq_class along = dot(d, w);
        if (along <= last) return "chain out of order";
        last = along;
      }
    }
    return "";
  }

  std::string faces() {
    using Key = std::array<VertexId, 3>;
    std::set<Key> constrained;
    for (const SurfaceFace& f : mesh_.boundary) {
      Key k = f.vertices;
      std::sort(k.begin(), k.end());
      if (!constrained.insert(k).second) return "boundary face given twice";
    }
    std::map<Key, std::vector<std::array<std::size_t, 2>>> sides;
    for (std::size_t n = 0; n < mesh_.tetrahedra.size(); ++n) {
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& t = mesh_.tetrahedra[n];
        Key k = {t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]};
        std::sort(k.begin(), k.end());
        sides[k].push_back({n, i});
      }
    }
    std::size_t found = 0;
    for (const auto& [key, list] : sides) {
      const bool wall = constrained.count(key) != 0;
      found += wall ? 1 : 0;
      if (list.size() > 2) return "face of three tetrahedra";
      const bool inside = mesh_.region[list[0][0]] != kOutside;
      const bool beyond = list.size() == 2 && mesh_.region[list[1][0]] != kOutside;
      if ((inside != beyond) != wall) return "wrong inside flag";
      if (wall || list.size() == 1 || delaunay_ == nullptr) continue;
      const auto& t = mesh_.tetrahedra[list[0][0]];
      const VertexId across = mesh_.tetrahedra[list[1][0]][list[1][1]];
      if (in_sphere(x_[t[0]], x_[t[1]], x_[t[2]], x_[t[3]], x_[across]) > 0) return "not Delaunay";
    }
    return found == constrained.size() ? "" : "boundary face missing";
  }

  const SurfaceTopology& s_;
  const ConformingMesh& mesh_;
  const CdtResult* delaunay_ = nullptr;
  std::vector<Vector> x_;
};

}  // namespace delmesher::cdt::rational
