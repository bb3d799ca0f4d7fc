// Delaunay tetrahedrization of points of a PointStore, on flat arrays, with exact predicates and
// the perturbed insphere, so that it is unique for given points and ids.
//
// Convention: tetrahedron t has vertices v0..v3 with orient3d > 0; face i is opposite vertex i; its
// neighbour is stored as the same face over there. The hull is closed by ghost tetrahedra with one
// vertex kInfinite. Face i of a positive tetrahedron, listed as in kFace[i], is counter-clockwise
// seen from outside (its normal points away from vertex i).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/growing_array.h"
#include "mesher/base/ids.h"
#include "mesher/delaunay/face_handle.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::delaunay {

inline constexpr VertexId kInfinite = kNone - 1;

// Vertices of face i, counter-clockwise seen from outside.
inline constexpr int kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
// The six edges, by the indices of their ends. Edge e and edge 5 - e are opposite, so kEdge[5 - e]
// are also the faces that share edge e.
inline constexpr int kEdge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

class Tetrahedrization {
 public:
  struct BoundaryFace {
    TetId inner;  // in the cavity
    int face;     // of `inner`
  };

  // Four bytes per tetrahedron for the caller's own purposes, where they cost no extra access to
  // memory. Zero in a slot that is used for the first time, else as its last user left them.
  using Notes = std::array<std::uint8_t, 4>;

  static constexpr std::uint32_t kMostTetrahedra = FaceHandle::kMostTetrahedra;

  // Stops at a limit of size, Stopped, when there would be more than `most` tetrahedra, ghosts
  // included.
  explicit Tetrahedrization(Predicates& predicates, std::uint32_t most = kMostTetrahedra);

  // Builds the tetrahedrization of the given points (at least four not coplanar; distinct),
  // inserted in a spatial order. Must be empty before.
  void build(std::span<const VertexId> vertices, Control& control);

  // Removes vertices that are not on the hull and leaves the Delaunay tetrahedrization of the
  // others.
  void remove(std::span<const VertexId> vertices, Control& control);

  // Turns the Delaunay tetrahedrization of other vertices into that of `vertices`, which must
  // include all vertices of its hull. Gives the same as build(), faster if they are nearly the same
  // vertices.
  void change_to(std::span<const VertexId> vertices, Control& control);

  // --- queries
  std::size_t capacity() const { return cell_.size(); }  // tet ids are below this
  bool alive(TetId t) const { return state_[t].mark != kDead; }
  std::size_t tetrahedra() const;  // alive and finite
  bool is_ghost(TetId t) const { return index_of(t, kInfinite) >= 0; }
  const VertexId* vertices(TetId t) const { return cell_[t].vertex; }
  VertexId vertex(TetId t, int i) const { return cell_[t].vertex[i]; }
  Notes& notes(TetId t) { return state_[t].notes; }
  const Notes& notes(TetId t) const { return state_[t].notes; }
  // Prefetches the memory that notes() and vertices() read.
  void prefetch(TetId t) const {
    __builtin_prefetch(&cell_[t]);
    __builtin_prefetch(&state_[t]);
  }
  // Neighbour across face i, and the same face's index over there.
  TetId neighbor(TetId t, int i) const { return cell_[t].neighbor[i].tet(); }
  int mirror(TetId t, int i) const { return cell_[t].neighbor[i].face(); }
  // The same face, as the tetrahedron on its other side has it.
  FaceHandle across(FaceHandle f) const { return cell_[f.tet()].neighbor[f.face()]; }
  VertexId opposite(FaceHandle f) const { return cell_[f.tet()].vertex[f.face()]; }
  // The faces of t that a finite tetrahedron with a smaller id has, too: bit i for face i, and bit
  // 4 + i if that tetrahedron is also alike.
  template <class Alike>
  std::uint8_t repeated_faces(TetId t, Alike&& alike) const {
    unsigned bits = 0;
    for (unsigned i = 0; i < 4; ++i) {
      const TetId u = cell_[t].neighbor[i].tet();
      if (u > t || is_ghost(u)) continue;
      bits |= 1U << i;
      if (alike(u)) bits |= 16U << i;
    }
    return static_cast<std::uint8_t>(bits);
  }
  // Some tetrahedron (never a ghost if avoidable) with vertex v; kNone if v is not a vertex.
  TetId incident(VertexId v) const { return v < incident_.size() ? incident_[v] : kNone; }
  // Index of vertex v in tetrahedron t, -1 if absent.
  int index_of(TetId t, VertexId v) const {
    const VertexId* w = cell_[t].vertex;
    return w[0] == v ? 0 : w[1] == v ? 1 : w[2] == v ? 2 : w[3] == v ? 3 : -1;
  }
  // Tetrahedra (ghosts included) around a vertex, in a deterministic order; valid until the next
  // call.
  std::span<const TetId> star(VertexId v);
  // A tetrahedron having edge ab, or kNone.
  TetId find_edge(VertexId a, VertexId b);
  // Face abc, of a tetrahedron that is not a ghost if possible, or none.
  FaceHandle find_face(VertexId a, VertexId b, VertexId c);
  // Tetrahedra (ghosts included) around edge ab, in rotation order starting at `t`, which has the
  // edge.
  void edge_ring(TetId t, VertexId a, VertexId b, std::vector<TetId>& ring) const;

