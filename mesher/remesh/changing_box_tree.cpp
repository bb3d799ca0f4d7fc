#include "mesher/remesh/changing_box_tree.h"

#include <algorithm>
#include <tuple>

namespace delmesher::remesh {
namespace {

double half_area(const Box& box) {
  const double x = box.hi[0] - box.lo[0], y = box.hi[1] - box.lo[1], z = box.hi[2] - box.lo[2];
  return x * y + y * z + z * x;
}

Box joined(Box a, const Box& b) {
  a.extend(b);
  return a;
}

}  // namespace

ChangingBoxTree::ChangingBoxTree(std::span<const Box> boxes) {
  for (std::uint32_t item = 0; item < boxes.size(); ++item) {
    leaf_of_.push_back(new_node({.box = boxes[item], .item = item}));
  }
  size_ = boxes.size();
  rebuild();
}

std::uint32_t ChangingBoxTree::new_node(const Node& node) {
  if (free_.empty()) {
    nodes_.push_back(node);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }
  const std::uint32_t n = free_.back();
  free_.pop_back();
  nodes_[n] = node;
  return n;
}

std::uint32_t ChangingBoxTree::build(std::span<std::uint32_t> leaves) {
  if (leaves.size() == 1) return leaves[0];
  Box centres;
  const auto centre = [&](std::uint32_t leaf, std::size_t axis) {
    return nodes_[leaf].box.lo[axis] + nodes_[leaf].box.hi[axis];
  };
  for (const std::uint32_t leaf : leaves) {
    const Vec3 c{centre(leaf, 0), centre(leaf, 1), centre(leaf, 2)};
    centres.extend({c, c});
  }
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (centres.hi[i] - centres.lo[i] > centres.hi[axis] - centres.lo[axis]) axis = i;
  }
  const std::size_t half = leaves.size() / 2;
  std::nth_element(leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(half), leaves.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::tuple(centre(a, axis), nodes_[a].item) <
                            std::tuple(centre(b, axis), nodes_[b].item);
                   });
  const std::uint32_t left = build(leaves.first(half)), right = build(leaves.subspan(half));
  const std::uint32_t n =
      new_node({.box = joined(nodes_[left].box, nodes_[right].box), .left = left, .right = right});
  nodes_[left].parent = nodes_[right].parent = n;
  return n;
}

void ChangingBoxTree::rebuild() {
  std::vector<Node> leaves;
  for (const Node& node : nodes_) {
    if (node.item != kNone) leaves.push_back({.box = node.box, .item = node.item});
  }
  nodes_ = std::move(leaves);
  free_.clear();
  std::vector<std::uint32_t> order;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    leaf_of_[nodes_[n].item] = n;
    order.push_back(n);
  }
  root_ = order.empty() ? kNone : build(order);
  added_ = 0;
}

void ChangingBoxTree::fit_from(std::uint32_t node) {
  for (; node != kNone; node = nodes_[node].parent) {
    nodes_[node].box = joined(nodes_[nodes_[node].left].box, nodes_[nodes_[node].right].box);
  }
}

void ChangingBoxTree::add(std::uint32_t item, const Box& box) {
  if (item >= leaf_of_.size()) leaf_of_.resize(item + 1, kNone);
  const std::uint32_t leaf = new_node({.box = box, .item = item});
  leaf_of_[item] = leaf;
  ++size_;
  if (root_ == kNone) {
    root_ = leaf;
    return;
  }
  // Down to where boxes grow least.
  std::uint32_t beside = root_;
  while (nodes_[beside].left != kNone) {
    const auto cost = [&](std::uint32_t n) {
      return half_area(joined(nodes_[n].box, box)) - half_area(nodes_[n].box);
    };
    const Node& node = nodes_[beside];
    beside = cost(node.left) <= cost(node.right) ? node.left : node.right;
  }
  const std::uint32_t above = nodes_[beside].parent;
  const std::uint32_t n = new_node(
      {.box = joined(nodes_[beside].box, box), .parent = above, .left = beside, .right = leaf});
  nodes_[beside].parent = nodes_[leaf].parent = n;
  if (above == kNone) {
    root_ = n;
  } else {
    (nodes_[above].left == beside ? nodes_[above].left : nodes_[above].right) = n;
    fit_from(above);
  }
  if (++added_ > 2 * size_ + 64) rebuild();
}

void ChangingBoxTree::remove(std::uint32_t item) {
  const std::uint32_t leaf = leaf_of_[item], above = nodes_[leaf].parent;
  leaf_of_[item] = kNone;
  --size_;
  nodes_[leaf] = {};
  free_.push_back(leaf);
  if (above == kNone) {
    root_ = kNone;
    return;
  }
  const std::uint32_t other = nodes_[above].left == leaf ? nodes_[above].right : nodes_[above].left;
  const std::uint32_t top = nodes_[above].parent;
  nodes_[other].parent = top;
  nodes_[above] = {};
  free_.push_back(above);
  if (top == kNone) {
    root_ = other;
  } else {
    (nodes_[top].left == above ? nodes_[top].left : nodes_[top].right) = other;
    fit_from(top);
  }
}

}  // namespace delmesher::remesh
