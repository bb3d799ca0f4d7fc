#include "mesher/io/edge_nodes.h"

#include <algorithm>
#include <numeric>

namespace delmesher::io {

EdgeNodes::EdgeNodes(const TetMesh& mesh) : mesh_(mesh) {
  edges_.reserve(6 * mesh.tetrahedra.size() + 3 * mesh.boundary.size());
  const auto add = [&](const auto& cell) {
    for (std::size_t i = 0; i < cell.size(); ++i) {
      for (std::size_t j = i + 1; j < cell.size(); ++j) {
        edges_.push_back({std::min(cell[i], cell[j]), std::max(cell[i], cell[j])});
      }
    }
  };
  for (const auto& tetrahedron : mesh.tetrahedra) add(tetrahedron);
  for (const auto& triangle : mesh.boundary) add(triangle);
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
}

std::array<double, 3> EdgeNodes::position(std::size_t node) const {
  const auto& [a, b] = edges_[node];
  std::array<double, 3> middle;
  for (std::size_t k = 0; k < 3; ++k) {
    middle[k] = std::midpoint(mesh_.vertices[a][k], mesh_.vertices[b][k]);
  }
  return middle;
}

std::uint32_t EdgeNodes::number(std::uint32_t a, std::uint32_t b) const {
  const auto found =
      std::lower_bound(edges_.begin(), edges_.end(), Edge{std::min(a, b), std::max(a, b)});
  return static_cast<std::uint32_t>(mesh_.vertices.size() +
                                    static_cast<std::size_t>(found - edges_.begin()));
}

}  // namespace delmesher::io
