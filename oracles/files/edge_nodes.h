// Elements of second order: nodes on edges besides the corners.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "oracles/files/mesh_file.h"

namespace tetproof::oracles {

// The corners that the nodes of an element are between, in the order of NodesOnEdges.
inline constexpr std::array<std::array<std::size_t, 2>, 6> kNodeEnds = {
    {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};

// The nodes of a file's elements that are not corners: of a tetrahedron abcd on ab bc ac ad bd cd,
// of a triangle abc on ab bc ac.
struct NodesOnEdges {
  std::vector<std::array<Index, 6>> of_tetrahedra;
  std::vector<std::array<Index, 3>> of_triangles;
};

// Takes them out of the vertices of the mesh, which keep their order, and lists them with their
// edges. Throws ReadError (`path` is its beginning) if not all elements have them, if one of them
// is a corner or on two edges, or if an edge has two.
void take_out_edge_nodes(MeshFile& mesh, const NodesOnEdges& nodes, const std::string& path);

// Straight edges have their node in the middle, within 4 ulp of the edge's largest coordinate (or
// that as given, if it is larger) or what is declared (a length).
OracleReport check_edge_nodes(const MeshFile& mesh, double declared, double largest_given = 0);

// What is not shown of a file whose format has linear elements alone.
inline constexpr char kLinearOnly[] = "--order 2 (the format has linear elements only)";

}  // namespace tetproof::oracles
