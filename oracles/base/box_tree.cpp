#include "oracles/base/box_tree.h"

#include <algorithm>
#include <cmath>

#include "oracles/base/steps.h"

namespace tetproof::oracles {
namespace {

constexpr Index kLeafSize = 4;
constexpr int kMaxDepth = 60;

double centre(const BoxTree::Box& box, int axis) {
  return box.low[axis] / 2 + box.high[axis] / 2;
}

// The number of leaves for this many boxes, as they are divided.
std::size_t leaves(std::size_t boxes) {
  if (boxes <= kLeafSize) return 1;
  return leaves(boxes / 2) + leaves(boxes - boxes / 2);
}

// Puts at each place the box that its number names. Along the cycles of the permutation, for a copy
// of a large surface's boxes would be in memory together with most of what is verified.
void gather(const std::vector<Index>& order, std::vector<BoxTree::Box>& boxes) {
  std::vector<bool> done(order.size());
  for (std::size_t first = 0; first < order.size(); ++first) {
    if (done[first]) continue;
    const BoxTree::Box moved = boxes[first];
    std::size_t at = first;
    for (; order[at] != first; at = order[at]) {
      boxes[at] = boxes[order[at]];
      done[at] = true;
    }
    boxes[at] = moved;
    done[at] = true;
  }
}

}  // namespace

// The height is that of the box's lowest corner. A sum of three products, each of which rounds
// twice at most, is exact to within 2^-50 of the sum of their sizes.
bool BoxTree::HalfSpace::contains(const Box& box) const {
  double height = 0, size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double term =
        normal[axis] > 0 ? normal[axis] * box.low[axis] : normal[axis] * box.high[axis];
    height += term;
    size += std::fabs(term);
  }
  return height - size * 0x1p-50 > offset;
}

BoxTree::BoxTree(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
  order_.resize(boxes_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<Index>(i);
  nodes_.reserve(2 * leaves(boxes_.size()) - 1);
  nodes_.emplace_back();
  if (boxes_.empty()) return;
  build(0, 0, static_cast<Index>(order_.size()), 0);
  gather(order_, boxes_);  // the boxes of a leaf side by side
}

void BoxTree::build(std::size_t node, Index first, Index last, int depth) {
  Box box = boxes_[order_[first]];
  for (Index i = first; i < last; ++i) box.add(boxes_[order_[i]]);
  nodes_[node].box = box;
  if (last - first <= kLeafSize || depth == kMaxDepth) {
    nodes_[node].first = first;
    nodes_[node].count = last - first;
    return;
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
  }
  const Index middle = first + (last - first) / 2;
  std::nth_element(
      order_.begin() + first, order_.begin() + middle, order_.begin() + last,
      [&](Index a, Index b) { return centre(boxes_[a], axis) < centre(boxes_[b], axis); });
  const std::size_t child = nodes_.size();
  nodes_[node].first = static_cast<Index>(child);
  nodes_[node].count = 0;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(child, first, middle, depth + 1);
  build(child + 1, middle, last, depth + 1);
}

void BoxTree::query(const Box& query, std::vector<Index>& found,
                    const std::function<std::array<HalfSpace, 4>()>& but_in) const {
  if (boxes_.empty()) return;
  std::array<HalfSpace, 4> half_spaces;
  std::size_t known = 0;
  const auto wanted = [&](const Box& box) {
    return meet(box, query) &&
           std::none_of(half_spaces.begin(), half_spaces.begin() + known,
                        [&](const HalfSpace& half) { return half.contains(box); });
  };
  std::array<std::size_t, 2 * kMaxDepth + 4> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    steps += 1 + node.count;
    if (!wanted(node.box)) continue;
    if (node.count == 0) {
      stack[top++] = node.first;
      stack[top++] = node.first + 1;
      continue;
    }
    for (Index i = node.first; i < node.first + node.count; ++i) {
      if (but_in && known == 0 && meet(boxes_[i], query)) {
        half_spaces = but_in();
        known = half_spaces.size();
      }
      if (wanted(boxes_[i])) found.push_back(order_[i]);
    }
  }
}

}  // namespace tetproof::oracles
