#include "mesher/io/triangulate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>
#include <tuple>

#include "mesher/base/sort_unique.h"
#include "mesher/predicates/signs_of_doubles.h"
#include "mesher/predicates/vector.h"

namespace delmesher::io {
namespace {

using Point2 = std::array<double, 2>;
using Loop = std::vector<std::uint32_t>;

double squared_distance(const Point2& a, const Point2& b) {
  const double x = a[0] - b[0], y = a[1] - b[1];
  return x * x + y * y;
}

// Orientation of a simple projected loop: at its lexicographically smallest corner, an extreme
// point, it turns the way it runs. 0 if the loop is not simple there.
int loop_orientation(const std::vector<Point2>& points, const Loop& loop) {
  std::size_t lowest = 0;
  for (std::size_t i = 1; i < loop.size(); ++i) {
    if (points[loop[i]] < points[loop[lowest]]) lowest = i;
  }
  const std::size_t n = loop.size();
  return orient2d_sign(points[loop[(lowest + n - 1) % n]], points[loop[lowest]],
                       points[loop[(lowest + 1) % n]]);
}

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

// Clips the ears of one projected, counter-clockwise, (weakly) simple polygon.
//
// Every clipped triangle is strictly positive. So if the polygon is simple they cannot overlap:
// their indicator functions add up to the polygon's winding number, which is 0 or 1.
class EarClipper {
 public:
  EarClipper(const std::vector<Point2>& points, const Loop& loop, Polling& polling)
      : points_(points), loop_(loop), polling_(polling) {}

  // False if it got stuck, with the rest of the polygon clipped regardless.
  bool run(std::vector<Triangle>& triangles);

 private:
  struct Ear {
    double diagonal;  // squared length
    std::size_t corner;
    std::uint32_t version;
    bool operator<(const Ear& other) const {  // the shortest diagonal on top of the queue
      return std::tie(other.diagonal, other.corner) < std::tie(diagonal, corner);
    }
  };

  const Point2& at(std::size_t corner) const { return points_[loop_[corner]]; }
  int turn(std::size_t corner) const {
    return orient2d_sign(at(previous_[corner]), at(corner), at(next_[corner]));
  }
  void sort_blunt();
  bool is_ear(std::size_t corner) const;
  void examine(std::size_t corner);
  void clip(std::size_t corner, std::vector<Triangle>& triangles);

  const std::vector<Point2>& points_;
  const Loop& loop_;
  Polling& polling_;
  std::vector<std::size_t> previous_, next_;
  std::vector<std::uint32_t> version_;
  std::vector<std::uint8_t> alive_, convex_;
  // Corners that turn right or not: only they can block an ear. In the order of their coordinate
  // along `axis_`, the longer side of the polygon's box.
  std::vector<std::size_t> blunt_;
  std::size_t axis_ = 0;
  std::priority_queue<Ear> ears_;
  std::size_t left_ = 0;
};

void EarClipper::sort_blunt() {
  std::array<double, 2> low = at(0), high = at(0);
  for (const std::uint32_t v : loop_) {
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], points_[v][i]);
      high[i] = std::max(high[i], points_[v][i]);
    }
  }
  axis_ = high[1] / 2 - low[1] / 2 > high[0] / 2 - low[0] / 2 ? 1 : 0;
  std::sort(blunt_.begin(), blunt_.end(),
            [&](std::size_t a, std::size_t b) { return at(a)[axis_] < at(b)[axis_]; });
}

bool EarClipper::is_ear(std::size_t corner) const {
  const std::size_t before = previous_[corner], after = next_[corner];
  const Point2 &a = at(before), &b = at(corner), &c = at(after);
  const Point2 low = {std::min({a[0], b[0], c[0]}), std::min({a[1], b[1], c[1]})};
  const Point2 high = {std::max({a[0], b[0], c[0]}), std::max({a[1], b[1], c[1]})};
  const auto first = std::partition_point(blunt_.begin(), blunt_.end(),
                                          [&](std::size_t i) { return at(i)[axis_] < low[axis_]; });
  for (auto i = first; i != blunt_.end() && at(*i)[axis_] <= high[axis_]; ++i) {
    polling_.poll();
    const std::size_t other = *i;
    if (alive_[other] == 0 || convex_[other] != 0) continue;
    const std::uint32_t v = loop_[other];
    if (v == loop_[before] || v == loop_[corner] || v == loop_[after]) continue;
    const Point2& p = points_[v];
    if (p[0] < low[0] || p[0] > high[0] || p[1] < low[1] || p[1] > high[1]) continue;
    if (orient2d_sign(a, b, p) >= 0 && orient2d_sign(b, c, p) >= 0 && orient2d_sign(c, a, p) >= 0) {
      return false;
    }
  }
  return true;
}

