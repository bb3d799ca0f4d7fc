// A constrained Delaunay triangulation in the plane (Bowyer 1981, Watson 1981, Lawson 1977):
// locate, insert, enter segments, remove. It covers a rectangle whose corners are its first
// vertices, so that every other point is inside and no case is special but its border.
//
// Laws (triangulation_test.cpp, validate()):
//  (1) All triangles are counter-clockwise; neighbours agree on their common edge and its piece.
//  (2) An edge without piece is locally Delaunay under in_circle_perturbed, after every call; but
//      the rectangle begins with any of its diagonals, which the first point inside replaces.
//  (3) No point that is inserted, and no segment that is entered, removes an edge with a piece but
//      the one it splits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/ids.h"
#include "mesher/plane/plane_predicates.h"

namespace delmesher::plane {

using TriangleId = std::uint32_t;
// Edge i of triangle t, opposite its corner i: 4 t + i.
using EdgeId = std::uint32_t;
// A straight constraint; the triangulation only carries the number about.
using PieceId = std::uint32_t;

inline TriangleId triangle_of(EdgeId e) {
  return e >> 2;
}
inline int index_of(EdgeId e) {
  return static_cast<int>(e & 3U);
}
inline EdgeId edge_of(TriangleId t, int i) {
  return 4 * t + static_cast<EdgeId>(i);
}
inline constexpr std::array<int, 5> kCyclic = {0, 1, 2, 0, 1};
inline int next(int i) {
  return kCyclic[static_cast<std::size_t>(i) + 1];
}
inline int previous(int i) {
  return kCyclic[static_cast<std::size_t>(i) + 2];
}

struct Triangle {
  std::array<VertexId, 3> vertex;  // counter-clockwise
  std::array<EdgeId, 3> neighbor;  // the same edge in the triangle beyond, or kNone
  std::array<PieceId, 3> piece;    // constraint that the edge belongs to, or kNone
};

struct Location {
  TriangleId triangle;
  // 0 bits: strictly inside; bit i: on the line of edge i. Two bits: at the corner that is on both.
  unsigned zeros;
};

class Triangulation {
 public:
  explicit Triangulation(PlanePredicates& predicates) : predicates_(&predicates) {}

  // The rectangle, counter-clockwise; its sides belong to the given pieces.
  void start(const std::array<VertexId, 4>& corners, const std::array<PieceId, 4>& pieces);

  std::size_t size() const { return triangles_.size(); }
  const Triangle& operator[](TriangleId t) const { return triangles_[t]; }
  bool has_vertex(VertexId v) const { return v < around_.size() && around_[v] != kNone; }
  // Some triangle at a vertex.
  TriangleId around(VertexId v) const { return around_[v]; }
  VertexId origin(EdgeId e) const { return triangle(e).vertex[next_index(e)]; }
  VertexId target(EdgeId e) const { return triangle(e).vertex[previous_index(e)]; }
  VertexId opposite(EdgeId e) const {
    return triangle(e).vertex[static_cast<std::size_t>(index_of(e))];
  }
  EdgeId twin(EdgeId e) const {
    return triangle(e).neighbor[static_cast<std::size_t>(index_of(e))];
  }
  PieceId piece(EdgeId e) const { return triangle(e).piece[static_cast<std::size_t>(index_of(e))]; }
  // The edge from a to b in the triangle on its left (or from b to a, where only that exists), or
  // kNone.
  EdgeId find_edge(VertexId a, VertexId b) const;

  // Walks from a triangle to the point. Crosses constraints.
  Location locate(VertexId p, TriangleId from);
  // The same along the straight line from a triangle, but not across a constraint: then `blocked`
  // is the edge that it met, seen from this side.
  struct Sight {
    Location location;
    EdgeId blocked;  // or kNone
  };
  Sight look(VertexId p, TriangleId from);

  // --- insertion in two steps, so that a caller may look before it leaps

