#include "oracles/files/polygon.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tetproof::oracles {
namespace {

using Point = std::array<double, 2>;
using Triangles = std::vector<std::array<Index, 3>>;

// Exact sign of the turn from a by b to c.
int turn(const Point& a, const Point& b, const Point& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double sum = std::fabs(left) + std::fabs(right);
  // Each product has three roundings; below 1e-280 they might have underflowed.
  if (sum > 1e-280 && std::fabs(left - right) > 1e-15 * sum) return left > right ? 1 : -1;
  const auto difference = [](double p, double q) { return mpq_class(mpq_class(p) - mpq_class(q)); };
  const mpq_class exact = difference(b[0], a[0]) * difference(c[1], a[1]) -
                          difference(b[1], a[1]) * difference(c[0], a[0]);
  return sgn(exact);
}

// The axis along which the face has the largest projection.
int widest_axis(const std::vector<Position>& vertices, const std::vector<Index>& face) {
  const Position& o = vertices[face[0]];
  std::array<double, 3> area = {0, 0, 0};
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    const Position &p = vertices[face[i]], &q = vertices[face[i + 1]];
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, m = (k + 2) % 3;
      area[k] += (p[l] - o[l]) * (q[m] - o[m]) - (p[m] - o[m]) * (q[l] - o[l]);
    }
  }
  int axis = 0;
  for (const int k : {1, 2}) {
    if (std::fabs(area[k]) > std::fabs(area[axis])) axis = k;
  }
  return axis;
}

// One face, seen along one axis.
Point seen_along(int axis, const Position& p) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

class Cutter {
 public:
  // A ring that goes round counter-clockwise, and may pass places twice.
  Cutter(const std::vector<Position>& vertices, const std::vector<Index>& ring, int axis, bool)
      : corners_(ring), oriented_(true) {
    for (const Index v : ring) points_.push_back(seen_along(axis, vertices[v]));
  }
  Cutter(const Polyhedron& surface, const std::vector<Index>& face, int axis) : corners_(face) {
    for (const Index v : face) {
      const Position& p = surface.vertices[v];
      points_.push_back(seen_along(axis, p));
    }
    const std::size_t n = face.size();
    const std::size_t lowest = std::min_element(points_.begin(), points_.end()) - points_.begin();
    const int way = turn(points_[(lowest + n - 1) % n], points_[lowest], points_[(lowest + 1) % n]);
    oriented_ = way != 0;
    clockwise_ = way < 0;
    if (clockwise_) {
      std::reverse(corners_.begin(), corners_.end());
      std::reverse(points_.begin(), points_.end());
    }
  }

  // Empty if no ear was left.
  std::optional<Triangles> run() {
    if (!oriented_) return std::nullopt;
    for (std::size_t i = 0; i < points_.size(); ++i) left_.push_back(i);
    ear_.assign(points_.size(), Ear::unknown);
    Triangles triangles;
    while (left_.size() > 3) {
      const std::optional<std::size_t> place = shortest_ear();
      if (!place) return std::nullopt;
      triangles.push_back(triangle(*place));
      ear_[before(*place)] = ear_[after(*place)] = Ear::unknown;
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(*place));
    }
    if (!turns_left(1)) return std::nullopt;
    triangles.push_back(triangle(1));
    return triangles;
  }

 private:
  enum class Ear : std::uint8_t { unknown, no, yes };

  std::size_t before(std::size_t place) const {
    return left_[place == 0 ? left_.size() - 1 : place - 1];
  }
  std::size_t after(std::size_t place) const { return left_[(place + 1) % left_.size()]; }
  bool turns_left(std::size_t place) const {
    return turn(points_[before(place)], points_[left_[place]], points_[after(place)]) > 0;
  }
  std::array<Index, 3> triangle(std::size_t place) const {
    std::array<Index, 3> t = {corners_[before(place)], corners_[left_[place]],
                              corners_[after(place)]};
    if (clockwise_) std::swap(t[1], t[2]);
    return t;
  }

  std::optional<std::size_t> shortest_ear() {
    std::optional<std::size_t> best;
    double shortest = 0;
    for (std::size_t place = 0; place < left_.size(); ++place) {
      Ear& ear = ear_[left_[place]];
      if (ear == Ear::unknown) ear = is_ear(place) ? Ear::yes : Ear::no;
      if (ear == Ear::no) continue;
      const Point &p = points_[before(place)], &q = points_[after(place)];
      const double x = p[0] - q[0], y = p[1] - q[1], length = x * x + y * y;
      if (!best || length < shortest) {
        best = place;
        shortest = length;
      }
    }
    return best;
  }

  bool is_ear(std::size_t place) const {
    if (!turns_left(place)) return false;
    const Point &a = points_[before(place)], &b = points_[left_[place]], &c = points_[after(place)];
    for (std::size_t other = 0; other < left_.size(); ++other) {
      const Point& p = points_[left_[other]];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) < 0 || turn(b, c, p) < 0 || turn(c, a, p) < 0) continue;
      if (!turns_left(other)) return false;
    }
    return true;
  }

  std::vector<Index> corners_;
  std::vector<Point> points_;
  bool oriented_ = false, clockwise_ = false;
  std::vector<std::size_t> left_;  // corners not cut off, in order
  std::vector<Ear> ear_;           // by corner; a cut changes it only beside the cut
};

