// The mesh on rounded coordinates while it is being repaired: positions, exact signs, stars.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "mesher/output/rounding.h"

namespace delmesher::output {

// How bad some tetrahedra are: first how many are not positive, then how many of these are
// inverted. Repairs decrease it, so they end; separating may keep it, untangling has a budget.
using Badness = std::int64_t;
inline constexpr Badness kOneBad = Badness{1} << 32;
inline Badness badness(int sign) {
  return sign > 0 ? 0 : kOneBad + (sign < 0 ? 1 : 0);
}

// Vertices are local indices, ascending with their ids in the store. Tetrahedra live in slots; a
// slot freed by a local operation stays dead or is used again.
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

  std::size_t slots() const { return tet_.size(); }
  bool alive(std::uint32_t t) const { return tet_[t][0] != kNone; }
  const Tet& tet(std::uint32_t t) const { return tet_[t]; }
  RegionId region(std::uint32_t t) const { return region_[t]; }
  int sign(std::uint32_t t) const { return sign_[t]; }
  // Slots of the tetrahedra that are not positive.
  const std::set<std::uint32_t>& bad() const { return bad_; }
  // Groups of vertices with equal coordinates, in their order. Moved vertices are in none.
  std::vector<std::vector<std::uint32_t>> coincident() const;

  // Must be called before anything below. Costs memory, so a mesh with nothing to repair skips it.
  void prepare_repairs();
  // Ascending slots of the tetrahedra around a vertex; valid until the next replace().
  std::span<const std::uint32_t> star(std::uint32_t v) const;
  // Is v inside the union of its star? If not, it is on the hull of the tetrahedra given.
  bool is_enclosed(std::uint32_t v) const;
  bool is_boundary(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
  // The faces of the surface.
  std::span<const std::array<std::uint32_t, 3>> boundary() const { return boundary_; }
  // Is there a vertex at p?
  bool occupied(const Vec3& p) const;
  // The sign that t would have with its vertex v at p, and that of any four vertices.
  int sign_at(std::uint32_t t, std::uint32_t v, const Vec3& p);
  int sign_of(const Tet& vertices);
  // How many signs of these two kinds have been decided.
  std::uint64_t signs() const { return signs_; }
  void move(std::uint32_t v, const Vec3& p);
  // To be told when a move is there to stay.
  void note_change(std::uint32_t v);
  // Counts changes. Where nothing changed since a repair failed, it need not be tried again.
  std::uint32_t clock() const { return clock_; }
  // When a tetrahedron that shares a vertex with t last changed.
  std::uint32_t last_change(std::uint32_t t) const;
  // Replaces tetrahedra, all of one region, by others with the same outer faces.
  void replace(std::span<const std::uint32_t> removed, std::span<const Tet> created);

 private:
  const Approximation& approximation(std::uint32_t v) const {
    return input_.points->approximation(store_id_[v]);
  }
  void number_vertices();
  void certify(Control& control);
  void set_sign(std::uint32_t t, int sign);
  std::vector<std::uint32_t>& editable_star(std::uint32_t v);

  // Where a point of the store is meant to be, as doubles.
  Vec3 placed(VertexId v) const { return frame().written(nearest(v)); }
  Vec3 nearest(VertexId v) const {
    return input_.place.empty() ? input_.points->nearest(v) : input_.place[v];
  }

  const RoundingInput& input_;
  std::vector<VertexId> store_id_;
  std::vector<Vec3> position_;
  std::vector<Tet> tet_;
  std::vector<RegionId> region_;
  std::vector<std::int8_t> sign_;
  std::set<std::uint32_t> bad_;

  // Stars as they were built, and the stars that have changed since.
  std::vector<std::uint32_t> star_begin_, star_tets_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> changed_stars_;
  std::vector<std::array<std::uint32_t, 3>> boundary_;  // each sorted, sorted
  std::vector<std::uint32_t> by_position_;              // vertices sorted by home
  std::uint32_t clock_ = 0;
  std::uint64_t signs_ = 0;
  std::vector<std::uint32_t> changed_at_;   // per vertex: when its star last changed
  std::map<Vec3, std::uint32_t> moved_to_;  // how many moved vertices are there
};

}  // namespace delmesher::output
