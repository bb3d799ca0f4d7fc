// Repairs by moving vertices to other doubles.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <vector>

#include "mesher/output/rounded_mesh.h"
#include "mesher/tetmesh/move_vertex.h"

namespace delmesher::output {

// Surface vertices stay within kSurfaceUlps units in the last place of the largest coordinate of
// their facet (of the smallest, if they are on several) from their exact position; fixed vertices
// stay; others move as far as needed, but the shortest moves are tried first. Where vertices have
// places other than their exact ones, which may be far away, the others stay near, too: such a mesh
// needs other places.
inline constexpr double kSurfaceUlps = 4;

class VertexMoves {
 public:
  explicit VertexMoves(RoundedMesh& mesh);

  // Moves one vertex of the bad tetrahedron t to where the badness around it is less.
  bool fix(TetId t);
  // Moves several vertices: one frees t, the others repair the tetrahedra that this move inverted.
  bool fix_by_chain(TetId t);
  // Moves v away from a vertex with the same coordinates, doing no harm.
  bool separate(VertexId v);
  // Moves many vertices, on the way also to where more is bad, until nothing is bad: for places
  // where one move can only exchange one bad tetrahedron for another. False, in any state, when the
  // budget ends.
  bool untangle(Control& control);

 private:
  struct Chain;
  struct Judge;
  // Candidates: doubles beside the vertex, at wider distances, and up to the middle of its star.
  enum class Stage : std::uint8_t { near, wide, far };
  static constexpr std::array kStages = {Stage::near, Stage::wide, Stage::far};
  struct Move {
    std::int64_t value = 0;  // what it changes; less is better
    VertexId vertex = kNone;
    Vec3 position{};
  };

  std::vector<VertexId> movable(TetId t) const;
  bool allowed(VertexId v, const Vec3& p) const;
  void near_candidates(VertexId v, bool wide);
  void far_candidates(VertexId v);
  void find_candidates(VertexId v, Stage stage);
  bool find(Stage stage, const Judge& judge, Move& best);
  bool carry_out(const Move& move);
  bool improve(TetId t, std::initializer_list<Stage> stages);
  bool free_by_chain(Chain& chain, TetId t, int depth);
  void undo(Chain& chain, std::size_t mark);
  std::int64_t weight(TetId t) const;
  bool lighten(TetId t);

  RoundedMesh& mesh_;
  std::vector<double> surface_unit_;       // per vertex: what kSurfaceUlps counts
  std::vector<std::array<int, 3>> steps_;  // of a 5 x 5 x 5 grid, shortest first
  std::vector<Vec3> candidates_;           // of the vertex under consideration
  std::int64_t chains_budget_;
  std::map<std::uint32_t, std::int64_t> weight_;  // where not 1
  std::uint64_t positions_ = 0;                   // fingerprint of the positions of all vertices
};

}  // namespace delmesher::output
