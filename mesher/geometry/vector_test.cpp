#include "mesher/geometry/vector.h"

#include <gtest/gtest.h>

#include "mesher/predicates/point_families.h"

namespace delmesher::geometry {
namespace {

using families::Random;

// Identities of integers, which doubles compute exactly.
TEST(Vectors, ObeyTheIdentitiesOfProducts) {
  Random random(22);
  const auto number = [&] { return static_cast<double>(random.below(2001)) - 1000; };
  for (int round = 0; round < 100; ++round) {
    const Vec3 a = {number(), number(), number()}, b = {number(), number(), number()};
    const double s = number();
    const Vec3 n = cross(a, b);
    EXPECT_EQ(dot(n, a), 0);
    EXPECT_EQ(dot(n, b), 0);
    EXPECT_EQ(dot(n, n) + dot(a, b) * dot(a, b), dot(a, a) * dot(b, b));
    EXPECT_EQ(squared_norm(a), a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    EXPECT_EQ(norm(a) * norm(a) > 0, squared_norm(a) > 0);
    EXPECT_NEAR(norm(a) * norm(a), squared_norm(a), 1e-15 * squared_norm(a));
    EXPECT_NEAR(distance(a, b) * distance(a, b), squared_norm(a) + squared_norm(b) - 2 * dot(a, b),
                1e-8);
    const Vec3 c = add_scaled(a, s, b), d = subtract(c, a);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(d[k], s * b[k]);
    const Vec2 u = {a[0], a[1]}, v = {b[0], b[1]};
    EXPECT_EQ(cross(u, v), n[2]);
    EXPECT_EQ(dot(u, v), a[0] * b[0] + a[1] * b[1]);
    EXPECT_EQ(dot(turned(u), u), 0);
    EXPECT_EQ(cross(u, turned(u)), dot(u, u));
    EXPECT_EQ(dot(u + v, u + v), dot(u, u) + 2 * dot(u, v) + dot(v, v));
    EXPECT_EQ(dot(u - v, u - v), dot(u, u) - 2 * dot(u, v) + dot(v, v));
    EXPECT_EQ(dot(s * u, v), s * dot(u, v));
    EXPECT_EQ(cross(s * u, v), s * cross(u, v));
    if (dot(u, u) == 0) continue;
    EXPECT_NEAR(norm(unit(u)), 1, 1e-15);
    EXPECT_NEAR(dot(unit(u), u), norm(u), 1e-12);
  }
  EXPECT_EQ(cross({1, 0, 0}, {0, 1, 0})[2], 1);  // right-handed
}

}  // namespace
}  // namespace delmesher::geometry
