#include "oracles/base/triangle_sums.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace tetproof::oracles {
namespace {

// Sides of triangles, each with the number of times that it is there in one direction more often
// than in the other.
class TriangleSides {
 public:
  struct Side {
    Index from, to;
    long times;
  };

  void add(const std::array<Index, 3>& triangle, long times) {
    for (std::size_t i = 0; i < 3; ++i) add(triangle[i], triangle[(i + 1) % 3], times);
  }
  // The sides whose sum is the same. From a to b on a segment is from its first corner to b less
  // from there to a: of all sides on one segment few are left.
  const std::vector<Side>& reduced(const ExactPoints& points) {
    cancel();
    std::vector<Side> all;
    all.swap(sides_);
    for (const auto& [from, to, times] : all) {
      const Index corner = points.corner_of_segment(from, to);
      if (corner == kNone) {
        add(from, to, times);
      } else {
        add(corner, to, times);
        add(corner, from, -times);
      }
    }
    cancel();
    return sides_;
  }
  void clear() { sides_.clear(); }

 private:
  void add(Index from, Index to, long times) {
    if (from == to) return;
    sides_.push_back(from < to ? Side{from, to, times} : Side{to, from, -times});
  }
  // Leaves every side once, and those that are there as often in both directions out.
  void cancel() {
    const auto ends = [](const Side& side) { return std::pair(side.from, side.to); };
    std::ranges::sort(sides_, {}, ends);
    std::size_t kept = 0;
    for (std::size_t first = 0; first < sides_.size();) {
      Side sum = sides_[first];
      while (++first < sides_.size() && ends(sides_[first]) == ends(sum)) {
        sum.times += sides_[first].times;
      }
      if (sum.times != 0) sides_[kept++] = sum;
    }
    sides_.resize(kept);
  }

  std::vector<Side> sides_;
};

}  // namespace

std::array<ExactSum, 3> sum_of_areas2(const ExactPoints& points, TriangleSpan triangles,
                                      TriangleSpan less) {
  // The vertices of the input come first, and have the smallest numbers.
  Index origin = kNone;
  TriangleSides sides;
  for (const auto& [list, times] : {std::pair(triangles, 1L), std::pair(less, -1L)}) {
    for (const auto& corners : list) {
      sides.add(corners, times);
      origin = std::min(origin, *std::ranges::min_element(corners));
    }
  }
  std::array<ExactSum, 3> sum;
  for (const auto& [from, to, times] : sides.reduced(points)) {
    if (from == origin) continue;
    const ExactVector area = exact::area2(points, origin, from, to);
    for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += area[axis] * ExactNumber(times);
  }
  return sum;
}

// The volume between the origin and a triangle is the sum over its sides of those between the
// origin and the triangles of side and apex, for any apex in its plane.
ExactSum sum_from_origin6(const ExactPoints& points, TriangleSpan triangles) {
  ExactSum sum;
  exact::Volume6 volume6;
  std::vector<std::pair<Index, std::size_t>> by_plane;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Index plane = points.common_plane(triangles[t]);
    if (plane == kNone) {
      sum += volume6.from_origin(points, triangles[t]);
    } else {
      by_plane.emplace_back(plane, t);
    }
  }
  std::sort(by_plane.begin(), by_plane.end());
  TriangleSides sides;
  for (std::size_t first = 0; first < by_plane.size();) {
    const Index plane = by_plane[first].first;
    const Index apex = *std::ranges::min_element(triangles[by_plane[first].second]);
    sides.clear();
    for (; first < by_plane.size() && by_plane[first].first == plane; ++first) {
      sides.add(triangles[by_plane[first].second], 1);
    }
    for (const auto& [from, to, times] : sides.reduced(points)) {
      if (from == apex || to == apex) continue;
      sum += volume6.from_origin(points, {apex, from, to}) * ExactNumber(times);
    }
  }
  return sum;
}

}  // namespace tetproof::oracles
