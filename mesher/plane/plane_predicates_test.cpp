// The laws of plane_predicates.h, against rational arithmetic and against the exact stage.
#include "mesher/plane/plane_predicates.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace delmesher::plane {
namespace {

using Coordinates = std::array<mpq_class, 2>;

Coordinates exact(const PointStore& points, VertexId v) {
  const PointDefinition d = points.definition(v);
  const auto corner = [&](VertexId c) {
    const Vec3 x = points.nearest(c);
    return Coordinates{mpq_class(x[0]), mpq_class(x[1])};
  };
  if (d.kind == PointKind::explicit_point) return corner(v);
  const Coordinates p = corner(d.corner[0]), q = corner(d.corner[1]);
  const mpq_class t = d.u;
  return {t * p[0] + (1 - t) * q[0], t * p[1] + (1 - t) * q[1]};
}

int rational_orient(const PointStore& s, VertexId a, VertexId b, VertexId c) {
  const Coordinates p = exact(s, a), q = exact(s, b), r = exact(s, c);
  return sgn(q[0] * r[1] - q[1] * r[0] - p[0] * r[1] + p[1] * r[0] + p[0] * q[1] - p[1] * q[0]);
}

// By the circumcentre, solved for: shares nothing with the determinant.
int rational_in_circle(const PointStore& s, VertexId a, VertexId b, VertexId c, VertexId d) {
  const Coordinates o = exact(s, a);
  const auto from = [&](VertexId v) {
    const Coordinates p = exact(s, v);
    return Coordinates{p[0] - o[0], p[1] - o[1]};
  };
  const Coordinates u = from(b), v = from(c), w = from(d);
  const mpq_class cross = u[0] * v[1] - u[1] * v[0];
  const mpq_class uu = u[0] * u[0] + u[1] * u[1], vv = v[0] * v[0] + v[1] * v[1];
  const mpq_class x = (uu * v[1] - vv * u[1]) / (2 * cross),
                  y = (vv * u[0] - uu * v[0]) / (2 * cross);
  return sgn(cross) * sgn(2 * (w[0] * x + w[1] * y) - w[0] * w[0] - w[1] * w[1]);
}

// Points of every kind: random, on a small grid (many ties), on segments, far away, tiny.
class Points : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
    const auto uniform = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    const double scale = std::ldexp(1.0, std::array<int, 5>{0, 0, -480, 200, -30}[GetParam() % 5]);
    const double away = GetParam() % 3 == 2 ? 1e8 : 0;
    for (int i = 0; i < 8; ++i) {
      const bool grid = GetParam() % 2 == 0;
      const double x = grid ? static_cast<double>(random() % 4) : uniform(-1, 1);
      const double y = grid ? static_cast<double>(random() % 4) : uniform(-1, 1);
      store_.add_explicit((x + away) * scale, (y - away) * scale, 0);
    }
    for (int i = 0; i < 8; ++i) {
      const auto p = static_cast<VertexId>(random() % 8);
      const auto q = (p + 1 + static_cast<VertexId>(random() % 7)) % 8;
      store_.add_on_segment(p, q,
                            i % 2 == 0 ? 0.25 * static_cast<double>(1 + i % 3) : uniform(0, 1));
    }
  }
  template <class Check>
  void for_quadruples(Check&& check) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 400; ++i) {
      std::array<VertexId, 4> v;
      for (VertexId& x : v) x = static_cast<VertexId>(random() % store_.size());
      check(v[0], v[1], v[2], v[3]);
    }
  }
  PointStore store_;
  PlanePredicates predicates_{store_};
};

TEST_P(Points, AgreeWithRationals) {
  for_quadruples([&](VertexId a, VertexId b, VertexId c, VertexId d) {
    EXPECT_EQ(predicates_.orient(a, b, c), rational_orient(store_, a, b, c));
    if (rational_orient(store_, a, b, c) != 0) {
      EXPECT_EQ(predicates_.in_circle(a, b, c, d), rational_in_circle(store_, a, b, c, d));
    }
    const Coordinates p = exact(store_, a), q = exact(store_, b), r = exact(store_, c);
    EXPECT_EQ(predicates_.dot(a, b, c),
              sgn((p[0] - q[0]) * (r[0] - q[0]) + (p[1] - q[1]) * (r[1] - q[1])));
  });
}

TEST_P(Points, Antisymmetric) {
  for_quadruples([&](VertexId a, VertexId b, VertexId c, VertexId d) {
    EXPECT_EQ(predicates_.orient(a, b, c), -predicates_.orient(b, a, c));
    EXPECT_EQ(predicates_.orient(a, b, c), predicates_.orient(b, c, a));
    for (const bool perturbed : {false, true}) {
      const auto sign = [&](VertexId p, VertexId q, VertexId r, VertexId s) {
        return perturbed ? predicates_.in_circle_perturbed(p, q, r, s)
                         : predicates_.in_circle(p, q, r, s);
      };
      const int s = sign(a, b, c, d);
      EXPECT_EQ(s, -sign(b, a, c, d));
      EXPECT_EQ(s, -sign(a, c, b, d));
      EXPECT_EQ(s, -sign(a, b, d, c));
    }
  });
}

TEST_P(Points, PerturbationDecidesAllButLines) {
  int ties = 0;
  for_quadruples([&](VertexId a, VertexId b, VertexId c, VertexId d) {
    const int s = predicates_.in_circle(a, b, c, d);
    const int perturbed = predicates_.in_circle_perturbed(a, b, c, d);
    if (s != 0) {
      EXPECT_EQ(s, perturbed);
      return;
    }
    const bool distinct = a != b && a != c && a != d && b != c && b != d && c != d;
    const bool line = predicates_.orient(a, b, c) == 0 && predicates_.orient(a, b, d) == 0 &&
                      predicates_.orient(a, c, d) == 0 && predicates_.orient(b, c, d) == 0;
    if (distinct && !line) {
      ++ties;
      EXPECT_NE(perturbed, 0);
    } else {
      EXPECT_EQ(perturbed, 0);
    }
  });
  if (GetParam() % 2 == 0) {
    EXPECT_GT(ties, 0);
  }
}

TEST_P(Points, FiltersAreRight) {
  int certain = 0;
  for_quadruples([&](VertexId a, VertexId b, VertexId c, VertexId d) {
    const auto& p = store_.approximation(a);
    const auto& q = store_.approximation(b);
    const auto& r = store_.approximation(c);
    if (const int s = filters::orient2d(p, q, r); s != 0) {
      EXPECT_EQ(s, rational_orient(store_, a, b, c));
      ++certain;
    }
    const int s = filters::in_circle(p, q, r, store_.approximation(d));
    if (s != 0 && rational_orient(store_, a, b, c) != 0) {
      EXPECT_EQ(s, rational_in_circle(store_, a, b, c, d));
      ++certain;
    }
  });
  if (GetParam() % 5 < 2 && GetParam() % 3 != 2) {
    EXPECT_GT(certain, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Points, testing::Range(0, 30));

}  // namespace
}  // namespace delmesher::plane
