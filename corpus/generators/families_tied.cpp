// Families of exact ties, and of large and small numbers.
#include <algorithm>
#include <cmath>
#include <set>

#include "corpus/generators/certify.h"
#include "corpus/generators/families.h"
#include "corpus/generators/shapes.h"

namespace tetproof {
namespace {

using namespace shapes;

// Points of integers at a common distance from the origin: exactly cospherical.
Surface cospherical(FamilyMember& m) {
  Random& r = m.random;
  constexpr int kSquaredRadii[] = {3, 5, 6, 9, 14, 17, 26, 29, 41, 50, 62, 74, 89, 101};
  const int square = kSquaredRadii[r.below(std::size(kSquaredRadii))];
  std::vector<Point> all, points;
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) {
      for (int z = -10; z <= 10; ++z) {
        if (x * x + y * y + z * z == square) {
          all.push_back({static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)});
        }
      }
    }
  }
  const double share = r.between(0.3, 1);
  for (const Point& p : all) {
    if (r.chance(share)) points.push_back(p);
  }
  Surface s = convex_hull(points.size() < 6 ? all : points);
  if (r.chance(0.4)) {  // and a concentric one inside
    Surface inner = s;
    move(inner, [](const Point& p) { return Point{p[0] / 2, p[1] / 2, p[2] / 2}; });
    reverse(inner);
    append(s, inner);
  }
  return s;
}

// Points of integers on a circle, at several heights.
Surface cocylindrical(FamilyMember& m) {
  Random& r = m.random;
  constexpr int kSquaredRadii[] = {5, 25, 50, 65, 85, 130, 325};
  const int square = kSquaredRadii[r.below(std::size(kSquaredRadii))];
  std::vector<Planar> points;
  for (int x = -19; x <= 19; ++x) {
    for (int y = -19; y <= 19; ++y) {
      if (x * x + y * y == square) points.push_back({double(x), double(y)});
    }
  }
  std::sort(points.begin(), points.end(), [](const Planar& p, const Planar& q) {
    const bool upper_p = p[1] > 0 || (p[1] == 0 && p[0] > 0);
    const bool upper_q = q[1] > 0 || (q[1] == 0 && q[0] > 0);
    return upper_p != upper_q ? upper_p : p[0] * q[1] - p[1] * q[0] > 0;
  });
  const int levels = r.integer(1, 4);
  std::vector<Polygon> rings(static_cast<std::size_t>(levels) + 1, points);
  std::vector<double> heights;
  for (int i = 0; i <= levels; ++i) heights.push_back(i * (r.chance(0.9) ? 2 : 1.5));
  return tower(rings, heights, [&](int) { return r.chance(0.5); });
}

// Grid lines through the sides of random boxes; some sides all but coincide.
std::vector<double> lines_of(std::vector<double> ends, Random& r, int bits) {
  const std::size_t n = ends.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (r.chance(0.2)) ends.push_back(ends[i] + r.thin(bits));
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

// Unions and differences of boxes, cut along each other's planes.
Surface boolean_boxes(FamilyMember& m) {
  Random& r = m.random;
  const int count = r.integer(2, 5);
  std::array<std::vector<double>, 3> ends;
  const bool integers = r.chance(0.5);
  for (auto& list : ends) {
    for (int i = 0; i < 2 * count; ++i) {
      list.push_back(integers ? r.integer(0, 6) : r.between(0, 1));
    }
  }
  std::array<std::vector<double>, 3> lines;
  for (std::size_t i = 0; i < 3; ++i) lines[i] = lines_of(ends[i], r, m.bits);
  std::vector<bool> adds;
  for (int i = 0; i < count; ++i) adds.push_back(i == 0 || r.chance(0.7));
  const auto solid = [&](int x, int y, int z) {
    const int cell[3] = {x, y, z};
    bool inside = false;
    for (std::size_t b = 0; b < adds.size(); ++b) {
      bool in_box = true;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] = std::minmax(ends[i][2 * b], ends[i][2 * b + 1]);
        const double at = lines[i][static_cast<std::size_t>(cell[i])];
        in_box = in_box && at >= low && at < high;
      }
      if (in_box) inside = adds[b];
    }
    return inside;
  };
  Surface s = walls(lines, solid);
  if (s.triangles.size() > 1500) return {};  // too large for a quick test
  return s;
}

// The same on a grid whose lines in the plane are oblique and uneven: booleans of prisms.
Surface boolean_prisms(FamilyMember& m) {
  Random& r = m.random;
  const int n = r.integer(2, 5);
  std::array<std::vector<double>, 3> lines;
  for (std::size_t i = 0; i < 2; ++i) {
    for (int k = 0; k <= n; ++k) lines[i].push_back(k);
  }
  lines[2] = lines_of({0, 1, r.between(1.2, 3)}, r, m.bits);
  const auto levels = lines[2].size();
  std::vector<bool> filled(static_cast<std::size_t>(n * n) * levels);
  for (std::size_t i = 0; i < filled.size(); ++i) filled[i] = r.chance(0.55);
  Surface s = walls(lines, [&](int x, int y, int z) {
    return filled[static_cast<std::size_t>((z * n + y) * n + x)];
  });
  // Every vertical line of the grid is moved in the plane: the walls stay vertical and flat.
  std::vector<Planar> shift(static_cast<std::size_t>((n + 1) * (n + 1)));
  const double reach = r.chance(0.5) ? 0.45 : r.tiny(m.bits);
  for (Planar& d : shift) d = {r.between(-reach, reach), r.between(-reach, reach)};
  move(s, [&](const Point& p) {
    const Planar& d = shift[static_cast<std::size_t>(p[1]) * static_cast<std::size_t>(n + 1) +
                            static_cast<std::size_t>(p[0])];
    return Point{p[0] + d[0], p[1] + d[1], p[2]};
  });
  return s;
}

}  // namespace

std::vector<Family> tied_families() {
  return {{"cospherical", "hulls of integer points on a common sphere", cospherical},
          {"cocylindrical", "integer points on a circle, at several heights", cocylindrical},
          {"boolean_boxes", "unions and differences of boxes, some sides all but coinciding",
           boolean_boxes},
          {"boolean_prisms", "the same for prisms with oblique walls", boolean_prisms}};
}

}  // namespace tetproof
