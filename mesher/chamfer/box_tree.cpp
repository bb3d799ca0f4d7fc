#include "mesher/chamfer/box_tree.h"

#include <numeric>
#include <utility>

#include "mesher/base/ids.h"

namespace delmesher::chamfer {

BoxTree::BoxTree(std::vector<ItemBox> boxes) : boxes_(std::move(boxes)) {
  if (boxes_.empty()) return;
  items_.resize(boxes_.size());
  std::iota(items_.begin(), items_.end(), 0U);
  leaf_of_.resize(boxes_.size());
  removed_.assign(boxes_.size(), 0);
  const auto count = static_cast<std::uint32_t>(boxes_.size());
  nodes_.reserve(count);
  nodes_.push_back({{}, 0, count, 0, kNone, count});
  // Children are appended, so this loop visits every node.
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) split(node);
}

void BoxTree::split(std::uint32_t index) {
  Node& node = nodes_[index];
  for (std::uint32_t i = node.begin; i < node.end; ++i) {
    node.box.extend(boxes_[items_[i]].low, boxes_[items_[i]].high);
  }
  if (node.end - node.begin <= kLeafSize) {
    // nth_element leaves an order that depends on the library.
    std::sort(items_.begin() + node.begin, items_.begin() + node.end);
    for (std::uint32_t i = node.begin; i < node.end; ++i) leaf_of_[items_[i]] = index;
    return;
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (node.box.high[i] - node.box.low[i] > node.box.high[axis] - node.box.low[axis]) axis = i;
  }
  const auto before = [this, axis](std::uint32_t a, std::uint32_t b) {
    const double x = boxes_[a].low[axis] + boxes_[a].high[axis];
    const double y = boxes_[b].low[axis] + boxes_[b].high[axis];
    return x != y ? x < y : a < b;
  };
  const std::uint32_t begin = node.begin, end = node.end, middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, before);
  node.left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, begin, middle, 0, index, middle - begin});
  nodes_.push_back({{}, middle, end, 0, index, end - middle});
}

void BoxTree::remove(std::uint32_t item) {
  if (removed_[item]) return;
  removed_[item] = 1;
  for (std::uint32_t node = leaf_of_[item]; node != kNone; node = nodes_[node].parent) {
    --nodes_[node].alive;
  }
}

}  // namespace delmesher::chamfer
