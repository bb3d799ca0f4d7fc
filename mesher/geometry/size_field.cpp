#include "mesher/geometry/size_field.h"

#include <algorithm>
#include <cmath>

#include "mesher/geometry/vector.h"

namespace delmesher::geometry {
namespace {

constexpr std::uint32_t kLeaf = 8;  // sources
// Lowers the bound over many sources: rounding must not raise it above that of one of them.
constexpr double kSlack = 1 - 1e-9;

double distance_to_edge(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = subtract(b, a), from = subtract(p, a);
  const double length2 = squared_norm(along);
  const double t = length2 > 0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0;
  return norm(add_scaled(from, -t, along));
}

}  // namespace

SizeField::SizeField(std::span<const SizeSource> sources, double growth)
    : sources_(sources.begin(), sources.end()), growth_(growth) {
  if (!sources_.empty()) build(0, static_cast<std::uint32_t>(sources_.size()));
}

std::uint32_t SizeField::build(std::uint32_t first, std::uint32_t end) {
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.first = first;
  node.end = end;
  for (std::uint32_t n = first; n < end; ++n) {
    node.box.extend({sources_[n].point, sources_[n].point});
    node.size = std::min(node.size, sources_[n].size);
  }
  nodes_.push_back(node);
  if (end - first <= kLeaf) return number;
  const Vec3 extent = subtract(node.box.hi, node.box.lo);
  const auto axis =
      static_cast<std::size_t>(std::max_element(extent.begin(), extent.end()) - extent.begin());
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(
      sources_.begin() + first, sources_.begin() + middle, sources_.begin() + end,
      [axis](const SizeSource& x, const SizeSource& y) { return x.point[axis] < y.point[axis]; });
  build(first, middle);
  const std::uint32_t other = build(middle, end);
  nodes_[number].other = other;
  return number;
}

template <class Visit>
bool SizeField::search(const Box& place, const double& bound, Visit visit) const {
  std::uint32_t waiting[64];  // more than the tree is deep
  std::size_t count = 0;
  if (!nodes_.empty()) waiting[count++] = 0;
  while (count > 0) {
    const std::uint32_t number = waiting[--count];
    const Node& node = nodes_[number];
    const double least = node.size + growth_ * std::sqrt(squared_distance(node.box, place));
    if (!(least * kSlack < bound)) continue;
    if (node.other != 0) {
      waiting[count++] = node.other;
      waiting[count++] = number + 1;
      continue;
    }
    for (std::uint32_t n = node.first; n < node.end; ++n) {
      if (visit(sources_[n])) return true;
    }
  }
  return false;
}

double SizeField::at(const Vec3& x) const {
  double smallest = std::numeric_limits<double>::infinity();
  search({x, x}, smallest, [&](const SizeSource& source) {
    smallest = std::min(smallest, source.size + growth_ * distance(x, source.point));
    return false;
  });
  return smallest;
}

bool SizeField::is_too_long(const Vec3& a, const Vec3& b) const {
  const Vec3 &from = std::min(a, b), &to = std::max(a, b);  // rounded alike from either end
  const double length = distance(from, to);
  Box place{from, from};
  place.extend({to, to});
  return search(place, length, [&](const SizeSource& source) {
    return source.size + growth_ * distance_to_edge(source.point, from, to) < length;
  });
}

}  // namespace delmesher::geometry