void EarClipper::examine(std::size_t corner) {
  ++version_[corner];
  convex_[corner] = turn(corner) > 0 ? 1 : 0;
  if (convex_[corner] == 0 || !is_ear(corner)) return;
  const double diagonal = squared_distance(at(previous_[corner]), at(next_[corner]));
  ears_.push({diagonal, corner, version_[corner]});
}

void EarClipper::clip(std::size_t corner, std::vector<Triangle>& triangles) {
  const std::size_t before = previous_[corner], after = next_[corner];
  triangles.push_back({loop_[before], loop_[corner], loop_[after]});
  alive_[corner] = 0;
  next_[before] = after;
  previous_[after] = before;
  --left_;
}

bool EarClipper::run(std::vector<Triangle>& triangles) {
  const std::size_t n = loop_.size();
  previous_.resize(n);
  next_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    next_[i] = (i + 1) % n;
    previous_[i] = (i + n - 1) % n;
  }
  version_.assign(n, 0);
  alive_.assign(n, 1);
  convex_.assign(n, 0);
  left_ = n;
  for (std::size_t i = 0; i < n; ++i) {
    convex_[i] = turn(i) > 0 ? 1 : 0;
    if (convex_[i] == 0) blunt_.push_back(i);
  }
  sort_blunt();
  const auto examine_all = [&] {
    for (std::size_t i = 0; i < n; ++i) {
      if (alive_[i] != 0) examine(i);
    }
  };
  examine_all();
  // A clipped ear can free only its neighbours in a simple polygon; should that not hold with
  // bridges to holes, look again everywhere, a few times, before giving up.
  int second_looks = 4;
  bool stuck = false;
  while (left_ > 3) {
    if (ears_.empty()) {
      stuck = second_looks-- == 0;
      if (stuck) break;
      examine_all();
      continue;
    }
    const Ear ear = ears_.top();
    ears_.pop();
    if (alive_[ear.corner] == 0 || version_[ear.corner] != ear.version) continue;
    const std::size_t before = previous_[ear.corner], after = next_[ear.corner];
    clip(ear.corner, triangles);
    examine(before);
    examine(after);
  }
  std::size_t corner = 0;
  while (alive_[corner] == 0) ++corner;
  if (!stuck && turn(corner) <= 0) stuck = true;
  while (left_ > 2) {
    const std::size_t after = next_[corner];
    clip(after, triangles);
  }
  return !stuck;
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

