// Removal of vertices. Tetrahedra all of whose vertices stay are Delaunay as before. The hole
// between them is filled from the Delaunay tetrahedrization of the vertices around it: its
// tetrahedra inside the hole are Delaunay among all vertices, too, and the perturbation makes the
// answer unique, so that their faces fit those around.

#include "mesher/base/check.h"
#include "mesher/base/sort_unique.h"
#include "mesher/base/validating.h"
#include "mesher/delaunay/tetrahedrization.h"

namespace delmesher::delaunay {

namespace {

// Are the corners of face f of t, in the order of kFace, this triangle, as oriented?
bool is_face(const VertexId* t, int f, const std::array<VertexId, 3>& triangle) {
  for (int k = 0; k < 3; ++k) {
    if (t[kFace[f][k]] != triangle[0]) continue;
    return t[kFace[f][(k + 1) % 3]] == triangle[1] && t[kFace[f][(k + 2) % 3]] == triangle[2];
  }
  return false;
}

}  // namespace

void Tetrahedrization::clear() {
  for (const Cell& cell : cell_) {
    for (const VertexId v : cell.vertex) {
      if (v < incident_.size()) incident_[v] = kNone;
    }
  }
  cell_.clear();
  state_.clear();
  star_mark_.clear();
  free_.clear();
  epoch_ = star_epoch_ = 0;
}

void Tetrahedrization::remove(std::span<const VertexId> vertices, Control& control) {
  std::vector<std::uint8_t> goes(incident_.size(), 0);
  for (const VertexId v : vertices) goes[v] = 1;
  Tetrahedrization patch(predicates_);
  for (const VertexId v : vertices) {
    control.poll(vertices.size());
    if (incident(v) == kNone) continue;  // went with another
    collect_hole(v, goes);
    std::vector<VertexId> around;
    for (const TetId t : cavity_) {
      for (int i = 0; i < 4; ++i) {
        const VertexId w = vertex(t, i);
        DELMESHER_CHECK(w != kInfinite, "a vertex of the hull is to be removed");
        if (goes[w] == 0) around.push_back(w);
      }
    }
    sort_unique(around);
    patch.clear();
    patch.first_tetrahedron(around);
    for (std::size_t n = 4; n < around.size(); ++n) {
      DELMESHER_CHECK(patch.insert(around[n], patch.incident(around[n - 1])),
                      "two vertices around a removed one coincide");
    }
    fill_hole(patch);
    for (const TetId t : cavity_) {
      for (int i = 0; i < 4; ++i) {
        if (goes[vertex(t, i)] != 0) incident_[vertex(t, i)] = kNone;
      }
      destroy(t);
    }
  }
}

// The stars of v and of all vertices to go that are connected with it by tetrahedra, as cavity.
void Tetrahedrization::collect_hole(VertexId v, std::span<const std::uint8_t> goes) {
  begin_cavity(incident(v));
  for (std::size_t n = 0; n < cavity_.size(); ++n) {
    const TetId t = cavity_[n];
    for (int i = 0; i < 4; ++i) {
      // Face i has the three other vertices. If one of them is removed, the neighbour goes too.
      const TetId u = neighbor(t, i);
      bool beyond = false;
      for (int k = 0; k < 4; ++k) {
        const VertexId w = vertex(t, k);
        beyond = beyond || (k != i && w != kInfinite && goes[w] != 0);
      }
      if (!beyond || state_[u].mark == epoch_) continue;
      state_[u].mark = epoch_;
      cavity_.push_back(u);
    }
  }
  for (const TetId t : cavity_) {
    for (int i = 0; i < 4; ++i) {
      if (!in_cavity(neighbor(t, i))) boundary_.push_back({t, i});
    }
  }
}

// Fills the cavity with the tetrahedra of the patch that are in it.
void Tetrahedrization::fill_hole(Tetrahedrization& patch) {
  // By face of the patch that is on the boundary: the face beyond it.
  std::vector<FaceHandle> outside(4 * patch.capacity());
  std::vector<TetId> copy(patch.capacity(), kNone), inside;
  for (const auto& [t, i] : boundary_) {
    const std::array<VertexId, 3> face = {vertex(t, kFace[i][0]), vertex(t, kFace[i][1]),
                                          vertex(t, kFace[i][2])};
    FaceHandle found = patch.find_face(face[0], face[1], face[2]);
    DELMESHER_CHECK(found.exists(), "a face around removed vertices is not Delaunay");
    if (!is_face(patch.vertices(found.tet()), found.face(), face)) found = patch.across(found);
    outside[found.index()] = cell_[t].neighbor[i];
    if (copy[found.tet()] != kNone) continue;
    copy[found.tet()] = 0;
    inside.push_back(found.tet());
  }
  for (std::size_t n = 0; n < inside.size(); ++n) {
    const TetId t = inside[n];
    DELMESHER_CHECK(!patch.is_ghost(t), "the patch for removed vertices has a gap");
    const VertexId* v = patch.vertices(t);
    copy[t] = create(v[0], v[1], v[2], v[3]);
    for (int i = 0; i < 4; ++i) {
      incident_[v[i]] = copy[t];
      const TetId u = patch.neighbor(t, i);
      if (outside[FaceHandle(t, i).index()].exists() || copy[u] != kNone) continue;
      copy[u] = 0;
      inside.push_back(u);
    }
  }
  for (const TetId t : inside) {
    for (int i = 0; i < 4; ++i) {
      const FaceHandle out = outside[FaceHandle(t, i).index()];
      if (out.exists()) {
        glue(copy[t], i, out.tet(), out.face());
      } else {
        glue(copy[t], i, copy[patch.neighbor(t, i)], patch.mirror(t, i));
      }
    }
  }
}

void Tetrahedrization::change_to(std::span<const VertexId> vertices, Control& control) {
  // Building again takes as long as removing about this part of the vertices.
  constexpr std::size_t kWorthwhile = 8;
  control.poll_now(vertices.size(), -1);
  std::vector<VertexId> missing, surplus;
  std::vector<std::uint8_t> stays(incident_.size(), 0);
  for (const VertexId v : vertices) {
    if (incident(v) == kNone) {
      missing.push_back(v);
    } else {
      stays[v] = 1;
    }
  }
  for (VertexId v = 0; v < incident_.size(); ++v) {
    if (incident_[v] != kNone && stays[v] == 0) surplus.push_back(v);
  }
  if ((missing.size() + surplus.size()) * kWorthwhile > vertices.size()) {
    clear();
    build(vertices, control);
    return;
  }
  remove(surplus, control);
  TetId hint = 0;
  while (!alive(hint)) ++hint;
  insert_in_order(in_spatial_order(missing), hint, control);
  if (kValidating) validate(true);
}

}  // namespace delmesher::delaunay
