// A tree of boxes, in doubles.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "oracles/base/box.h"

namespace tetproof::oracles {

class BoxTree {
 public:
  using Box = oracles::Box;
  explicit BoxTree(std::vector<Box> boxes);
  // All x with normal . x >= offset.
  struct HalfSpace {
    Position normal;
    double offset;
    // Is the box certainly inside? Decides nothing reliable where doubles overflow.
    bool contains(const Box& box) const;
  };
  // Appends to `found` the indices of the boxes that meet the query, in no particular order. Boxes
  // that are certainly in one of the half-spaces are left out. These are asked for once a box meets
  // the query: most queries of some callers find none.
  void query(const Box& query, std::vector<Index>& found,
             const std::function<std::array<HalfSpace, 4>()>& but_in = {}) const;

 private:
  struct Node {
    Box box;
    Index first, count;  // count 0: inner node with children at first and first + 1
  };
  void build(std::size_t node, Index first, Index last, int depth);

  std::vector<Box> boxes_;    // in the order of the leaves
  std::vector<Index> order_;  // their indices as given
  std::vector<Node> nodes_;
};

}  // namespace tetproof::oracles
