#include "mesher/surface/bvh.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "mesher/surface/topology.h"

namespace delmesher::surface {
namespace {

constexpr std::uint32_t kLeafSize = 4;

// Halved first: the sum of huge coordinates may overflow.
double center(const Box& box, std::size_t axis) {
  return box.lo[axis] * 0.5 + box.hi[axis] * 0.5;
}

std::size_t longest_axis_of_centers(std::span<const Box> boxes,
                                    std::span<const std::uint32_t> items) {
  Box extent = Box::empty();
  for (const std::uint32_t i : items) {
    const Vec3 c{center(boxes[i], 0), center(boxes[i], 1), center(boxes[i], 2)};
    extent.extend({c, c});
  }
  std::size_t best = 0;
  const auto half_length = [&](std::size_t axis) {
    return extent.hi[axis] * 0.5 - extent.lo[axis] * 0.5;
  };
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (half_length(axis) > half_length(best)) best = axis;
  }
  return best;
}

}  // namespace

Box Box::empty() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

Box Box::around(std::span<const Vec3> points) {
  Box box = empty();
  for (const Vec3& p : points) box.extend({p, p});
  return box;
}

std::vector<Box> triangle_boxes(const SurfaceTopology& topology, const PointStore& points) {
  std::vector<Box> boxes;
  boxes.reserve(topology.triangles.size());
  for (const auto& [a, b, c] : topology.triangles) {
    boxes.push_back(
        Box::around(std::array{points.nearest(a), points.nearest(b), points.nearest(c)}));
  }
  return boxes;
}

void Box::extend(const Box& other) {
  for (std::size_t i = 0; i < 3; ++i) {
    lo[i] = std::min(lo[i], other.lo[i]);
    hi[i] = std::max(hi[i], other.hi[i]);
  }
}

// Splits as pairs_within() and pairs_between() do.
void Bvh::add_tasks(const PairTask& task, std::vector<PairTask>& tasks) const {
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

std::vector<Bvh::PairTask> Bvh::pair_tasks() const {
  std::vector<PairTask> tasks;
  if (!nodes_.empty()) add_tasks({0, 0}, tasks);
  return tasks;
}

Bvh::Bvh(std::span<const Box> boxes) : items_(boxes.size()) {
  std::iota(items_.begin(), items_.end(), 0U);
  if (boxes.empty()) return;
  nodes_.reserve(boxes.size());
  build(boxes, 0, static_cast<std::uint32_t>(boxes.size()));
  boxes_.reserve(boxes.size());
  for (const std::uint32_t i : items_) boxes_.push_back(boxes[i]);
}

std::uint32_t Bvh::build(std::span<const Box> boxes, std::uint32_t begin, std::uint32_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Box::empty(), begin, end, 0});
  const std::span<std::uint32_t> items(items_.data() + begin, end - begin);
  if (items.size() <= kLeafSize) {
    std::sort(items.begin(), items.end());
    for (const std::uint32_t i : items) nodes_[index].box.extend(boxes[i]);
    return index;
  }
  const std::size_t axis = longest_axis_of_centers(boxes, items);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(items.begin(), items.begin() + (middle - begin), items.end(),
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double a = center(boxes[i], axis), b = center(boxes[j], axis);
                     return a != b ? a < b : i < j;
                   });
  build(boxes, begin, middle);
  const std::uint32_t right = build(boxes, middle, end);
  nodes_[index].right = right;
  nodes_[index].box = nodes_[index + 1].box;
  nodes_[index].box.extend(nodes_[right].box);
  return index;
}

}  // namespace delmesher::surface
