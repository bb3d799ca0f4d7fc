// Does a mesh have the parts of space that a complex of triangles bounds, each as a region of its
// own, with the triangles as faces? By the doubles of the file and the signs of exact numbers.
//
// Parts are tetrahedra that are connected across faces that are no triangles of the input. If
//  - the tetrahedra are positive, and the faces that two of them share have them on different sides
//    (other oracles),
//  - every face of one tetrahedron alone, an outer face, is a triangle of the input, and the
//  winding
//    number of all outer faces is 0 just outside each of them and 1 just inside,
// then the tetrahedra do not overlap: the number of them at a point is that winding number, and
// each part of space that the outer faces leave touches one of these. If moreover every triangle of
// the input is a face, or has winding number 0, then no triangle enters a part, whose boundary
// consists of triangles: it is a part of space that the input bounds, and all of it.
//
// No other one is missing: sides of triangles without a tetrahedron, connected around edges where
// nothing but an empty wedge is between two of them, are closed surfaces; one that is the outer
// surface of what is on its side has a positive volume, as seen from there.
#pragma once

#include <cstdint>
#include <vector>

#include "oracles/files/mesh_file.h"
#include "oracles/files/polyhedron.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

struct PartsResult {
  OracleReport parts{"parts", "triangles"};  // the above
  // Each part has one number of a region in the file, and no two have the same; a region that has
  // the name of a label is surrounded by the triangles of that label.
  OracleReport regions{"regions", "parts"};
  // The triangles that the file lists are those of the input that are faces, each once, with one of
  // the labels given.
  OracleReport list{"boundary-list", "triangles"};
};

// `points` of the complex: the vertices of the input, then those of the file from
// complex.first_vertex on. Triangles that are repeated in the input count once. Those that are not
// faces of the mesh are violations, but for those that bound no part. `near`: if all of them have
// a vertex of the mesh within this distance (input units) that is no corner, they may be split, and
// whether faces tile them is not decided; 0: that is not asked. Returns how many there are.
std::uint64_t check_parts(const Polyhedron& input, const MeshFile& mesh, const TetComplex& complex,
                          const Neighbours& neighbours, double near, PartsResult& result);

}  // namespace tetproof::oracles