  // --- insertion in three steps, so that a caller can look before it commits
  // A tetrahedron containing point v, walking from `hint`; a ghost if v is outside the hull. v need
  // not be a vertex. If v coincides with a vertex, that vertex's id is stored in *duplicate (else
  // kNone).
  TetId locate(VertexId v, TetId hint, VertexId* duplicate = nullptr);
  // Finds all tetrahedra whose (perturbed) circumsphere contains v, starting at one that does.
  void find_cavity(VertexId v, TetId start) {
    grow_cavity(v, start, [](TetId) { return true; });
  }
  // The same, nearest (in steps from face to face) first. visit(t) gets each tetrahedron of the
  // cavity once it is known which of its neighbours belong to it too, and returns false to give up;
  // so does grow_cavity then, and the cavity is incomplete.
  template <class Visit>
  bool grow_cavity(VertexId v, TetId start, Visit&& visit) {
    begin_cavity(start);
    for (std::size_t n = 0; n < cavity_.size(); ++n) {
      grow_across(cavity_[n], v);
      if (!visit(cavity_[n])) return false;
    }
    return true;
  }
  std::span<const TetId> cavity() const { return cavity_; }
  bool in_cavity(TetId t) const { return state_[t].mark == epoch_; }
  // Replaces the cavity by the star of v. The cavity's tetrahedra are dead afterwards but their
  // vertices stay readable until the next insertion; `created()` lists the new ones.
  void fill_cavity(VertexId v);
  std::span<const TetId> created() const { return created_; }
  // The faces bounding the last cavity: created()[n] is `inner` with the vertex at slot `face`
  // replaced by v.
  std::span<const BoundaryFace> cavity_boundary() const { return boundary_; }
  // All three steps. Returns false and does nothing if v coincides with a vertex.
  bool insert(VertexId v, TetId hint);

  // --- raw editing, for constrained tetrahedrizations: the caller keeps the structure consistent
  TetId create(VertexId a, VertexId b, VertexId c, VertexId d);
  void destroy(TetId t);
  void glue(TetId t, int i, TetId u, int j);
  void set_incident(VertexId v, TetId t) { incident_[v] = t; }

  // Walks the whole structure on raw indices: neighbour symmetry, shared vertices, orientation,
  // incident(), free slots. Throws InternalError at the first defect. With `delaunay`, also every
  // face locally Delaunay and the hull convex. Counts no predicates.
  void validate(bool delaunay);

  Predicates& predicates() { return predicates_; }

 private:
  void clear();
  std::vector<VertexId> in_spatial_order(std::span<const VertexId> vertices) const;
  void collect_hole(VertexId v, std::span<const std::uint8_t> goes);
  void fill_hole(Tetrahedrization& patch);
  // Inserts new vertices, each near the one before it, from `hint` on.
  void insert_in_order(std::span<const VertexId> order, TetId hint, Control& control);
  TetId allocate();
  void first_tetrahedron(std::span<VertexId> order);
  bool conflicts(TetId t, VertexId v);
  void begin_cavity(TetId start);
  void grow_across(TetId t, VertexId v);
  // Walks the star of v, collecting it in star_, until visit(t) returns false.
  template <class Visit>
  void walk_star(VertexId v, Visit&& visit);
  // Creates the tetrahedron of v over one cavity boundary face.
  TetId cone(const BoundaryFace& boundary, VertexId v);
  void glue_around(TetId created, const BoundaryFace& boundary);
  std::uint32_t next_random() { return random_ = random_ * 1664525U + 1013904223U; }

  friend struct TetrahedrizationBreaker;  // of the tests of validate()

  Predicates& predicates_;
  std::uint32_t most_;
  // Half a cache line.
  struct alignas(32) Cell {
    VertexId vertex[4] = {kNone, kNone, kNone, kNone};
    FaceHandle neighbor[4];  // the same face over there
  };
  GrowingArray<Cell> cell_;
  static constexpr std::uint32_t kDead = 0xffffffffU;
  struct State {
    std::uint32_t mark;  // kDead; epoch_: in the cavity; epoch_ + 1: visited, not in it
    Notes notes;
  };
  GrowingArray<State> state_;
  std::vector<TetId> free_;
  std::vector<TetId> incident_;  // per point of the store
  std::uint32_t epoch_ = 0;
  std::uint32_t random_ = 1;
  std::vector<TetId> cavity_, created_;
  std::vector<BoundaryFace> boundary_;
  std::vector<TetId> star_;
  GrowingArray<std::uint32_t> star_mark_;
  std::uint32_t star_epoch_ = 0;
};

}  // namespace delmesher::delaunay
