#include "mesher/geometry/ear_clipper.h"

#include <algorithm>

#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::geometry {

int EarClipper::turn(std::size_t corner) const {
  return orient2d_sign(at(previous_[corner]), at(corner), at(next_[corner]));
}

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

}  // namespace delmesher::geometry
