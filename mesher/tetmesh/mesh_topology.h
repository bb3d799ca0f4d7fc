// The tetrahedra of a mesh that local operations change: their neighbours, the regions that they
// are in, and which faces are on the surface. It knows no coordinates. Vertices have numbers of
// their own.
//
// Invariants (validate()):
//  - a face has one tetrahedron, or two that name each other as neighbours across it;
//  - the two tetrahedra at a face of the surface agree on its facet; where there is no facet, both
//    are of one region;
//  - incident(v) is alive and has v as a vertex, for every vertex of the mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/epoch.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::tetmesh {

// A new tetrahedron of a local operation.
struct CreatedTet {
  Tet vertices;
  RegionId region;
};

// What a local operation does: tetrahedra are replaced by others with the same outer faces.
struct Change {
  std::vector<TetId> removed;
  std::vector<CreatedTet> created;
  std::vector<SurfaceFace> faces;  // of the surface, between those created
};

// The two vertices of a tetrahedron other than i and j, such that (i, j, x, y) is an even
// permutation.
inline std::array<int, 2> opposite_edge(int i, int j) {
  static constexpr int kOpposite[4][4][2] = {{{0, 0}, {2, 3}, {3, 1}, {1, 2}},
                                             {{3, 2}, {0, 0}, {0, 3}, {2, 0}},
                                             {{1, 3}, {3, 0}, {0, 0}, {0, 1}},
                                             {{2, 1}, {0, 2}, {1, 0}, {0, 0}}};
  return {kOpposite[i][j][0], kOpposite[i][j][1]};
}

class MeshTopology {
 public:
  MeshTopology(std::vector<Tet> tetrahedra, std::span<const RegionId> region,
               std::span<const SurfaceFace> boundary, std::size_t vertices);

  std::size_t slots() const { return tet_.size(); }
  std::size_t tetrahedra() const { return tet_.size() - free_.size(); }
  bool alive(TetId t) const { return tet_[t][0] != kNone; }
  const Tet& tet(TetId t) const { return tet_[t]; }
  RegionId region(TetId t) const { return region_[t]; }
  bool inside(TetId t) const { return region_[t] != kOutside; }
  // kNone beyond the hull.
  TetId neighbor(TetId t, int i) const {
    return neighbor_[t][i] == kNone ? kNone : neighbor_[t][i] >> 2U;
  }
  int mirror(TetId t, int i) const { return static_cast<int>(neighbor_[t][i] & 3U); }
  // The facet that face i of t tiles, kNone if it is not on the surface.
  FacetId facet(TetId t, int i) const { return facet_[t][i]; }
  // Of the two sides of face i of t, on the surface, is it this one that tells of it? The one of
  // the larger region does, so that it is never the outside.
  bool is_told_from(TetId t, int i) const {
    const TetId u = neighbor(t, i);
    return u == kNone || region_[u] < region_[t] || (region_[u] == region_[t] && u < t);
  }
  // ConformingMesh::repeated_faces, with tetrahedra in the order of their slots.
  std::uint8_t repeated_faces(TetId t) const {
    unsigned repeated = 0;
    for (int i = 0; i < 4; ++i) {
      const TetId u = neighbor(t, i);
      if (u < t) repeated |= (inside(u) == inside(t) ? 17U : 1U) << static_cast<unsigned>(i);
    }
    return static_cast<std::uint8_t>(repeated);
  }
  // Some tetrahedron at v; kNone if there is none any more.
  TetId incident(VertexId v) const { return incident_[v]; }
  std::size_t vertices() const { return incident_.size(); }
  int index_of(TetId t, VertexId v) const {
    const Tet& w = tet_[t];
    return w[0] == v ? 0 : w[1] == v ? 1 : w[2] == v ? 2 : w[3] == v ? 3 : -1;
  }

  // The tetrahedra around v, in an order that depends on the mesh alone.
  void star(VertexId v, std::vector<TetId>& star) const;
  // The vertices with tetrahedra that are not in their star, since no faces connect them.
  std::vector<VertexId> pinched() const;

  // A new vertex, without tetrahedra as yet.
  VertexId add_vertex() {
    incident_.push_back(kNone);
    return static_cast<VertexId>(incident_.size() - 1);
  }
  // Contracts the edge from v to w: v goes. `star`: the tetrahedra around v. Those at both are
  // removed.
  void contract(VertexId v, VertexId w, std::span<const TetId> star);
  // Replaces tetrahedra by others with the same outer faces; faces between the new ones that are on
  // the surface are given. The slots of the new ones are in created().
  void replace(std::span<const TetId> removed, std::span<const CreatedTet> created,
               std::span<const SurfaceFace> faces);
  std::span<const TetId> created() const { return created_; }

  // Throws InternalError at the first invariant that does not hold.
  void validate() const;

 private:
  struct FaceEntry {
    std::array<VertexId, 3> key;
    std::uint32_t side;  // 4 * tet + face, kNone beyond the hull
    FacetId facet;
    bool created;
  };

  void link(std::span<const SurfaceFace> boundary);
  void join(const FaceEntry& a, const FaceEntry& b);
  TetId take_slot();

  std::vector<Tet> tet_;
  std::vector<std::array<std::uint32_t, 4>> neighbor_;  // 4 * tet + face
  std::vector<std::array<FacetId, 4>> facet_;
  std::vector<RegionId> region_;
  std::vector<TetId> incident_;  // per vertex
  std::vector<TetId> free_;
  mutable std::vector<std::uint32_t> mark_;  // of star()
  mutable std::uint32_t epoch_ = 0;
  std::vector<TetId> created_;
  std::vector<FaceEntry> faces_;  // of replace()
  std::vector<VertexId> vertices_;
};

}  // namespace delmesher::tetmesh
