// Elements of second order with straight edges: a node in the middle of every edge, numbered after
// the vertices.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/delmesher_files.h"

namespace delmesher::io {

class EdgeNodes {
 public:
  // The edges of the tetrahedra and of the boundary, in the order of their smaller, then of their
  // larger vertex. Vertices of cells are in range.
  explicit EdgeNodes(const TetMesh& mesh);

  std::size_t size() const { return edges_.size(); }
  // The middle of the end points, each coordinate the nearest double.
  std::array<double, 3> position(std::size_t node) const;
  // The number in the file, from 0, of the node of an edge that is there.
  std::uint32_t number(std::uint32_t a, std::uint32_t b) const;

 private:
  using Edge = std::array<std::uint32_t, 2>;
  const TetMesh& mesh_;
  std::vector<Edge> edges_;
};

}  // namespace delmesher::io
