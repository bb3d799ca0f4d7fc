#include "oracles/base/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "oracles/base/vectors.h"

namespace tetproof::oracles {
namespace {

double to_segment(const Position& p, const Position& a, const Position& b) {
  const Position along = minus(b, a);
  const double squared = dot(along, along);
  const double share = squared > 0 ? std::clamp(dot(minus(p, a), along) / squared, 0.0, 1.0) : 0;
  return quick_distance(p, between(a, b, share));
}

bool boxes_meet(const Position& a, const Position& b, const Corners& triangle, double distance) {
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({triangle[0][i], triangle[1][i], triangle[2][i]});
    if (std::max(a[i], b[i]) < low - distance || std::min(a[i], b[i]) > high + distance) {
      return false;
    }
  }
  return true;
}

constexpr int kHalvings = 60;

// The part of a segment, as shares of it, that is within a distance of a triangle. The distance
// from it is convex along the segment, so this is one interval; the first of the pair is the larger
// one if there is none.
std::pair<double, double> near_part(const Position& a, const Position& b, const Corners& triangle,
                                    double distance) {
  const auto far = [&](double share) {
    return distance_to_triangle(between(a, b, share), triangle);
  };
  double low = 0, high = 1;
  for (int n = 0; n < 2 * kHalvings && low < high; ++n) {
    const double third = (high - low) / 3, left = low + third, right = high - third;
    if (far(left) < far(right)) {
      high = right;
    } else {
      low = left;
    }
  }
  double nearest = (low + high) / 2;
  for (const double end : {0.0, 1.0}) {
    if (far(end) < far(nearest)) nearest = end;
  }
  if (!(far(nearest) <= distance)) return {1, 0};
  const auto last_near = [&](double end) {
    if (far(end) <= distance) return end;
    const double way = share_near(between(a, b, nearest), between(a, b, end), triangle, distance);
    return nearest + way * (end - nearest);
  };
  return {last_near(0), last_near(1)};
}

}  // namespace

// The plane's distance where the foot is in the triangle, else that of an edge.
double distance_to_triangle(const Position& p, const Corners& t) {
  const Position normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  bool above = true;
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < 3; ++i) {
    const Position& a = t[i];
    const Position& b = t[(i + 1) % 3];
    nearest = std::min(nearest, to_segment(p, a, b));
    above = above && dot(cross(normal, minus(b, a)), minus(p, a)) >= 0;
  }
  const double size = length(normal);
  if (!above || !(size > 0)) return nearest;
  return std::min(nearest, std::fabs(dot(normal, minus(p, t[0]))) / size);
}

double share_near(const Position& a, const Position& b, const Corners& triangle, double distance) {
  double near = 0, far = 1;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle = (near + far) / 2;
    (distance_to_triangle(between(a, b, middle), triangle) <= distance ? near : far) = middle;
  }
  return near;
}

bool is_segment_near(const Position& a, const Position& b, std::span<const Corners> triangles,
                     double distance) {
  std::vector<std::pair<double, double>> parts;
  for (const Corners& triangle : triangles) {
    if (!boxes_meet(a, b, triangle, distance)) continue;
    const auto part = near_part(a, b, triangle, distance);
    if (part == std::pair(0.0, 1.0)) return true;
    if (part.first <= part.second) parts.push_back(part);
  }
  std::ranges::sort(parts);
  // What lies between two parts is at both its ends within the distance.
  const double whole = quick_distance(a, b), gap = whole > 0 ? distance / whole : 1;
  double reached = 0;
  for (const auto& [first, last] : parts) {
    if (first > reached + (reached > 0 ? gap : 0)) return false;
    reached = std::max(reached, last);
  }
  return !parts.empty() && reached == 1;
}

}  // namespace tetproof::oracles