// The polygons of a facet, seen along one axis.
class FacetView {
 public:
  FacetView(const std::vector<Position>& vertices, std::vector<std::vector<Index>> polygons,
            int axis)
      : vertices_(vertices), polygons_(std::move(polygons)), axis_(axis) {
    for (std::vector<Index>& polygon : polygons_) {
      areas_.push_back(area(polygon));
      if (areas_.back() < 0) std::reverse(polygon.begin(), polygon.end());
    }
  }

  std::optional<Triangles> cut(const std::vector<Position>& holes) {
    std::vector<bool> is_hole(polygons_.size(), false);
    for (const Position& hole : holes) {
      const std::optional<std::size_t> around = innermost(seen_along(axis_, hole), is_hole);
      if (!around) return std::nullopt;
      is_hole[*around] = true;
    }
    std::vector<std::vector<std::vector<Index>>> cut_out(polygons_.size());
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      if (!is_hole[i]) continue;
      const auto around = innermost(at(polygons_[i][0]), is_hole);
      if (!around) return std::nullopt;
      cut_out[*around].emplace_back(polygons_[i].rbegin(), polygons_[i].rend());
    }
    Triangles triangles;
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      if (is_hole[i]) continue;
      const auto ring = linked(polygons_[i], cut_out[i]);
      const auto part = ring ? Cutter(vertices_, *ring, axis_, true).run() : std::nullopt;
      if (!part) return std::nullopt;
      triangles.insert(triangles.end(), part->begin(), part->end());
    }
    return triangles;
  }

 private:
  Point at(Index v) const { return seen_along(axis_, vertices_[v]); }

  double area(const std::vector<Index>& polygon) const {
    double sum = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point p = at(polygon[i]), q = at(polygon[(i + 1) % polygon.size()]);
      sum += (p[0] - q[0]) * (p[1] + q[1]);
    }
    return sum;
  }

  // A ray to the right crosses it an odd number of times.
  bool contains(std::size_t polygon, const Point& p) const {
    bool inside = false;
    const std::vector<Index>& corners = polygons_[polygon];
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Point a = at(corners[i]), b = at(corners[(i + 1) % corners.size()]);
      if ((a[1] > p[1]) == (b[1] > p[1])) continue;
      if (turn(a, b, p) * (b[1] > a[1] ? 1 : -1) > 0) inside = !inside;
    }
    return inside;
  }

  std::optional<std::size_t> innermost(const Point& p, const std::vector<bool>& except) const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < polygons_.size(); ++i) {
      if (except[i] || !contains(i, p)) continue;
      if (!best || std::fabs(areas_[i]) < std::fabs(areas_[*best])) best = i;
    }
    return best;
  }

  static bool on_between(const Point& a, const Point& b, const Point& p) {
    return turn(a, b, p) == 0 && p != a && p != b && std::min(a, b) < p && p < std::max(a, b);
  }
  // Do the segments have more in common than ends of both?
  static bool meet(const Point& a, const Point& b, const Point& c, const Point& d) {
    if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
    return on_between(a, b, c) || on_between(a, b, d) || on_between(c, d, a) || on_between(c, d, b);
  }
  bool meets_any(const Point& a, const Point& b, const std::vector<Index>& ring) const {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (meet(a, b, at(ring[i]), at(ring[(i + 1) % ring.size()]))) return true;
    }
    return false;
  }

  // Does the way from a corner of a ring to p begin inside?
  bool begins_inside(const std::vector<Index>& ring, std::size_t corner, const Point& p) const {
    const std::size_t n = ring.size();
    const Point before = at(ring[(corner + n - 1) % n]), here = at(ring[corner]),
                after = at(ring[(corner + 1) % n]);
    const bool left_in = turn(before, here, p) > 0, left_out = turn(here, after, p) > 0;
    return turn(before, here, after) > 0 ? left_in && left_out : left_in || left_out;
  }

  std::optional<std::vector<Index>> linked(std::vector<Index> ring,
                                           std::vector<std::vector<Index>> holes) const {
    const std::vector<Index> outer = ring;
    const std::vector<std::vector<Index>> all = holes;
    const auto before = [&](Index a, Index b) { return at(a) < at(b); };
    for (std::vector<Index>& hole : holes) {
      std::rotate(hole.begin(), std::max_element(hole.begin(), hole.end(), before), hole.end());
    }
    std::stable_sort(holes.begin(), holes.end(),
                     [&](const auto& a, const auto& b) { return before(b[0], a[0]); });
    for (const std::vector<Index>& hole : holes) {
      const Point from = at(hole[0]);
      std::optional<std::size_t> nearest;
      double shortest = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Point to = at(ring[i]);
        const double x = to[0] - from[0], y = to[1] - from[1], length = x * x + y * y;
        if ((nearest && length >= shortest) || to == from || !begins_inside(ring, i, from))
          continue;
        bool hidden = meets_any(to, from, ring) || meets_any(to, from, outer);
        for (const std::vector<Index>& other : all) hidden = hidden || meets_any(to, from, other);
        if (hidden) continue;
        nearest = i;
        shortest = length;
      }
      if (!nearest) return std::nullopt;
      std::vector<Index> detour = hole;
      detour.push_back(hole[0]);
      detour.push_back(ring[*nearest]);
      ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(*nearest) + 1, detour.begin(),
                  detour.end());
    }
    return ring;
  }

  const std::vector<Position>& vertices_;
  std::vector<std::vector<Index>> polygons_;
  int axis_;
  std::vector<double> areas_;
};