  struct BoundaryEdge {
    VertexId from, to;  // the cavity is on the left
    EdgeId outer;       // the edge beyond, or kNone
    PieceId piece;
    TriangleId inner;  // triangle of the cavity at this edge
  };
  // The triangles whose circles contain p (under perturbation) and that are connected with its
  // location without crossing a constraint. `split` is the constrained edge that p lies on, or
  // kNone.
  void find_cavity(VertexId p, TriangleId at, EdgeId split);
  const std::vector<BoundaryEdge>& boundary() const { return boundary_; }
  const std::vector<TriangleId>& cavity() const { return cavity_; }
  // Fills the cavity with triangles that have p as corner 0; the k-th lies at the k-th edge of
  // boundary(), except that none lies at a split side of the rectangle.
  void fill_cavity(VertexId p);
  // Triangle made at each edge of boundary() by the last fill_cavity.
  const std::vector<TriangleId>& created() const { return created_; }

  // Both, without looking. Returns p, or the vertex that is there already.
  VertexId insert(VertexId p, TriangleId from);

  // --- segments

  struct Obstacle {
    enum class Kind : std::uint8_t { none, crossing, overlap };
    Kind kind = Kind::none;
    PieceId piece = kNone;  // constraint that is crossed or overlapped
  };
  // Enters the straight line from a to b as edges of `piece`, by flips. Vertices on it split it:
  // `chain` are its vertices from a to b. Stops at the first obstacle.
  Obstacle insert_segment(VertexId a, VertexId b, PieceId piece, std::vector<VertexId>& chain);

  // Takes out a vertex at which no edge has a piece. Triangles get other numbers.
  void remove(VertexId v);

  void set_piece(EdgeId e, PieceId piece);
  // Gives the vertex `from` the id `to`, which the triangulation must not have.
  void rename(VertexId from, VertexId to);
  // Triangles at v, counter-clockwise (all around if v is not on the border), as the edges opposite
  // v.
  void star(VertexId v, std::vector<EdgeId>& edges) const;

  // Throws InternalError at the first law of structure that is broken. `delaunay`: law 2 as well.
  void validate(bool delaunay) const;

  void reserve(std::size_t vertices);
  // Numbers the triangles again, in the order of their smallest vertices.
  void renumber();

 private:
  const Triangle& triangle(EdgeId e) const { return triangles_[triangle_of(e)]; }
  static std::size_t next_index(EdgeId e) { return static_cast<std::size_t>(next(index_of(e))); }
  static std::size_t previous_index(EdgeId e) {
    return static_cast<std::size_t>(previous(index_of(e)));
  }
  void link(EdgeId e, EdgeId f);
  void grow_around(VertexId v);
  void add_to_cavity(VertexId p, EdgeId crossing);
  void flip(EdgeId e);
  bool convex(EdgeId e);
  void legalize(std::vector<TriangleId>& stack);
  bool is_ear(std::size_t k);  // of boundary_, at its edges k and k + 1
  void drop(TriangleId t);
  Location locate_here(VertexId p, TriangleId t);  // not in t: kNone, an edge that it is beyond
  EdgeId first_crossing(VertexId a, VertexId b, VertexId& on_line, EdgeId& along);
  Obstacle cross(VertexId a, VertexId b, EdgeId first, VertexId& end);

  PlanePredicates* predicates_;
  std::vector<Triangle> triangles_;
  std::vector<TriangleId> around_;
  std::vector<TriangleId> cavity_, created_;
  std::vector<BoundaryEdge> boundary_;
  std::vector<EdgeId> stack_;
  std::vector<EdgeId> crossed_;
  EdgeId split_ = kNone;
  VertexId split_from_ = kNone, split_to_ = kNone;
  PieceId split_piece_ = kNone;
  std::uint32_t random_ = 1;  // a fixed sequence: which side a walk tries first
};

}  // namespace delmesher::plane
