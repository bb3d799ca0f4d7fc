// Finds the vertices of a mesh that are in a ball and were there before another vertex.
#pragma once

#include <functional>
#include <vector>

#include "oracles/base/box.h"
#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

// Vertices in the order of their numbers, in a tree of boxes that knows the first one of each.
class EarlierVertices {
 public:
  // `vertices` ascending. The points must outlive this.
  EarlierVertices(const ExactPoints& points, std::vector<Index> vertices);

  // Visits vertices below `before`: all of those strictly inside the circumsphere of a tetrahedron
  // that is not flat, and some more, until it has seen `enough`.
  void near_ball(const std::array<Index, 4>& tetrahedron, Index before,
                 const std::function<bool(Index)>& enough) const;

 private:
  struct Node {
    Box box;
    Index first_vertex;  // the lowest number in the box
    Index begin, end;    // in vertices_; an inner node's children are at 2 n + 1 and 2 n + 2
    bool leaf;
  };
  void build(std::size_t node, Index begin, Index end);
  Box box_of_ball(const std::array<Index, 4>& tetrahedron) const;

  const ExactPoints& points_;
  std::vector<Index> vertices_;  // in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace tetproof::oracles