std::vector<Index> corners_of_fan(const Triangles& triangles, std::size_t first, std::size_t last) {
  std::vector<Index> face = {triangles[first][0], triangles[first][1]};
  for (std::size_t t = first; t < last; ++t) face.push_back(triangles[t][2]);
  return face;
}

}  // namespace

void cut_polygons(Polyhedron& surface) {
  std::vector<Index>& polygon = surface.polygons;
  std::vector<Index> renumbered(polygon.size());
  for (std::size_t first = 0, last = 0; first < polygon.size(); first = last) {
    while (last < polygon.size() && polygon[last] == polygon[first]) ++last;
    renumbered[first] = static_cast<Index>(first);
    if (last == first + 1) continue;
    const std::vector<Index> face = corners_of_fan(surface.triangles, first, last);
    const int axis = widest_axis(surface.vertices, face);
    std::optional<Triangles> triangles;
    for (int attempt = 0; attempt < 3 && !triangles; ++attempt) {
      triangles = Cutter(surface, face, (axis + attempt) % 3).run();
    }
    for (std::size_t t = first; t < last; ++t) {
      if (triangles) surface.triangles[t] = (*triangles)[t - first];
      renumbered[t] = static_cast<Index>(triangles ? t : first);
    }
  }
  polygon = std::move(renumbered);
}

std::optional<std::vector<std::array<Index, 3>>> cut_facet(
    const std::vector<Position>& vertices, const std::vector<std::vector<Index>>& polygons,
    const std::vector<Position>& holes) {
  const int axis = widest_axis(vertices, polygons[0]);
  for (int attempt = 0; attempt < 3; ++attempt) {
    const auto triangles = FacetView(vertices, polygons, (axis + attempt) % 3).cut(holes);
    if (triangles) return triangles;
  }
  return std::nullopt;
}

}  // namespace tetproof::oracles
