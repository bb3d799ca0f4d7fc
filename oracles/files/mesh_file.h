// Reads the files that meshers write: MEDIT .mesh, Gmsh .msh (4.1, and 2.2 as text), .vtu (text or
// base 64, not compressed), TetGen's .node/.ele/.face, and .tet.
#pragma once

#include <string>

#include "oracles/base/simplex.h"
#include "oracles/files/set_names.h"

namespace tetproof::oracles {

struct MeshFile {
  // A node between two vertices, of elements of second order; it is not a vertex.
  struct EdgeNode {
    std::array<Index, 2> ends;
    Position at;
  };

  std::vector<Position> vertices;
  std::vector<Tet> tetrahedra;
  bool names_sides = false;  // the format has regions, which delmesher always writes
  // Per tetrahedron; empty if the file says nothing. Of a file that has sides and no numbers: 1
  // inside, 2 outside.
  std::vector<std::int64_t> regions;
  // Per tetrahedron, where the format has words for it (and not just a number for each region);
  // empty if the file does not use them.
  std::vector<std::uint8_t> inside;
  // It has regions, too, and its word is that all is inside: delmesher says so of a mesh that it
  // has read, whose sides it does not know. Of a mesh that it has made it is a statement.
  bool all_called_inside = false;
  std::vector<Face> boundary;        // triangles listed in the file
  std::vector<std::int32_t> labels;  // per triangle; empty if the file says nothing
  std::vector<Index> facets;         // per triangle, the facet that it tiles; or empty
  // The surface deviates by no more between the vertices and edges of the input's facets, as a
  // fraction of the diagonal, as the file says ("PlanarWithin"); 0: it says nothing.
  double planar_within = 0;
  bool has_names = false;  // the format has names of labels and regions
  SetNames names = {};
  // A label that could be the number of its group is the name of a group of another number, so that
  // readers differ in what it is. Delmesher writes no such file.
  bool labels_contradict = false;
  // An entity of Gmsh's is not as large as it says. Delmesher writes no such file.
  bool boxes_differ = false;
  // Elements are in no group of Gmsh's, or in several. Delmesher writes no such file.
  bool groups_differ = false;
  // Groups of triangles and of tetrahedra have one tag. Delmesher writes no such file.
  bool tags_shared = false;
  // The names of groups say another side, or another region, than their numbers. Of a mesh that it
  // has made delmesher writes no such file.
  bool sides_contradict = false;
  // It says that its coordinates are of single precision, as some readers make them then, and they
  // are not. Delmesher writes no such file.
  bool more_than_single = false;
  // Comments among the entries of a section, which some readers take for entries. Delmesher writes
  // no such file.
  bool comments_within = false;
  std::vector<EdgeNode> edge_nodes;  // one of each edge; empty if the elements are linear
  bool lists_boundary = true;        // false for a format that has no triangles
  bool has_second_order = true;      // false for a format that has only linear elements
  // The format has no common convention: tetrahedra that are all turned the same way are right.
  bool either_orientation = false;
};

// Elements of second order are read in all but .tet (TetGen makes them with -o2). Throws ReadError.
// The complex oracle checks indices; but a reference to no vertex at all is an error of the file.
MeshFile read_mesh(const std::string& path);

}  // namespace tetproof::oracles
