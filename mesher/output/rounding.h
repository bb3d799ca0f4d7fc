// Rounding exact vertices to the doubles that are written, certified by the exact sign of every
// tetrahedron. A mesh has two certificates: it conforms exactly on exact coordinates, and the file
// as written is valid.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/ladder.h"
#include "mesher/delmesher/tet_mesh.h"
#include "mesher/geometry/local_frame.h"
#include "mesher/predicates/points.h"
#include "mesher/tetmesh/conforming_mesh.h"
#include "mesher/tetmesh/mobility.h"

namespace delmesher::output {

// The input of rounding. Repairs may move non-explicit vertices to nearby doubles, move volume
// vertices, and change the tetrahedra by local operations that keep the boundary faces.
struct RoundingInput {
  // All of it is written. Repeated faces have their bits 0 to 3.
  ConformingMesh mesh;
  const PointStore* points;
  LocalFrame frame;  // coordinates are doubles in the given frame, too
  // Where vertices go that are not simply rounded; by point of the store, empty if there are none.
  std::vector<std::array<double, 3>> place;
  // Per point of the store: vertices of the input and of the outer box keep their exact position;
  // others that are not free are on the surface or on the box, and move by a few ulps only.
  std::vector<Mobility> mobility;
};

struct RoundingResult {
  // As written. The boundary is in the order of RoundingInput::mesh; its facets are those there,
  // and labels are not known yet.
  TetMesh mesh;
  std::vector<VertexId> vertices;            // of the mesh, in the store
  std::vector<std::uint8_t> repeated_faces;  // bits 0 to 3; empty: nobody has found out
  std::uint64_t inverted = 0, flat = 0;      // left in the result, by exact sign
  std::uint64_t repaired = 0;    // how many fewer are not positive than after plain rounding
  std::uint64_t coincident = 0;  // vertices left with the coordinates of an earlier one
  std::uint64_t signs = 0;       // of tetrahedra in doubles that were decided, in all attempts
  RungCounts ladder;             // in all attempts
  bool tried = true;             // false: there was too much to repair (RepairLimits::most)
  // Points of the store at the tetrahedra that plain rounding left not positive; may be repeated.
  std::vector<VertexId> disturbed;
  // Local operations done: if not 0, the tetrahedra are not those given. They are positive on the
  // exact coordinates as well, except where `inexact_operations` had no other choice.
  std::uint64_t operations = 0, inexact_operations = 0;
  // Largest distance of a written surface vertex from its exact position (an upper bound, rounded
  // up).
  double max_surface_deviation = 0;
};

// Defects of the written mesh, and defects on exact coordinates alone. Compared in this order.
inline std::pair<std::uint64_t, std::uint64_t> defects(const RoundingResult& result) {
  return {result.inverted + result.flat + result.coincident, result.inexact_operations};
}
inline constexpr std::pair<std::uint64_t, std::uint64_t> kNoDefects;

struct RepairLimits {
  // Where the first repairs leave at most so many defects, others are tried, which may take a
  // hundred times as long. 0: nowhere.
  std::size_t thorough = 1000;
  // Nothing is repaired where more tetrahedra than this are not positive.
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

RoundingResult round_mesh(RoundingInput input, Control& control, const RepairLimits& limits = {});

}  // namespace delmesher::output
