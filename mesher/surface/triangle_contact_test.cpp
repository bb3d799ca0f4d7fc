#include "mesher/surface/triangle_contact.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace delmesher::surface {
namespace {

using Rational = std::array<mpq_class, 3>;

Rational operator-(const Rational& a, const Rational& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

mpq_class dot(const Rational& a, const Rational& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Rational cross(const Rational& a, const Rational& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The part of a convex polygon where (x - origin) . normal >= 0.
std::vector<Rational> clip(const std::vector<Rational>& polygon, const Rational& origin,
                           const Rational& normal) {
  std::vector<Rational> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Rational &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const mpq_class hp = dot(p - origin, normal), hq = dot(q - origin, normal);
    if (hp >= 0) result.push_back(p);
    if (sgn(hp) * sgn(hq) < 0) {
      Rational x;
      for (std::size_t j = 0; j < 3; ++j) x[j] = p[j] + hp / (hp - hq) * (q[j] - p[j]);
      result.push_back(x);
    }
  }
  return result;
}

// The corners of the intersection of two closed triangles: s clipped with the plane of t from both
// sides, then with the planes through the edges of t perpendicular to it.
std::vector<Rational> intersection(const std::array<Rational, 3>& s,
                                   const std::array<Rational, 3>& t) {
  const Rational n = cross(t[1] - t[0], t[2] - t[0]);
  std::vector<Rational> polygon(s.begin(), s.end());
  polygon = clip(polygon, t[0], n);
  polygon = clip(polygon, t[0], {-n[0], -n[1], -n[2]});
  for (std::size_t i = 0; i < 3; ++i) {
    polygon = clip(polygon, t[i], cross(n, t[(i + 1) % 3] - t[i]));
  }
  return polygon;
}

bool on_segment(const Rational& p, const Rational& a, const Rational& b) {
  const Rational c = cross(b - a, p - a);
  return c == Rational{0, 0, 0} && dot(p - a, b - p) >= 0;
}

// Straight from the definition; the intersection is convex, so it lies within the shared vertex or
// edge iff its corners do.
bool meet_by_definition(const PointStore& points, const Corners& s, const Corners& t) {
  const auto at = [&](VertexId v) {
    const Vec3 p = points.nearest(v);
    return Rational{mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
  };
  std::vector<Rational> shared;
  for (const VertexId v : s) {
    if (std::find(t.begin(), t.end(), v) != t.end()) shared.push_back(at(v));
  }
  const auto corners = intersection({at(s[0]), at(s[1]), at(s[2])}, {at(t[0]), at(t[1]), at(t[2])});
  return std::any_of(corners.begin(), corners.end(), [&](const Rational& p) {
    return shared.empty() || !on_segment(p, shared.front(), shared.back());
  });
}

class Contact : public testing::TestWithParam<int> {};

TEST_P(Contact, AgreesWithRationalClipping) {
  const auto shared = static_cast<std::size_t>(GetParam());
  std::mt19937_64 random(11 + shared);
  std::array<int, 2> seen{}, coplanar{};
  for (int round = 0; round < 6000; ++round) {
    PointStore points;
    Predicates predicates(points);
    const std::uint64_t grid = 2 + random() % 4, flat = random() % 4;
    const auto point = [&] {
      Vec3 p;
      for (std::size_t i = 0; i < 3; ++i) p[i] = flat == i ? 0.3 : 0.1 * double(random() % grid);
      return points.add_explicit(p[0], p[1], p[2]);
    };
    Corners s{point(), point(), point()}, t{point(), point(), point()};
    for (std::size_t i = 0; i < shared; ++i) t[i] = s[2 - i];
    std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    if (random() % 2 == 0) std::swap(t[0], t[1]);
    const Projection ps = find_projection(predicates, s), pt = find_projection(predicates, t);
    if (ps.sign == 0 || pt.sign == 0) continue;
    const bool expected = meet_by_definition(points, s, t);
    ++(flat < 3 ? coplanar : seen)[expected];
    ASSERT_EQ(meet_outside_shared(predicates, s, t, ps, pt), expected) << round;
    ASSERT_EQ(meet_outside_shared(predicates, t, s, pt, ps), expected) << round;
  }
  for (const int n : {seen[0], seen[1], coplanar[0], coplanar[1]}) EXPECT_GT(n, 30);
}

// A triangle within another one, with no edges touching: random grids hardly ever make one.
TEST(ContactInPlane, NestedTriangles) {
  PointStore points;
  Predicates predicates(points);
  const auto at = [&](double x, double y) { return points.add_explicit(x, y, x + 2 * y); };
  const Corners outer{at(0, 0), at(8, 0), at(0, 8)}, inner{at(1, 1), at(1, 2), at(2, 1)},
      beside{at(5, 5), at(5, 6), at(6, 5)};
  const auto meet = [&](const Corners& s, const Corners& t) {
    return meet_outside_shared(predicates, s, t, find_projection(predicates, s),
                               find_projection(predicates, t));
  };
  EXPECT_TRUE(meet(outer, inner));
  EXPECT_TRUE(meet(inner, outer));
  EXPECT_FALSE(meet(outer, beside));
  EXPECT_FALSE(meet(beside, outer));
}

INSTANTIATE_TEST_SUITE_P(Shared, Contact, testing::Values(0, 1, 2));

}  // namespace
}  // namespace delmesher::surface
