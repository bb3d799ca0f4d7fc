// The mesh on rounded coordinates while it is being repaired: positions and exact signs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "mesher/output/rounding.h"
#include "mesher/tetmesh/mesh_topology.h"

namespace delmesher::output {

// How bad some tetrahedra are: first how many are not positive, then how many of these are
// inverted. Repairs decrease it, so they end; separating may keep it, untangling has a budget.
using Badness = std::int64_t;
inline constexpr Badness kOneBad = Badness{1} << 32;
inline Badness badness(int sign) {
  return sign > 0 ? 0 : kOneBad + (sign < 0 ? 1 : 0);
}

// Vertices are local indices, ascending with their ids in the store.
class RoundedMesh {
 public:
  // Rounds to nearest and decides the sign of every tetrahedron. The input must outlive the mesh;
  // its tetrahedra are moved out of it.
  RoundedMesh(RoundingInput& input, Control& control);

  std::size_t vertices() const { return store_id_.size(); }
  VertexId store_id(std::uint32_t v) const { return store_id_[v]; }
  const Vec3& position(std::uint32_t v) const { return position_[v]; }
  // Nearest doubles of the exact position (or RoundingInput::place), and the bound of their error.
  Vec3 home(std::uint32_t v) const { return placed(store_id_[v]); }
  double home_error(std::uint32_t v) const;
  const LocalFrame& frame() const { return input_.frame; }
  bool fixed(std::uint32_t v) const { return input_.fixed[store_id_[v]] != 0; }
  bool on_surface(std::uint32_t v) const { return input_.on_surface[store_id_[v]] != 0; }
  bool moves_far(std::uint32_t v) const { return !on_surface(v) && input_.place.empty(); }
  // The largest component of the places of the surface's vertices, in the given frame; where there
  // are no faces of the surface, of all that is held in place. The box around the surface is larger
  // and says nothing about the surface's scale.
  double largest_of_surface() const;

  std::size_t slots() const { return topology_ ? topology_->slots() : tet_.size(); }
  bool alive(TetId t) const { return tet(t)[0] != kNone; }
  const Tet& tet(TetId t) const { return topology_ ? topology_->tet(t) : tet_[t]; }
  RegionId region(TetId t) const { return topology_ ? topology_->region(t) : region_[t]; }
  int sign(TetId t) const { return sign_[t]; }
  // Slots of the tetrahedra that are not positive.
  const std::set<TetId>& bad() const { return bad_; }
  // Groups of vertices with equal coordinates, in their order. Moved vertices are in none.
  std::vector<std::vector<std::uint32_t>> coincident() const;

  // Must be called before anything below. Costs memory, so a mesh with nothing to repair skips it.
  void prepare_repairs();
  const MeshTopology& topology() const { return *topology_; }
  // The tetrahedra around v, ascending.
  std::vector<TetId> star(std::uint32_t v) const;
  // Is the star of v a ball with v inside?
  bool is_enclosed(std::uint32_t v) const;
  // Is there a vertex at p?
  bool occupied(const Vec3& p) const;
  // The sign that t would have with its vertex v at p, and that of any four vertices.
  int sign_at(TetId t, std::uint32_t v, const Vec3& p);
  int sign_of(const Tet& vertices);
  // How many signs of these two kinds have been decided.
  std::uint64_t signs() const { return signs_; }
  void move(std::uint32_t v, const Vec3& p);
  // To be told when a move is there to stay.
  void note_change(std::uint32_t v);
  // Counts changes. Where nothing changed since a repair failed, it need not be tried again.
  std::uint32_t clock() const { return clock_; }
  // When a tetrahedron that shares a vertex with t last changed.
  std::uint32_t last_change(TetId t) const;
  // Replaces tetrahedra by others with the same outer faces. False, and nothing happens, if they
  // are of different regions, if one of their vertices has tetrahedra that no faces connect with
  // its others, or if there would be an edge or a face that is elsewhere already: then the mesh
  // would not be a complex any more, whatever the signs say.
  bool accept(const Change& change);

 private:
  const Approximation& approximation(std::uint32_t v) const {
    return input_.points->approximation(store_id_[v]);
  }
  void number_vertices();
  void certify(Control& control);
  void find_pinched();
  void set_sign(TetId t, int sign);
  bool clashes(const Change& change) const;
  bool has_element_elsewhere(std::span<const VertexId> vertices,
                             std::span<const TetId> removed) const;

  // Where a point of the store is meant to be, as doubles.
  Vec3 placed(VertexId v) const { return frame().written(nearest(v)); }
  Vec3 nearest(VertexId v) const {
    return input_.place.empty() ? input_.points->nearest(v) : input_.place[v];
  }

  const RoundingInput& input_;
  std::vector<VertexId> store_id_;
  std::vector<Vec3> position_;
  // Until repairs are prepared.
  std::vector<Tet> tet_;
  std::vector<RegionId> region_;
  std::optional<MeshTopology> topology_;
  std::vector<std::int8_t> sign_;
  std::set<TetId> bad_;

  std::map<std::uint32_t, std::vector<TetId>> pinched_;  // stars that no faces connect
  std::vector<std::uint32_t> by_position_;               // vertices sorted by home
  std::uint32_t clock_ = 0;
  std::uint64_t signs_ = 0;
  std::vector<std::uint32_t> changed_at_;   // per vertex: when its star last changed
  std::map<Vec3, std::uint32_t> moved_to_;  // how many moved vertices are there
};

}  // namespace delmesher::output
