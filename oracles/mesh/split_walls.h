// Walls whose two sides can part: there the mesh has several vertices at one place.
//
// Tetrahedra around a place hang together across faces that are no chosen walls. Those that do have
// one vertex there; those that do not, and have a chosen face there, have different ones. So the
// sides of a chosen wall part wherever nothing else holds them, and nothing else parts.
#pragma once

#include <string>
#include <vector>

#include "oracles/files/mesh_file.h"
#include "oracles/files/polyhedron.h"
#include "oracles/mesh/parts.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// One vertex at each place. Of triangles listed for both sides of a wall the first stays, with the
// label of the input.
struct MergedMesh {
  MeshFile mesh;
  std::vector<Index> place;  // of each vertex of the file its number in `mesh`
};
MergedMesh merge_places(const Polyhedron& input, const MeshFile& mesh);

// Which walls are chosen the promise says. Chosen triangles whose sides differ are listed once for
// each, seen from outside of it, in sets of the names of the sides (if the file has names and those
// of the input are read); others once. `complex`: the merged mesh. `parts`: its parts.
OracleReport check_split_walls(const Polyhedron& input, const MeshFile& mesh,
                               const MergedMesh& merged, const TetComplex& complex,
                               const Neighbours& neighbours, const PartsResult& parts,
                               const Promise& promise);

}  // namespace tetproof::oracles
