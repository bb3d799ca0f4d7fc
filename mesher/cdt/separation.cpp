#include "mesher/cdt/separation.h"

#include <algorithm>

namespace delmesher::cdt {
namespace {

enum : unsigned { kInTetrahedron = 1, kInTriangle = 2, kInBoth = 3 };

// The union of the vertices of a tetrahedron and a triangle.
class Pair {
 public:
  Pair(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
       const std::array<VertexId, 3>& triangle)
      : predicates_(predicates) {
    for (const VertexId v : tetrahedron) add(v, kInTetrahedron);
    for (const VertexId v : triangle) add(v, kInTriangle);
  }

  int shared() const { return 7 - size_; }

  // Is there a plane through three vertices that has the two on different sides, and meets them in
  // nothing but the simplex of their common vertices?
  bool separable() {
    for (int i = 0; i < size_; ++i) {
      for (int j = i + 1; j < size_; ++j) {
        for (int k = j + 1; k < size_; ++k) {
          if (separates(i, j, k)) return true;
        }
      }
    }
    return false;
  }

 private:
  void add(VertexId v, unsigned where) {
    for (int i = 0; i < size_; ++i) {
      if (vertex_[i] == v) {
        where_[i] |= where;
        return;
      }
    }
    vertex_[size_] = v;
    where_[size_++] = where;
  }

  bool separates(int i, int j, int k) {
    int side = 0;  // of the tetrahedron, minus that of the triangle
    int on_plane = 3;
    unsigned on = 0;  // who has vertices on the plane that are not common to both
    for (int n : {i, j, k}) on |= where_[n] == kInBoth ? 0U : where_[n];
    for (int n = 0; n < size_; ++n) {
      if (n == i || n == j || n == k) continue;
      int s = predicates_.orient3d(vertex_[i], vertex_[j], vertex_[k], vertex_[n]);
      if (s == 0) {
        ++on_plane;
        if (where_[n] != kInBoth) on |= where_[n];
        continue;
      }
      if (where_[n] == kInBoth) return false;
      if (where_[n] == kInTriangle) s = -s;
      if (side != 0 && s != side) return false;
      side = s;
    }
    // All on the "plane": three collinear points, since the tetrahedron is not flat.
    if (on_plane == size_) return false;
    return on_plane == 3 || on != kInBoth;
  }

  Predicates& predicates_;
  std::array<VertexId, 7> vertex_{};
  std::array<unsigned, 7> where_{};
  int size_ = 0;
};

}  // namespace

bool may_meet_improperly(Predicates& predicates, const std::array<VertexId, 4>& tetrahedron,
                         const std::array<VertexId, 3>& triangle) {
  Pair pair(predicates, tetrahedron, triangle);
  return pair.shared() < 3 && !pair.separable();
}

bool boxes_disjoint(const PointStore& points, const std::array<VertexId, 4>& tetrahedron,
                    const std::array<VertexId, 3>& triangle) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto range = [&](const auto& vertices) {
      std::array<double, 2> r = {0, 0};
      for (std::size_t n = 0; n < vertices.size(); ++n) {
        const Approximation& p = points.approximation(vertices[n]);
        const double x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
        r[0] = n == 0 ? x - 2 * p.error : std::min(r[0], x - 2 * p.error);
        r[1] = n == 0 ? x + 2 * p.error : std::max(r[1], x + 2 * p.error);
      }
      return r;
    };
    const std::array<double, 2> a = range(tetrahedron), b = range(triangle);
    if (a[1] < b[0] || b[1] < a[0]) return true;
  }
  return false;
}

}  // namespace delmesher::cdt
