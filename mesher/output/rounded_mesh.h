// The mesh on doubles: as rounded to nearest, and while it is repaired.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "mesher/output/rounding.h"
#include "mesher/tetmesh/placed_mesh.h"

namespace delmesher::output {

// How bad some tetrahedra are: first how many are not positive, then how many of these are
// inverted. Repairs decrease it, so they end; separating may keep it, untangling has a budget.
using Badness = std::int64_t;
inline constexpr Badness kOneBad = Badness{1} << 32;
inline Badness badness(int sign) {
  return sign > 0 ? 0 : kOneBad + (sign < 0 ? 1 : 0);
}

// Every vertex is at home: at the nearest doubles of its exact position, or RoundingInput::place.
struct NearestMesh : RoundingInput {
  NearestMesh(RoundingInput input, Control& control);

  // Bounds the distance of home[v] from the exact position in each coordinate.
  double home_error(VertexId v) const;
  bool on_surface(VertexId v) const { return mobility[v] != Mobility::free; }
  // The largest component of the places of the surface's vertices, in the given frame; where there
  // are no faces of the surface, of all that is held in place. The box around the surface is larger
  // and says nothing about the surface's scale.
  double largest_of_surface() const;
  // Per point, the same of the facet that it is on, or of the smallest one of several; of others
  // that of the surface.
  std::vector<double> largest_of_facets() const;
  // Groups of vertices with equal coordinates, in their order, where vertices are at `position`.
  // Those that have moved are in none.
  std::vector<std::vector<VertexId>> coincident(std::span<const Vec3> position) const;

  std::vector<Vec3> home;         // per point of the store that is a vertex
  std::vector<VertexId> by_home;  // the vertices, sorted
  std::vector<std::int8_t> sign;  // of tetrahedra
  std::size_t bad = 0;            // tetrahedra that are not positive

 private:
  // In the frame, before it is rounded to what can be written.
  Vec3 local_home(VertexId v) const { return place.empty() ? points->nearest(v) : place[v]; }
};

// Vertices have the numbers of their points.
class RoundedMesh final : public PlacedMesh {
 public:
  // Costs memory, so a mesh with nothing to repair does without.
  explicit RoundedMesh(const NearestMesh& nearest);

  const NearestMesh& nearest() const { return nearest_; }
  const Vec3& home(VertexId v) const { return nearest_.home[v]; }
  bool fixed(VertexId v) const { return mobility(v) == Mobility::fixed; }
  bool on_surface(VertexId v) const { return nearest_.on_surface(v); }
  bool moves_far(VertexId v) const { return !on_surface(v) && nearest_.place.empty(); }

  int sign(TetId t) const { return sign_[t]; }
  // Slots of the tetrahedra that are not positive.
  const std::set<TetId>& bad() const { return bad_; }
  // The tetrahedra around v, ascending.
  std::vector<TetId> star(VertexId v) const;
  // Is the star of v a ball with v inside?
  bool is_enclosed(VertexId v) const;
  // Is there a vertex at p?
  bool occupied(const Vec3& p) const;
  // The sign that t would have with its vertex v at p.
  int sign_at(TetId t, VertexId v, const Vec3& p) {
    ++signs_;
    return sign_with(mesh.tet(t), mesh.index_of(t, v), p);
  }
  // On exact points as well only if they are asked.
  void ask_exact_points(bool ask);
  bool is_positive(const Tet& t) {
    ++signs_;
    return PlacedMesh::is_positive(t);
  }
  // How many signs of doubles have been decided.
  std::uint64_t signs() const { return signs_; }
  void move(VertexId v, const Vec3& p);
  // To be told when a move is there to stay.
  void note_move(VertexId v);
  // When a tetrahedron that shares a vertex with t last changed. Where nothing changed since a
  // repair failed, it need not be tried again.
  std::uint32_t last_change(TetId t) const;
  // Nothing happens, either, if what is removed is of different regions, if one of its vertices has
  // tetrahedra that no faces connect with its others, or if there would be an edge or a face that
  // is elsewhere already: then the mesh would not be a complex any more, whatever the signs say.
  bool accept(const Change& change);

 private:
  void note(TetId t) override;
  void set_sign(TetId t, int sign);
  void find_pinched();
  bool clashes(const Change& change) const;
  bool has_element_elsewhere(std::span<const VertexId> vertices,
                             std::span<const TetId> removed) const;

  const NearestMesh& nearest_;
  Predicates predicates_;
  std::vector<std::int8_t> sign_;  // per slot
  std::set<TetId> bad_;
  // Stars that no faces connect. Only the refined mesh has such vertices (--approximate), where
  // what is inside touches itself.
  std::map<VertexId, std::vector<TetId>> pinched_;
  std::uint64_t signs_ = 0;
  std::map<Vec3, std::uint32_t> moved_to_;  // how many moved vertices are there
};

}  // namespace delmesher::output
