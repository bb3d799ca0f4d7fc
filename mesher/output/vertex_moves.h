// Repairs by moving vertices to other doubles.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "mesher/output/rounded_mesh.h"

namespace delmesher::output {

// Surface vertices stay within kSurfaceUlps units in the last place of the largest coordinate of
// the surface from their exact position; fixed vertices stay; others move as far as needed, but the
// shortest moves are tried first. Where vertices have places other than their exact ones, which may
// be far away, the others stay near, too: such a mesh needs other places.
inline constexpr double kSurfaceUlps = 4;

class VertexMoves {
 public:
  explicit VertexMoves(RoundedMesh& mesh);

  // Moves one vertex of the bad tetrahedron t to where the badness around it is less.
  bool fix(std::uint32_t t);
  // Moves several vertices: one frees t, the others repair the tetrahedra that this move inverted.
  bool fix_by_chain(std::uint32_t t);
  // Moves v away from a vertex with the same coordinates, doing no harm.
  bool separate(std::uint32_t v);
  // Moves many vertices, on the way also to where more is bad, until nothing is bad: for places
  // where one move can only exchange one bad tetrahedron for another. False, in any state, when the
  // budget ends.
  bool untangle(Control& control);

 private:
  struct Chain;

  std::vector<std::uint32_t> movable(std::uint32_t t) const;
  bool allowed(std::uint32_t v, const Vec3& p) const;
  void near_candidates(std::uint32_t v, bool wide);
  void far_candidates(std::uint32_t v);
  void order_star(std::uint32_t v);
  Badness change(std::uint32_t v, const Vec3& p, Badness limit);
  bool improve(std::uint32_t t, bool far);
  bool free_by_chain(Chain& chain, std::uint32_t t, int depth);
  void undo(Chain& chain, std::size_t mark);
  std::int64_t weight(std::uint32_t t) const;
  bool lighten(std::uint32_t t);
  bool lighten_by(std::uint32_t v, std::int64_t& best, Vec3& best_position);

  RoundedMesh& mesh_;
  double surface_unit_ = 0;                  // unit in the last place of the largest coordinate
  std::vector<std::array<int, 3>> steps_;    // of a 5 x 5 x 5 grid, shortest first
  std::vector<Vec3> candidates_;             // of the vertex under consideration
  std::vector<std::uint32_t> ordered_star_;  // its star, bad ones first
  Badness star_badness_ = 0;
  std::int64_t chains_budget_;
  std::map<std::uint32_t, std::int64_t> weight_;  // where not 1
  std::int64_t untangle_budget_ = 0;
  std::uint64_t positions_ = 0;  // fingerprint of the positions of all vertices
};

}  // namespace delmesher::output
