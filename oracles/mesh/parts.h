// Does a mesh have the parts of space that a complex of triangles bounds, each as a region of its
// own, with the triangles as faces? By the doubles of the file and the signs of exact numbers.
//
// Parts are tetrahedra that are connected across faces that are not triangles of the input. If
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
// No other one is missing (or, of the largest part or of parts by name, none that was asked for):
// sides of triangles without a tetrahedron, connected around edges where nothing but an empty wedge
// is between two of them, are closed surfaces; one that is the outer surface of what is on its side
// has a positive volume, as seen from there. What is missing is called like the smallest solid of a
// label around it (solids.h), and so is what is there.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "oracles/files/mesh_file.h"
#include "oracles/files/polyhedron.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/verdict/promise.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

struct PartsResult {
  OracleReport parts{"parts", "triangles"};  // the above
  // Each part has one number of a region in the file, and no two have the same; a region that has
  // the name of a label is surrounded by the triangles of that label.
  OracleReport regions{"regions", "parts"};
  // The triangles that the file lists are those of the input that are faces, each once, with one of
  // the labels given. Those that are turned, or have the label of the other side, are counted: not
  // every format of surfaces or meshes has sides.
  OracleReport list{"boundary-list", "triangles"};
  // Triangles that are split; and how far a vertex is from that of them on which it belongs.
  std::uint64_t split = 0;
  double deviation = 0;
  // The faces of these, sorted: which look to where the triangle of the input does.
  struct Piece {
    Face corners;
    Index given;
  };
  std::map<Face, Piece> pieces;
  // Per tetrahedron its part; if walls are to be split, what each part is called, if anything.
  std::vector<Index> part;
  std::map<Index, std::string> called;
  // Per tetrahedron the longest edge promised, 0: any; and whether no triangle has a longer one.
  std::vector<double> longest;
  bool triangles_fit = true;
};

// `points` of the complex: the vertices of the input, then those of the file from
// complex.first_vertex on. Triangles that are repeated in the input count once. Those that are not
// faces of the mesh are violations, but for those that bound no part. `near` (input units; 0: this
// is not asked): several faces stand for one with vertices so near to it (split_triangles.h). Of
// a report all whose violations lie where this is ambiguous, that is not decided.
PartsResult check_parts(const Polyhedron& input, const MeshFile& mesh, const TetComplex& complex,
                        const Neighbours& neighbours, const Promise& promise, double near);

}  // namespace tetproof::oracles
