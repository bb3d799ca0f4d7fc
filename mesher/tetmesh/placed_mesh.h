// A mesh while it changes: its topology, the placement of its vertices, and which changes leave it
// valid.
//
// A vertex is at a point of a store, exactly, and at doubles, where it is written. Where it may go
// depends on what it is on. Who changes the mesh keeps tables of his own, of qualities or signs:
// note() tells of each tetrahedron that is new or elsewhere.
//
// Laws:
//  - What accept() makes is positive as doubles, and on the exact points of each store that is
//    asked.
//  - changed_at(v) is the time of the last change of a tetrahedron at v.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/predicates/predicates.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/tetmesh/mesh_topology.h"
#include "mesher/tetmesh/mobility.h"
#include "mesher/tetmesh/numbering.h"

namespace delmesher::tetmesh {

// Where a vertex is or could be: a point of the store, and as it is written.
struct Place {
  VertexId point;
  Vec3 position;
};

class PlacedMesh {
 public:
  MeshTopology mesh;

  VertexId point(VertexId v) const { return point_[v]; }
  ConformingMesh conforming() const { return mesh_of(mesh, point_); }
  const Vec3& position(VertexId v) const { return position_[v]; }
  std::span<const Vec3> positions() const { return position_; }
  Mobility mobility(VertexId v) const { return mobility_[v]; }

  // Counts changes.
  std::uint32_t clock() const { return clock_; }
  // When a tetrahedron at v last changed.
  std::uint32_t changed_at(VertexId v) const { return changed_at_[v]; }

  // As written: the sign of any four vertices, or of t with its i-th vertex at x.
  int sign_of(const Tet& t) const { return sign_with(t, 0, position_[t[0]]); }
  int sign_with(const Tet& t, int i, const Vec3& x) const {
    const auto at = [&](int k) -> const Vec3& { return k == i ? x : position_[t[k]]; };
    return orient3d_sign(at(0), at(1), at(2), at(3));
  }
  // Positive as written and on exact points.
  bool is_positive(const Tet& t) const {
    return is_positive_with(t, 0, {point_[t[0]], position_[t[0]]});
  }
  bool is_positive_with(const Tet& t, int i, const Place& place) const {
    if (sign_with(t, i, place.position) <= 0) return false;
    const auto at = [&](int k) { return k == i ? place.point : point_[t[k]]; };
    for (Predicates* exact : exact_) {
      if (exact->orient3d(at(0), at(1), at(2), at(3)) <= 0) return false;
    }
    return true;
  }

  // Contracts the edge from v to w: v goes. `star`: the tetrahedra around v.
  void contract(VertexId v, VertexId w, std::span<const TetId> star);
  // Makes the change if all that it creates is positive.
  bool accept(const Change& change);
  void replace(std::span<const TetId> removed, std::span<const CreatedTet> created,
               std::span<const SurfaceFace> faces);

 protected:
  explicit PlacedMesh(NumberedMesh numbered)
      : mesh(std::move(numbered.topology)),
        point_(std::move(numbered.point)),
        mobility_(point_.size(), Mobility::free),
        changed_at_(point_.size(), 0) {}
  ~PlacedMesh() = default;
  PlacedMesh(const PlacedMesh&) = delete;
  PlacedMesh& operator=(const PlacedMesh&) = delete;

  virtual void note(TetId t) = 0;
  void note_change(TetId t) {
    for (const VertexId v : mesh.tet(t)) changed_at_[v] = clock_;
  }
  void changed(TetId t) {
    note(t);
    note_change(t);
  }

  // Per vertex.
  std::vector<VertexId> point_;
  std::vector<Vec3> position_;
  std::vector<Mobility> mobility_;
  std::vector<std::uint32_t> changed_at_;
  std::uint32_t clock_ = 0;
  std::vector<Predicates*> exact_;  // of the stores that are asked
};

}  // namespace delmesher::tetmesh
