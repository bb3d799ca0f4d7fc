// The sets of a mesh that formats have names for: the tetrahedra of a region, the boundary
// triangles of a label.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mesher/delmesher_files.h"
#include "mesher/io/edge_nodes.h"

namespace delmesher::io {

// The nodes of a cell as VTK, Abaqus and Nastran order them: the corners, then in elements of
// second order the nodes of the edges 01 12 02, of a tetrahedron also 03 13 23.
struct CellNodes {
  std::array<std::uint32_t, 10> node{};
  std::size_t count = 0;

  void add(std::uint32_t v) { node[count++] = v; }
  const std::uint32_t* begin() const { return node.data(); }
  const std::uint32_t* end() const { return node.data() + count; }
};

// A mesh, with the names of its labels.
struct NamedMesh {
  const TetMesh& mesh;
  const LabelNames& names;
  const EdgeNodes* edge_nodes = nullptr;  // of elements of second order
  bool ascii = true;                      // else bytes, in formats that have both
  LabelNames region_names = {};
  MshVersion msh = MshVersion::v4_1;

  bool second_order() const { return edge_nodes != nullptr; }
  // All nodes: the vertices, then those of the edges.
  std::size_t nodes() const {
    return mesh.vertices.size() + (second_order() ? edge_nodes->size() : 0);
  }
  std::array<double, 3> node(std::size_t i) const {
    const std::size_t vertices = mesh.vertices.size();
    return i < vertices ? mesh.vertices[i] : edge_nodes->position(i - vertices);
  }
  std::size_t nodes_of_tetrahedron() const { return second_order() ? 10 : 4; }
  std::size_t nodes_of_triangle() const { return second_order() ? 6 : 3; }
  CellNodes tetrahedron(std::size_t i) const;
  CellNodes triangle(std::size_t i) const;
};

// Region number of a tetrahedron in the formats that have one.
inline constexpr int kRegionInside = 1, kRegionOutside = 2;
std::int32_t region(const TetMesh& mesh, std::size_t tet);

using Members = std::map<std::int32_t, std::vector<std::size_t>>;  // by number, never empty ones
Members tetrahedra_of_regions(const TetMesh& mesh);
Members triangles_of_labels(const TetMesh& mesh);

// "inside" and "outside", or of a mesh from elsewhere the name given, or "region R".
std::string region_name(const NamedMesh& named, std::int32_t region);
// The name given, in one line, or "label L".
std::string label_name(const LabelNames& names, std::int32_t label);

// The labels (dimension 2) and regions (3) of the mesh that were given names.
struct GivenName {
  std::int32_t number;
  int dimension;
  std::string name;
};
std::vector<GivenName> given_names(const NamedMesh& named);

// The same names in UTF-8 (a program may have given other bytes), and of equal ones all but the
// first end in a number: programs find sets by them.
LabelNames distinct_names(LabelNames names);

// Names for formats that take letters, digits and '_' alone: other characters become '_', the first
// is a letter, and of names that are equal except for case all but one end in a number.
class Identifiers {
 public:
  std::string make(const std::string& name);

 private:
  std::map<std::string, int> used_;  // in lower case
};

// The tetrahedra at both sides of a boundary triangle, and which of their faces it is.
struct TriangleSides {
  struct Side {
    std::size_t tetrahedron;
    int apex;  // the corner of the tetrahedron that is not of the triangle
  };
  static constexpr int kNone = -1;
  // First the one from which the triangle is seen clockwise: behind it, in the solid.
  std::array<Side, 2> sides = {Side{0, kNone}, Side{0, kNone}};
};
std::vector<TriangleSides> sides_of_boundary(const TetMesh& mesh);

}  // namespace delmesher::io
