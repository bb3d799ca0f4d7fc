// A tree of boxes to which items are added and from which they are removed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/geometry/box_tree.h"

namespace delmesher::remesh {

// Items are numbers, each at most once in the tree. Deterministic: the answer of a query is in an
// order that depends on the calls before it alone.
class ChangingBoxTree {
 public:
  ChangingBoxTree() = default;
  // Item i has the box boxes[i].
  explicit ChangingBoxTree(std::span<const Box> boxes);

  void add(std::uint32_t item, const Box& box);
  void remove(std::uint32_t item);

  // visit(item) for each item whose box meets `box`; ends if that returns false, and returns false
  // as well.
  template <class Visit>
  bool query(const Box& box, Visit&& visit) const {
    if (root_ == kNone) return true;
    stack_.assign(1, root_);
    while (!stack_.empty()) {
      const Node& node = nodes_[stack_.back()];
      stack_.pop_back();
      if (!node.box.overlaps(box)) continue;
      if (node.left != kNone) {
        stack_.push_back(node.right);
        stack_.push_back(node.left);
      } else if (!visit(node.item)) {
        return false;
      }
    }
    return true;
  }

 private:
  struct Node {
    Box box;
    std::uint32_t parent = kNone, left = kNone, right = kNone;
    std::uint32_t item = kNone;  // of a leaf
  };

  std::uint32_t new_node(const Node& node);
  std::uint32_t build(std::span<std::uint32_t> leaves);
  void rebuild();
  void fit_from(std::uint32_t node);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> free_;
  std::vector<std::uint32_t> leaf_of_;  // by item
  std::uint32_t root_ = kNone;
  std::size_t size_ = 0, added_ = 0;  // added since it was last built
  mutable std::vector<std::uint32_t> stack_;
};

}  // namespace delmesher::remesh
