// Half-edges of a triangle soup grouped by undirected edge, on flat arrays.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace delmesher::surface {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Half-edge h = 3 t + k goes from triangles[t][k] to triangles[t][(k + 1) % 3]. Groups are ordered
// by their smallest half-edge, and so are the half-edges of a group. Works on any soup with valid
// indices; half-edges from a vertex to itself are in no group.
class HalfEdgeGroups {
 public:
  HalfEdgeGroups(const Triangles& triangles, std::size_t vertex_count);

  std::size_t size() const { return begin_.size() - 1; }
  std::span<const std::uint32_t> operator[](std::size_t edge) const {
    return {half_edges_.data() + begin_[edge], begin_[edge + 1] - begin_[edge]};
  }

 private:
  std::vector<std::uint32_t> half_edges_;
  std::vector<std::size_t> begin_;
};

}  // namespace delmesher::surface
