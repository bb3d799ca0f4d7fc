#include "mesher/geometry/hole_links.h"

#include <algorithm>
#include <numeric>

#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::geometry {
namespace {

// Whether the closed segments pq and ab meet in other points than common end points.
bool segments_meet(const Point2& p, const Point2& q, const Point2& a, const Point2& b) {
  const int pa = orient2d_sign(p, q, a), pb = orient2d_sign(p, q, b);
  const int ap = orient2d_sign(a, b, p), aq = orient2d_sign(a, b, q);
  if (pa * pb < 0 && ap * aq < 0) return true;
  const auto between = [](const Point2& s, const Point2& t, const Point2& x) {
    return x != s && x != t && std::min(s, t) < x && x < std::max(s, t);
  };
  return (pa == 0 && between(p, q, a)) || (pb == 0 && between(p, q, b)) ||
         (ap == 0 && between(a, b, p)) || (aq == 0 && between(a, b, q));
}

// Whether the direction from corner i of a counter-clockwise loop to p starts inside the polygon.
bool in_cone(const std::vector<Point2>& points, const Loop& loop, std::size_t i, const Point2& p) {
  const std::size_t n = loop.size();
  const Point2 &a = points[loop[(i + n - 1) % n]], &v = points[loop[i]],
               &b = points[loop[(i + 1) % n]];
  const bool left_of_both = orient2d_sign(a, v, p) > 0 && orient2d_sign(v, b, p) > 0;
  const bool left_of_one = orient2d_sign(a, v, p) > 0 || orient2d_sign(v, b, p) > 0;
  return orient2d_sign(a, v, b) > 0 ? left_of_both : left_of_one;
}

// Joins a clockwise hole to the counter-clockwise outer loop by a link between the hole's
// rightmost corner and the nearest corner of the outer loop that sees it. `all` are the facet's
// loops as they were, `outer` is the outer one with the holes joined so far. False if none sees it.
bool link_hole(const std::vector<Point2>& points, const std::vector<Loop>& all, const Loop& hole,
               Loop& outer, Polling& polling) {
  const std::size_t start = static_cast<std::size_t>(
      std::max_element(hole.begin(), hole.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return points[a] < points[b]; }) -
      hole.begin());
  const Point2& m = points[hole[start]];
  std::vector<std::size_t> order(outer.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return squared_distance(points[outer[a]], m) < squared_distance(points[outer[b]], m);
  });
  polling.poll(order.size());
  for (std::size_t i : order) {
    polling.poll();
    const Point2& v = points[outer[i]];
    if (v == m || !in_cone(points, outer, i, m)) continue;
    bool blocked = false;
    const auto test = [&](const Loop& loop) {
      for (std::size_t j = 0; j < loop.size() && !blocked; ++j) {
        polling.poll();
        blocked = segments_meet(v, m, points[loop[j]], points[loop[(j + 1) % loop.size()]]);
      }
    };
    for (const Loop& loop : all) test(loop);
    test(outer);
    if (blocked) continue;
    Loop inserted;
    for (std::size_t j = 0; j <= hole.size(); ++j) {
      inserted.push_back(hole[(start + j) % hole.size()]);
    }
    inserted.push_back(outer[i]);
    outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(i) + 1, inserted.begin(),
                 inserted.end());
    return true;
  }
  return false;
}

}  // namespace

Loop join_holes(const ProjectedFace& face, Polling& polling, bool& all) {
  Loop outer = face.loops[0];
  std::vector<Loop> holes(face.loops.begin() + 1, face.loops.end());
  const auto rightmost = [&](const Loop& loop) {
    Point2 best = face.points[loop[0]];
    for (std::uint32_t v : loop) best = std::max(best, face.points[v]);
    return best;
  };
  // From right to left: then nothing unlinked can hide the outer loop from the hole's right end.
  std::stable_sort(holes.begin(), holes.end(),
                   [&](const Loop& a, const Loop& b) { return rightmost(b) < rightmost(a); });
  all = true;
  for (const Loop& hole : holes) {
    all = link_hole(face.points, face.loops, hole, outer, polling) && all;
  }
  return outer;
}

}  // namespace delmesher::geometry