// Joins a clockwise hole to the counter-clockwise outer loop by a bridge between the hole's
// rightmost corner and the nearest corner of the outer loop that sees it. `all` are the facet's
// loops as they were, `outer` is the outer one with the holes joined so far. False if none sees it.
bool bridge_hole(const std::vector<Point2>& points, const std::vector<Loop>& all, const Loop& hole,
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

// Local copies of the corners, projected along one axis.
struct Projected {
  std::vector<Point2> points;
  std::vector<Loop> loops;  // the outer one counter-clockwise, holes clockwise
  bool mirrored = false;    // the outer loop was turned round
  bool oriented = true;     // every loop has an orientation
};

Projected project_loops(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                        int axis) {
  Projected out;
  std::vector<std::uint32_t> distinct;
  for (const Loop& loop : loops) distinct.insert(distinct.end(), loop.begin(), loop.end());
  sort_unique(distinct);
  for (std::uint32_t v : distinct) out.points.push_back(project(vertices[v], axis));
  for (std::size_t i = 0; i < loops.size(); ++i) {
    Loop local;
    for (std::uint32_t v : loops[i]) {
      const auto found = std::lower_bound(distinct.begin(), distinct.end(), v);
      local.push_back(static_cast<std::uint32_t>(found - distinct.begin()));
    }
    const int orientation = loop_orientation(out.points, local);
    out.oriented = out.oriented && orientation != 0;
    if (orientation == (i == 0 ? -1 : 1)) {
      std::reverse(local.begin(), local.end());
      if (i == 0) out.mirrored = true;
    }
    out.loops.push_back(std::move(local));
  }
  return out;
}

bool triangulate_projected(const Projected& projected, Polling& polling,
                           std::vector<Triangle>& triangles) {
  Loop outer = projected.loops[0];
  std::vector<Loop> holes(projected.loops.begin() + 1, projected.loops.end());
  const auto rightmost = [&](const Loop& loop) {
    Point2 best = projected.points[loop[0]];
    for (std::uint32_t v : loop) best = std::max(best, projected.points[v]);
    return best;
  };
  // From right to left: then nothing unbridged can hide the outer loop from the hole's right end.
  std::stable_sort(holes.begin(), holes.end(),
                   [&](const Loop& a, const Loop& b) { return rightmost(b) < rightmost(a); });
  bool good = projected.oriented;
  for (const Loop& hole : holes) {
    good = bridge_hole(projected.points, projected.loops, hole, outer, polling) && good;
  }
  return EarClipper(projected.points, outer, polling).run(triangles) && good;
}

void measure_planarity(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                       FaceTriangulation& out) {
  const Triangle& t = out.triangles.front();
  const Point3 &a = vertices[t[0]], &b = vertices[t[1]], &c = vertices[t[2]];
  const Point3 normal = cross(subtract(b, a), subtract(c, a));
  const double length = norm(normal);
  for (const Loop& loop : loops) {
    for (std::uint32_t v : loop) {
      if (v == t[0] || v == t[1] || v == t[2] || orient3d_sign(a, b, c, vertices[v]) == 0) continue;
      out.planar = false;
      const double distance = std::fabs(dot(normal, subtract(vertices[v], a))) / length;
      if (std::isfinite(distance)) out.deviation = std::max(out.deviation, distance);
    }
  }
}

}  // namespace

std::array<double, 2> project(const Point3& p, int axis) {
  const auto i = static_cast<std::size_t>(axis);
  return {p[(i + 1) % 3], p[(i + 2) % 3]};
}

int dominating_axis(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop) {
  // Twice the area vector, from the first corner. Of equals the first axis.
  Point3 normal = {0, 0, 0};
  const Point3& origin = vertices[loop[0]];
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Point3 part =
        cross(subtract(vertices[loop[i]], origin), subtract(vertices[loop[i + 1]], origin));
    for (std::size_t k = 0; k < 3; ++k) normal[k] += part[k];
  }
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::fabs(normal[static_cast<std::size_t>(k)]) >
        std::fabs(normal[static_cast<std::size_t>(axis)])) {
      axis = k;
    }
  }
  return axis;
}

bool strictly_inside(const std::vector<Point3>& vertices, std::span<const std::uint32_t> loop,
                     int axis, const std::array<double, 2>& q) {
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    Point2 a = project(vertices[loop[i]], axis);
    Point2 b = project(vertices[loop[(i + 1) % loop.size()]], axis);
    if (b[1] < a[1]) std::swap(a, b);
    if (std::min(a[0], b[0]) <= q[0] && q[0] <= std::max(a[0], b[0]) && a[1] <= q[1] &&
        q[1] <= b[1] && orient2d_sign(a, b, q) == 0) {
      return false;
    }
    if (a[1] <= q[1] && q[1] < b[1] && orient2d_sign(a, b, q) > 0) inside = !inside;
  }
  return inside;
}

FaceTriangulation triangulate_face(const std::vector<Point3>& vertices, std::span<const Loop> loops,
                                   Polling& polling) {
  FaceTriangulation best;
  if (loops.size() == 1 && loops[0].size() == 3) {
    best.triangles.push_back({loops[0][0], loops[0][1], loops[0][2]});
    return best;
  }
  const int axis = dominating_axis(vertices, loops[0]);
  Loop distinct;
  for (const Loop& loop : loops) distinct.insert(distinct.end(), loop.begin(), loop.end());
  sort_unique(distinct);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Projected projected = project_loops(vertices, loops, (axis + attempt) % 3);
    std::vector<Triangle> triangles;
    const bool simple = triangulate_projected(projected, polling, triangles);
    if (attempt > 0 && !simple) continue;
    for (Triangle& t : triangles) {
      if (projected.mirrored) std::swap(t[1], t[2]);
      for (std::uint32_t& v : t) v = distinct[v];
    }
    best.triangles = std::move(triangles);
    best.simple = simple;
    if (simple) break;
  }
  measure_planarity(vertices, loops, best);
  return best;
}

}  // namespace delmesher::io
