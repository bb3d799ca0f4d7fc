#include "mesher/geometry/box_tree.h"

#include <numeric>

namespace delmesher::geometry {
namespace {

constexpr std::uint32_t kLeafSize = 4;

// Halved first: the sum of huge coordinates may overflow.
double center(const Box& box, std::size_t axis) {
  return box.lo[axis] * 0.5 + box.hi[axis] * 0.5;
}

std::size_t longest_axis(const Box& box) {
  std::size_t best = 0;
  const auto half_length = [&](std::size_t axis) {
    return box.hi[axis] * 0.5 - box.lo[axis] * 0.5;
  };
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (half_length(axis) > half_length(best)) best = axis;
  }
  return best;
}

}  // namespace

BoxTree::BoxTree(std::span<const Box> boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0U);
  if (boxes.empty()) return;
  nodes_.reserve(boxes.size());
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t i : items_) boxes_.push_back(boxes[i]);
}

void BoxTree::build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end) {
  const std::size_t index = nodes_.size();
  const std::span<std::uint32_t> items(items_.data() + begin, end - begin);
  Node node{{}, begin, end, 0};
  for (const std::uint32_t i : items) node.box.extend(boxes[i]);
  nodes_.push_back(node);
  if (items.size() <= kLeafSize) {
    // nth_element leaves an order that depends on the library.
    std::sort(items.begin(), items.end());
    return;
  }
  const std::size_t axis = longest_axis(node.box);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items.begin(), items.begin() + (middle - begin), items.end(),
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double a = center(boxes[i], axis), b = center(boxes[j], axis);
                     return a != b ? a < b : i < j;
                   });
  build(boxes, begin, middle);
  nodes_[index].right = static_cast<std::uint32_t>(nodes_.size());
  build(boxes, middle, end);
}

// Splits as pairs_within() and pairs_between() do.
void BoxTree::add_tasks(const PairTask& task, std::vector<PairTask>& tasks) const {
  constexpr std::uint32_t kSmall = 256;
  const auto [m, n] = task;
  const Node &a = nodes_[m], &b = nodes_[n];
  if (!a.box.overlaps(b.box)) return;
  if (std::max(a.size(), b.size()) <= kSmall) {
    tasks.push_back(task);
  } else if (m == n) {
    add_tasks({m + 1, m + 1}, tasks);
    add_tasks({a.right, a.right}, tasks);
    add_tasks({m + 1, a.right}, tasks);
  } else if (b.is_leaf() || (!a.is_leaf() && a.size() >= b.size())) {
    add_tasks({m + 1, n}, tasks);
    add_tasks({a.right, n}, tasks);
  } else {
    add_tasks({m, n + 1}, tasks);
    add_tasks({m, b.right}, tasks);
  }
}

std::vector<BoxTree::PairTask> BoxTree::pair_tasks() const {
  std::vector<PairTask> tasks;
  if (!nodes_.empty()) add_tasks({0, 0}, tasks);
  return tasks;
}

ShrinkingBoxTree::ShrinkingBoxTree(std::span<const Box> boxes)
    : tree_(boxes), position_(boxes.size()), removed_(boxes.size(), 0) {
  const auto count = static_cast<std::uint32_t>(boxes.size());
  for (std::uint32_t i = 0; i < count; ++i) position_[tree_.item(i)] = i;
  alive_.reserve(count);
  const std::uint32_t nodes = tree_.node_count();
  for (std::uint32_t n = 0; n < nodes; ++n) alive_.push_back(tree_.node(n).size());
}

void ShrinkingBoxTree::remove(std::uint32_t item) {
  const std::uint32_t position = position_[item];
  if (removed_[position] != 0) return;
  removed_[position] = 1;
  for (std::uint32_t n = 0;;) {
    --alive_[n];
    const BoxTree::Node& node = tree_.node(n);
    if (node.is_leaf()) return;
    n = position < tree_.node(n + 1).end ? n + 1 : node.right;
  }
}

}  // namespace delmesher::geometry
