// Removes an edge: the ring of tetrahedra around it is tetrahedrized anew, without the edge
// (Shewchuk 2002, "Two discrete optimization algorithms for the topological improvement of
// tetrahedral meshes"). An edge within a facet has a ring of two halves, each of which gets its
// own; the two triangles of the facet beside it become the other two of their quadrilateral.
//
// The operation only proposes a change. A judge says what fillings are worth:
//   Value nothing()                    of no tetrahedra
//   Value impossible()                 where there is no filling
//   Value both(Value, Value)           of two fillings
//   bool is_possible(Value)
//   bool is_known(TetId)               has the edge been tried from there in vain?
//   void begin(RegionId)               of the tetrahedra that come next
//   bool may_join(VertexId, VertexId)  may there be an edge between them?
//   bool add(Tet, Value&)              false if there must not be such a tetrahedron
//   bool is_worth(Value, Value best)   may it still become the best filling?
//   bool is_better(Value, Value best)
//   bool is_enough(Value)              then no other filling is tried
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::tetmesh {

template <class Judge>
class RemoveEdge {
 public:
  using Value = typename Judge::Value;
  // The longest ring that is considered.
  static constexpr int kLongest = 9;

  // A polygon of the ring's vertices, from the first to the last; between two triangles of a facet,
  // or all around.
  struct Polygon {
    int size = 0;
    RegionId region = kOutside;
    std::array<VertexId, kLongest + 1> vertex;
    // Of the best triangulation of vertices i to j: the third vertex of the triangle at i-j.
    std::array<std::array<std::int8_t, kLongest + 1>, kLongest + 1> middle;
  };

  explicit RemoveEdge(const MeshTopology& mesh) : mesh_(mesh) {}

  // Finds the ring around edge i-j of t. False if it is longer than `longest`, or if the edge may
  // not go or is known.
  bool find(TetId t, int i, int j, std::size_t longest, const Judge& judge) {
    a_ = mesh_.tet(t)[i];
    b_ = mesh_.tet(t)[j];
    longest_ = longest;
    return find_ring(t, judge) && split_ring();
  }
  // Then: the tetrahedra around the edge, its polygons, and whether it lies within a facet.
  const std::vector<TetId>& ring() const { return change_.removed; }
  const std::vector<Polygon>& polygons() const { return polygons_; }
  bool is_in_facet() const { return !change_.faces.empty(); }

  // Fills all polygons, each with its best filling. What they are worth together; impossible if one
  // has none.
  Value refill(Judge& judge) {
    change_.created.clear();
    Value sum = judge.nothing();
    for (Polygon& polygon : polygons_) {
      const Value value = triangulate(polygon, judge);
      if (!judge.is_possible(value)) return judge.impossible();
      sum = judge.both(sum, value);
      collect(polygon);
    }
    return sum;
  }
  const Change& change() const { return change_; }

 private:
  bool find_ring(TetId t, const Judge& judge) {
    if (!collect_ring(t, judge)) return false;
    const bool closed = vertices_ == ring().size();
    if (closed) return ring().size() >= 3;
    const TetId first = beginning(t);
    return first == t || (first != kNone && collect_ring(first, judge));
  }

  // From `first` on, so that (a, b, vertex[n], vertex[n + 1]) is the n-th tetrahedron.
  bool collect_ring(TetId first, const Judge& judge) {
    std::array<TetId, kLongest> ring;
    std::size_t n = 0;
    FacetId only = kNone;
    TetId u = first;
    // The corners of u that are not on the edge: the second one is also in the next tetrahedron.
    auto [x, y] = opposite_edge(mesh_.index_of(first, a_), mesh_.index_of(first, b_));
    do {
      if (n == longest_ || judge.is_known(u)) return false;
      const FacetId facet = mesh_.facet(u, y);
      // An edge between two facets stays.
      if (facet != kNone && only != kNone && facet != only) return false;
      if (facet != kNone) only = facet;
      ring[n] = u;
      vertex_[n] = mesh_.tet(u)[x];
      facet_[n++] = facet;
      const VertexId shared = mesh_.tet(u)[y];
      const TetId next = mesh_.neighbor(u, x);
      vertices_ = n;
      if (next == kNone) {
        vertex_[n] = shared;
        facet_[n] = mesh_.facet(u, x);
        ++vertices_;
        break;
      }
      y = mesh_.mirror(u, x);
      x = mesh_.index_of(next, shared);
      u = next;
    } while (u != first);
    change_.removed.assign(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(n));
    return true;
  }

  // The first tetrahedron of an open ring; kNone if it is too far away.
  TetId beginning(TetId t) const {
    for (int steps = 0; steps <= static_cast<int>(longest_); ++steps) {
      const auto [x, y] = opposite_edge(mesh_.index_of(t, a_), mesh_.index_of(t, b_));
      const TetId previous = mesh_.neighbor(t, y);
      if (previous == kNone) return t;
      t = previous;
    }
    return kNone;
  }

  // Into the polygons between faces of the surface. False if the edge may not go.
  bool split_ring() {
    const std::size_t n = ring().size();
    const bool open = vertices_ > n;
    std::vector<std::size_t>& walls = walls_;
    walls.clear();
    for (std::size_t k = 0; k < vertices_; ++k) {
      if (facet_[k] != kNone) walls.push_back(k);
    }
    polygons_.clear();
    change_.faces.clear();
    const auto polygon = [&](std::size_t from, std::size_t steps) {
      Polygon p;
      p.size = static_cast<int>(steps) + 1;
      p.region = mesh_.region(ring()[from]);
      for (std::size_t k = 0; k <= steps; ++k) p.vertex[k] = vertex_[(from + k) % vertices_];
      polygons_.push_back(p);
    };
    if (walls.empty()) {
      if (open) return false;
      polygon(0, n - 1);
      return true;
    }
    if (walls.size() != 2 || facet_[walls[0]] != facet_[walls[1]]) return false;
    if (open && (walls[0] != 0 || walls[1] != n)) return false;
    polygon(walls[0], walls[1] - walls[0]);
    if (!open) polygon(walls[1], n - (walls[1] - walls[0]));
    const VertexId x = vertex_[walls[0]], y = vertex_[walls[1]];
    change_.faces = {{{a_, x, y}, facet_[walls[0]]}, {{b_, x, y}, facet_[walls[0]]}};
    return true;
  }

  // Two tetrahedra, towards a and b, for each triangle of the polygon (Klincsek's dynamic program).
  Value triangulate(Polygon& polygon, Judge& judge) {
    const int n = polygon.size;
    judge.begin(polygon.region);
    auto& best = best_;
    for (int i = 0; i + 1 < n; ++i) best[i][i + 1] = judge.nothing();
    for (int width = 2; width < n; ++width) {
      // Within a facet the edge from the first to the last vertex is new, too.
      const bool is_new = width < n - 1 || is_in_facet();
      for (int i = 0; i + width < n; ++i) {
        const int j = i + width;
        best[i][j] = judge.impossible();
        if (is_new && !judge.may_join(polygon.vertex[i], polygon.vertex[j])) continue;
        for (int k = i + 1; k < j; ++k) {
          Value value = judge.both(best[i][k], best[k][j]);
          const auto& v = polygon.vertex;
          const auto add = [&](const Tet& tet) {
            return judge.add(tet, value) && judge.is_worth(value, best[i][j]);
          };
          if (!judge.is_worth(value, best[i][j]) || !add({v[i], v[k], v[j], b_}) ||
              !add({v[k], v[i], v[j], a_}) || !judge.is_better(value, best[i][j])) {
            continue;
          }
          best[i][j] = value;
          polygon.middle[i][j] = static_cast<std::int8_t>(k);
          if (judge.is_enough(value)) break;
        }
      }
    }
    return best[0][n - 1];
  }

  void collect(const Polygon& polygon) {
    std::array<std::array<int, 2>, 2 * kLongest> open;
    int count = 0;
    open[count++] = {0, polygon.size - 1};
    while (count > 0) {
      const auto [i, j] = open[--count];
      if (j == i + 1) continue;
      const int k = polygon.middle[i][j];
      const auto& v = polygon.vertex;
      change_.created.push_back({{v[i], v[k], v[j], b_}, polygon.region});
      change_.created.push_back({{v[k], v[i], v[j], a_}, polygon.region});
      open[count++] = {i, k};
      open[count++] = {k, j};
    }
  }

  const MeshTopology& mesh_;
  VertexId a_ = 0, b_ = 0;
  std::size_t longest_ = kLongest;
  Change change_;             // removed: tetrahedra a, b, vertex[n], vertex[n + 1]
  std::size_t vertices_ = 0;  // one more than tetrahedra if the ring is open
  std::array<VertexId, kLongest + 1> vertex_{};
  std::array<FacetId, kLongest + 1> facet_{};  // of the face a, b, vertex[n]
  std::vector<std::size_t> walls_;             // numbers of the faces of the surface
  std::vector<Polygon> polygons_;
  std::array<std::array<Value, kLongest + 1>, kLongest + 1> best_;  // of triangulate()
};

}  // namespace delmesher::tetmesh
