// Laws of the predicates that no table of examples shows: symbolic perturbation, supports, scaling,
// and that every stage is really used.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "mesher/predicates/dihedral_filter.h"
#include "mesher/predicates/point_families.h"
#include "mesher/predicates/predicates.h"
#include "mesher/predicates/rational_reference.h"
#include "mesher/predicates/stages.h"

namespace delmesher::predicates::predicate_laws_test {
namespace {

using families::Random;
using families::Sample;

// The corners, edge midpoints, face centres of a box and its centre, in random order; the centres
// of faces as on-triangle points, midpoints as on-segment points.
void fill_box(Sample& sample, Random& random) {
  PointStore& store = sample.store;
  for (int i = 0; i < 8; ++i) {
    sample.of_kind[0].push_back(store.add_explicit(
        (i & 1) != 0 ? 1.1 : -1.1, (i & 2) != 0 ? 0.7 : -0.7, (i & 4) != 0 ? 3 : 1));
  }
  for (int i = 0; i < 24; ++i) {
    const VertexId corner = static_cast<VertexId>(random.below(8));
    const auto axis = random.below(3);
    const VertexId along = corner ^ (1U << axis);
    const VertexId across = corner ^ (1U << ((axis + 1) % 3));
    if (i % 2 == 0) {
      sample.of_kind[1].push_back(store.add_on_segment(corner, along, 0.5));
    } else {
      sample.of_kind[2].push_back(store.add_on_triangle(along, across, corner, 0.5, 0.5));
    }
    if (i % 3 == 0) sample.of_kind[0].push_back(store.add_explicit(0, 0, 2));
  }
}

bool even(const std::array<std::size_t, 5>& permutation) {
  int inversions = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j < i; ++j) inversions += permutation[j] > permutation[i] ? 1 : 0;
  }
  return inversions % 2 == 0;
}

TEST(InspherePerturbed, AntisymmetricUnderAllPermutations) {
  Random random(1);
  Sample sample;
  fill_box(sample, random);
  Predicates predicates(sample.store);
  int cospherical = 0;
  for (int mix = 0; mix < 243; ++mix) {
    std::array<VertexId, 5> v;
    int digits = mix;
    for (VertexId& id : v) {
      id = sample.pick(static_cast<PointKind>(digits % 3), random);
      digits /= 3;
    }
    const int sign = predicates.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]);
    cospherical += predicates.insphere(v[0], v[1], v[2], v[3], v[4]) == 0 ? 1 : 0;
    std::array<std::size_t, 5> p = {0, 1, 2, 3, 4};
    do {
      ASSERT_EQ(predicates.insphere_perturbed(v[p[0]], v[p[1]], v[p[2]], v[p[3]], v[p[4]]),
                even(p) ? sign : -sign);
    } while (std::next_permutation(p.begin(), p.end()));
  }
  EXPECT_GT(cospherical, 50);
  EXPECT_GT(predicates.counters.symbolic, 1000U);
}

// Against the determinant with heights raised by actual numbers: eps far below anything that the
// coordinates can produce, and far smaller for larger ids.
TEST(InspherePerturbed, IsTheSignForSmallRaisedHeights) {
  Random random(2);
  Sample sample;
  fill_box(sample, random);
  Predicates predicates(sample.store);
  int ties = 0, zeros = 0;
  for (int round = 0; round < 1500; ++round) {
    std::array<VertexId, 5> v;
    for (VertexId& id : v) id = static_cast<VertexId>(random.below(sample.store.size()));
    std::vector<std::vector<mpq_class>> m;
    for (const VertexId id : v) {
      const reference::Point p = reference::point(sample.store, id);
      const mpq_class eps = mpq_class(1) / (mpz_class(1) << (1000 * (id + 1)));
      m.push_back({1, p[0], p[1], p[2], mpq_class(reference::dot(p, p) + eps)});
    }
    const int expected = -sgn(reference::determinant(m));
    ASSERT_EQ(predicates.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]), expected);
    ties += predicates.insphere(v[0], v[1], v[2], v[3], v[4]) == 0 ? 1 : 0;
    zeros += expected == 0 ? 1 : 0;
  }
  EXPECT_GT(ties, 300);
  EXPECT_GT(zeros, 10);
}

TEST(InspherePerturbed, SmallerIdIsPushedOutside) {
  PointStore store;
  store.add_explicit(1, 1, 1);
  store.add_explicit(0, 0, 0);
  store.add_explicit(1, 0, 0);
  store.add_explicit(0, 1, 0);
  store.add_explicit(0, 0, 1);
  Predicates predicates(store);
  ASSERT_GT(predicates.orient3d(1, 2, 3, 4), 0);
  EXPECT_EQ(predicates.insphere(1, 2, 3, 4, 0), 0);
  EXPECT_LT(predicates.insphere_perturbed(1, 2, 3, 4, 0), 0);
}

// Never zero unless all five points are coplanar or an argument is repeated.
TEST(InspherePerturbed, VanishesForCoplanarPointsOnly) {
  Random random(3);
  Sample sample;
  fill_box(sample, random);
  Predicates predicates(sample.store);
  int coplanar = 0;
  for (int round = 0; round < 3000; ++round) {
    std::array<VertexId, 5> v;
    for (VertexId& id : v) id = static_cast<VertexId>(random.below(sample.store.size()));
    std::array<VertexId, 5> sorted = v;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) continue;
    bool flat = true;
    for (std::size_t skip = 0; skip < 5; ++skip) {
      std::array<VertexId, 4> w;
      for (std::size_t i = 0, k = 0; i < 5; ++i) {
        if (i != skip) w[k++] = v[i];
      }
      flat = flat && predicates.orient3d(w[0], w[1], w[2], w[3]) == 0;
    }
    coplanar += flat ? 1 : 0;
    ASSERT_EQ(predicates.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]) == 0, flat);
  }
  EXPECT_GT(coplanar, 10);
}

// The in-circle test of four points of a facet, by an apex off its plane (insphere times orient3d),
// depends neither on the apex, nor on its id, nor on its side.
TEST(InspherePerturbed, CocircularTieDoesNotDependOnTheApex) {
  Random random(4);
  for (int round = 0; round < 50; ++round) {
    PointStore store;
    std::vector<VertexId> square, apexes;
    std::array<int, 12> order;
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = 11; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
    for (const int what : order) {
      if (what < 4) {
        square.push_back(store.add_explicit((what & 1) * 2 - 1, (what & 2) - 1, 0));
      } else {
        const double side = what % 2 == 0 ? 1 : -1;
        apexes.push_back(store.add_explicit(random.unit() * 4 - 2, random.unit() * 4 - 2,
                                            side * (random.unit() + 0.01)));
      }
    }
    Predicates predicates(store);
    const auto in_circle = [&](VertexId apex) {
      return predicates.insphere_perturbed(square[0], square[1], square[2], apex, square[3]) *
             predicates.orient3d(square[0], square[1], square[2], apex);
    };
    ASSERT_EQ(predicates.insphere(square[0], square[1], square[2], apexes[0], square[3]), 0);
    const int sign = in_circle(apexes[0]);
    ASSERT_NE(sign, 0);
    for (const VertexId apex : apexes) ASSERT_EQ(in_circle(apex), sign);
  }
}

TEST(Signs, KnownCases) {
  PointStore store;
  const VertexId o = store.add_explicit(0, 0, 0), x = store.add_explicit(1, 0, 0);
  const VertexId y = store.add_explicit(0, 1, 0), z = store.add_explicit(0, 0, 1);
  const VertexId in = store.add_explicit(0.3, 0.3, 0.3), out = store.add_explicit(2, 2, 2);
  const VertexId below = store.add_explicit(0, -1, 1);
  Predicates p(store);
  EXPECT_EQ(p.orient3d(o, x, y, z), 1);
  EXPECT_EQ(p.orient2d(2, o, x, y), 1);
  EXPECT_EQ(p.orient2d(0, o, y, z), 1);
  EXPECT_EQ(p.orient2d(1, o, z, x), 1);
  EXPECT_EQ(p.insphere(o, x, y, z, in), 1);
  EXPECT_EQ(p.insphere(o, x, y, z, out), -1);
  EXPECT_EQ(p.dot_sign(x, o, out), 1);
  EXPECT_EQ(p.dot_sign(o, in, x), -1);  // in the diametral ball of o, x
  EXPECT_EQ(p.dot_sign(o, out, x), 1);
  EXPECT_EQ(p.dot_sign(x, o, y), 0);
  EXPECT_EQ(p.in_diametral_ball(x, y, z, in), 1);
  EXPECT_EQ(p.in_diametral_ball(x, y, z, y), 0);
  EXPECT_EQ(p.in_diametral_ball(x, y, z, out), -1);
  EXPECT_EQ(p.dihedral_sign(in, y, o, x), 1);
  EXPECT_EQ(p.dihedral_sign(z, y, o, x), 0);
  EXPECT_EQ(p.compare_xyz(o, x), -1);
  EXPECT_TRUE(p.angle_below(y, x, o, cosine_squared(45.001)));
  EXPECT_FALSE(p.angle_below(y, x, o, cosine_squared(45)));
  EXPECT_FALSE(p.angle_below(x, o, y, cosine_squared(90)));
  EXPECT_TRUE(p.dihedral_below(in, y, o, x, cosine_squared(46)));
  EXPECT_FALSE(p.dihedral_below(in, y, o, x, cosine_squared(45)));
  EXPECT_FALSE(p.bends_below(in, y, o, x, cosine_squared(90)));
  EXPECT_FALSE(p.bends_below(z, y, o, x, cosine_squared(90)));
  EXPECT_TRUE(p.bends_below(y, below, o, x, cosine_squared(45.001)));
  EXPECT_FALSE(p.bends_below(y, below, o, x, cosine_squared(45)));
  EXPECT_TRUE(p.edge_plane_angle_below(out, o, x, y, cosine_squared(36)));
  EXPECT_FALSE(p.edge_plane_angle_below(out, o, x, y, cosine_squared(35)));
}

TEST(CosineSquared, KnownAngles) {
  EXPECT_EQ(cosine_squared(0), 1);
  EXPECT_EQ(cosine_squared(30), 0.75);
  EXPECT_EQ(cosine_squared(45), 0.5);
  EXPECT_EQ(cosine_squared(60), 0.25);
  EXPECT_EQ(cosine_squared(90), 0);
  double previous = 1;
  for (int i = 1; i <= 900; ++i) {
    const double degrees = i / 10.0;
    const double c = std::cos(degrees * 3.14159265358979323846 / 180);
    ASSERT_NEAR(cosine_squared(degrees), c * c, 4e-16);
    ASSERT_LT(cosine_squared(degrees), previous);
    previous = cosine_squared(degrees);
  }
}

TEST(Supports, ProveZeroWithoutArithmetic) {
  Random random(5);
  PointStore store;
  // A slanted triangle, its points far from any coordinate plane.
  for (int i = 0; i < 4; ++i) store.add_explicit(random.unit(), random.unit(), random.unit());
  std::vector<VertexId> on;
  const std::uint32_t plane = 17, line = 4;
  for (int i = 0; i < 4; ++i) {
    on.push_back(store.add_on_triangle(0, 1, 2, random.unit() / 2, random.unit() / 2));
  }
  const auto zeros = [&] {
    Predicates predicates(store);
    EXPECT_EQ(predicates.orient3d(on[0], on[1], on[2], on[3]), 0);
    const PredicateCounters& c = predicates.counters;
    EXPECT_EQ(c.support + c.fixed + c.exact, 1U);
    return predicates.counters.support;
  };
  EXPECT_EQ(zeros(), 0U);  // no supports: proved by integers
  for (int i = 0; i < 4; ++i) {
    const std::array<PlaneId, 3> planes = {PlaneId(i), plane, PlaneId(20 + i)};
    store.set_supports(on[static_cast<std::size_t>(i)], planes, {});
  }
  EXPECT_EQ(zeros(), 1U);
  EXPECT_EQ(store.planes(on[2]).size(), 3U);
  EXPECT_EQ(store.planes(on[2])[0], 2U);
  EXPECT_TRUE(store.lines(on[2]).empty());
  // Three on a line prove it for any fourth point.
  std::vector<VertexId> chain;
  for (const double t : {0.1, 0.3, 0.7}) {
    chain.push_back(store.add_on_segment(0, 1, t));
    store.set_supports(chain.back(), {}, std::array{line});
  }
  Predicates predicates(store);
  EXPECT_EQ(predicates.orient3d(chain[0], 3, chain[1], chain[2]), 0);
  EXPECT_EQ(predicates.orient2d(0, chain[0], chain[1], chain[2]), 0);
  EXPECT_EQ(predicates.orient2d(1, chain[0], chain[1], chain[2]), 0);
  EXPECT_EQ(predicates.counters.support, 3U);
  // A shared support of three of four points on planes proves nothing.
  EXPECT_NE(predicates.orient3d(on[0], on[1], on[2], 3), 0);
}

TEST(PointStore, PopBackRestoresEverything) {
  Random random(6);
  PointStore store;
  for (int i = 0; i < 4; ++i) store.add_explicit(random.unit(), random.unit(), random.unit());
  store.set_supports(1, std::array<PlaneId, 2>{3, 5}, std::array<std::uint32_t, 1>{8});
  const VertexId kept = store.add_on_segment(0, 1, 0.37);
  store.set_supports(kept, store.planes(1), store.lines(1));
  for (int i = 0; i < 300; ++i) {
    VertexId v = 0;
    switch (random.below(3)) {
      case 0:
        v = store.add_explicit(random.unit(), 0, 0);
        break;
      case 1:
        v = store.add_on_segment(2, 3, random.unit());
        break;
      default:
        v = store.add_on_triangle(1, 2, 3, random.unit(), random.unit());
    }
    EXPECT_TRUE(store.planes(v).empty());
    EXPECT_TRUE(store.lines(v).empty());
    if (i % 2 == 0) store.set_supports(v, store.planes(kept), store.lines(kept));
    if (i % 4 == 0) store.set_supports(v, {}, store.lines(kept));
    if (i % 4 == 0) {
      EXPECT_TRUE(store.planes(v).empty());
      ASSERT_EQ(store.lines(v).size(), 1U);
    }
    store.pop_back();
    ASSERT_EQ(store.size(), v);
    ASSERT_EQ(store.planes(kept).size(), 2U);
    ASSERT_EQ(store.planes(kept)[1], 5U);
    ASSERT_EQ(store.lines(kept)[0], 8U);
    ASSERT_EQ(store.planes(1)[0], 3U);
    ASSERT_EQ(store.definition(kept).u, 0.37);
    ASSERT_FALSE(store.is_explicit(kept));
    ASSERT_TRUE(store.is_explicit(1));
  }
}

// Points that are added again after a removal are as they were.
TEST(PointStore, TruncatesToWhatItWas) {
  PointStore store;
  for (const double x : {0.0, 1.0, 3.0}) store.add_explicit(x, x * x, 1 - x);
  const std::uint32_t supports[] = {7, 9};
  const VertexId kept = store.add_on_segment(0, 1, 0.3);
  store.set_supports(kept, supports, {});
  const auto fill = [&] {
    store.add_explicit(0.1, 0.2, 0.3);
    store.set_supports(store.add_on_triangle(0, 1, 2, 0.1, 0.7), {}, supports);
    store.add_on_segment(1, 2, 0.9);
  };
  fill();
  const Vec3 last = store.nearest(6);
  store.truncate(7);
  ASSERT_EQ(store.size(), 7U);
  store.truncate(4);
  ASSERT_EQ(store.size(), 4U);
  EXPECT_EQ(store.planes(kept)[1], 9U);
  fill();
  ASSERT_EQ(store.size(), 7U);
  EXPECT_EQ(store.nearest(6), last);
  EXPECT_EQ(store.lines(5)[0], 7U);
  EXPECT_EQ(store.planes(kept)[0], 7U);
}

// Multiplying all coordinates by a power of two changes no sign, whatever stage decides.
TEST(Scaling, PowersOfTwoChangeNoSign) {
  const auto families = families::all();
  for (const std::size_t which : {0UL, 4UL, 5UL, 6UL, 7UL}) {
    for (const int k : {-10, 20, -400, 300, 1000}) {
      Random random(which), again(which);
      Sample plain, scaled;
      families::Family family = families[which];
      families::fill(plain, family, 10, random);
      const auto coordinate = family.coordinate;
      family.coordinate = [=](Random& r) { return std::ldexp(coordinate(r), k); };
      families::fill(scaled, family, 10, again);
      ASSERT_EQ(plain.store.size(), scaled.store.size());
      Predicates p(plain.store), q(scaled.store);
      for (int i = 0; i < 200; ++i) {
        std::array<VertexId, 5> v;
        for (VertexId& id : v) id = static_cast<VertexId>(random.below(plain.store.size()));
        ASSERT_EQ(p.orient3d(v[0], v[1], v[2], v[3]), q.orient3d(v[0], v[1], v[2], v[3]));
        ASSERT_EQ(p.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]),
                  q.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]));
        ASSERT_EQ(p.dihedral_below(v[0], v[1], v[2], v[3], 0.3),
                  q.dihedral_below(v[0], v[1], v[2], v[3], 0.3));
      }
    }
  }
}

// Points rounded onto a common sphere and onto common planes: the determinants are as small as
// rounding makes them, where a filter that is a little too sharp errs.
class NearlyDegenerate : public ::testing::TestWithParam<double> {
 protected:
  // On a sphere of the given radius about (shift, shift, shift).
  void fill(double shift) {
    for (int i = 0; i < 40; ++i) {
      const double x = random_.unit() - 0.5, y = random_.unit() - 0.5, z = random_.unit() - 0.5;
      const double r = std::sqrt(x * x + y * y + z * z);
      sample_.of_kind[0].push_back(
          sample_.store.add_explicit(shift + x / r, shift + y / r, shift + z / r));
    }
    // Implicit points next to the sphere's and exactly in planes of three of them.
    for (int i = 0; i < 40; ++i) {
      const VertexId p = corner(), q = corner(), r = corner();
      sample_.of_kind[1].push_back(sample_.store.add_on_segment(
          p, q, std::ldexp(random_.unit(), -static_cast<int>(random_.below(50)))));
      sample_.of_kind[2].push_back(
          sample_.store.add_on_triangle(p, q, r, random_.unit() / 3, random_.unit() / 3));
    }
    const std::size_t n = sample_.store.size();
    for (VertexId v = 40; v < n; ++v) {
      const Vec3 x = sample_.store.nearest(v);
      sample_.of_kind[0].push_back(sample_.store.add_explicit(x[0], x[1], x[2]));
    }
    for (VertexId v = 0; v < sample_.store.size(); ++v) {
      exact_.push_back(reference::point(sample_.store, v));
    }
  }
  VertexId corner() { return static_cast<VertexId>(random_.below(40)); }

  Random random_{11};
  Sample sample_;
  std::vector<reference::Point> exact_;
};

TEST_P(NearlyDegenerate, FiltersNeverErr) {
  fill(GetParam());
  const PointStore& store = sample_.store;
  std::array<int, 2> orient{}, insphere{}, dot{}, ball{}, dihedral{};  // unknown, certain
  const auto check = [](int filter, int expected, std::array<int, 2>& counts) {
    ++counts[filter != 0 ? 1 : 0];
    ASSERT_TRUE(filter == 0 || filter == expected);
  };
  const auto a = [&](VertexId v) -> const Approximation& { return store.approximation(v); };
  for (int i = 0; i < 3000; ++i) {
    std::array<VertexId, 5> v;
    for (VertexId& id : v) id = i % 2 == 0 ? corner() : VertexId(random_.below(store.size()));
    if (i % 3 == 0) {  // d: an implicit point of a triangle, or its rounded twin, and its corners
      const VertexId on = sample_.pick(PointKind::on_triangle, random_);
      const PointDefinition d = store.definition(on);
      v = {d.corner[0], d.corner[1], d.corner[2], i % 2 == 0 ? on : on + 80, v[4]};
    }
    std::array<reference::Point, 5> p;
    for (std::size_t k = 0; k < 5; ++k) p[k] = exact_[v[k]];
    check(filters::orient3d(a(v[0]), a(v[1]), a(v[2]), a(v[3])), reference::orient3d(p.data()),
          orient);
    check(filters::insphere(a(v[0]), a(v[1]), a(v[2]), a(v[3]), a(v[4])),
          reference::insphere(p.data()), insphere);
    check(filters::dot(a(v[0]), a(v[1]), a(v[2])),
          sgn(reference::dot(reference::minus(p[0], p[1]), reference::minus(p[2], p[1]))), dot);
    check(filters::dihedral(a(v[0]), a(v[1]), a(v[2]), a(v[3])), reference::dihedral_sign(p.data()),
          dihedral);
    if (reference::collinear(p[0], p[1], p[2])) continue;
    check(filters::in_diametral_ball(a(v[0]), a(v[1]), a(v[2]), a(v[3])),
          reference::in_diametral_ball(p.data()), ball);
  }
  EXPECT_GT(orient[0], 500);
  EXPECT_GT(orient[1], 500);
  EXPECT_GT(insphere[0], 500);
  EXPECT_GT(insphere[1], 500);
  EXPECT_GT(dot[1], 500);
  EXPECT_GT(ball[1], 500);
  EXPECT_GT(dihedral[1], 500);
}

INSTANTIATE_TEST_SUITE_P(Shifts, NearlyDegenerate, ::testing::Values(0.0, 1.0, 1000.0));

// Implicit points on boxes far from the origin: exactly cospherical, coplanar and right-angled, but
// their nearest doubles are not. Where the exact sign is zero, a filter must not be certain.
TEST(Filters, AllowForTheErrorsOfImplicitPoints) {
  Random random(13);
  int zeros = 0, moved = 0, certain = 0;
  for (int round = 0; round < 4000; ++round) {
    PointStore store;
    // Oblique, as the nearest doubles of the points of an upright box form a box; edges along
    // orthogonal vectors, corners exact.
    const double shift = std::ldexp(1.0, static_cast<int>(random.below(25)));
    const double edges[3][3] = {{1, 2, 2}, {2, 1, -2}, {2, -2, 1}};
    double length[3];
    for (double& x : length) x = std::ldexp(1.0 + static_cast<double>(random.below(1024)), -12);
    for (int i = 0; i < 8; ++i) {
      Vec3 x = {shift, shift, shift};
      for (int k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if ((i >> k & 1) != 0) x[axis] += length[k] * edges[k][axis];
        }
      }
      store.add_explicit(x[0], x[1], x[2]);
    }
    // Points 8..15 are a smaller box: at s or t on the four edges of one direction, ids as the
    // corners'.
    const double s = random.unit(), t = random.unit();
    for (VertexId i = 0; i < 8; ++i) store.add_on_segment(i | 1U, i & ~1U, (i & 1U) != 0 ? s : t);
    const auto a = [&](VertexId v) -> const Approximation& { return store.approximation(v + 8); };
    for (VertexId v = 8; v < 16; ++v) moved += store.approximation(v).error > 0 ? 1 : 0;
    std::array<VertexId, 8> v = {0, 1, 2, 3, 4, 5, 6, 7};
    for (std::size_t i = 7; i > 0; --i) std::swap(v[i], v[random.below(i + 1)]);
    // Five corners of a box lie on its sphere.
    ASSERT_EQ(filters::insphere(a(v[0]), a(v[1]), a(v[2]), a(v[3]), a(v[4])), 0);
    // Opposite edges are coplanar, the angles between edges right.
    const VertexId c = v[0];
    ASSERT_EQ(filters::orient3d(a(c), a(c ^ 1U), a(c ^ 6U), a(c ^ 7U)), 0);
    ASSERT_EQ(filters::dot(a(c ^ 1U), a(c), a(c ^ 4U)), 0);
    ASSERT_EQ(filters::dot(a(c ^ 1U), a(c), a(c ^ 6U)), 0);
    ASSERT_EQ(filters::dihedral(a(c ^ 2U), a(c ^ 4U), a(c ^ 1U), a(c)), 0);
    // Corners see a diagonal of their rectangle under a right angle.
    ASSERT_EQ(filters::in_diametral_ball(a(c), a(c ^ 1U), a(c ^ 4U), a(c ^ 5U)), 0);
    ASSERT_EQ(filters::in_diametral_ball(a(c), a(c ^ 1U), a(c ^ 6U), a(c ^ 7U)), 0);
    Predicates predicates(store);
    zeros += predicates.insphere(v[0] + 8, v[1] + 8, v[2] + 8, v[3] + 8, v[4] + 8) == 0 ? 1 : 0;
    certain += filters::orient3d(a(c), a(c ^ 1U), a(c ^ 2U), a(c ^ 4U)) != 0 ? 1 : 0;
  }
  EXPECT_EQ(zeros, 4000);
  EXPECT_GT(moved, 10000);
  EXPECT_GT(certain, 1000);
}

TEST(Counters, EveryStageDecides) {
  Random random(12);
  const auto families = families::all();
  PredicateCounters sum;
  std::array<int, 6> limbs{};
  for (const families::Family& family : families) {
    Sample sample;
    families::fill(sample, family, 10, random);
    Predicates predicates(sample.store);
    for (int i = 0; i < 300; ++i) {
      std::array<VertexId, 5> v;
      for (VertexId& id : v) id = static_cast<VertexId>(random.below(sample.store.size()));
      predicates.orient3d(v[0], v[1], v[2], v[3]);
      predicates.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]);
      const stages::ExactArguments arguments(sample.store, v.data(), 5);
      ++limbs[static_cast<std::size_t>(std::min(stages::limbs_needed(arguments), 5))];
    }
    sum += predicates.counters;
  }
  EXPECT_GT(sum.filter, 1000U);
  EXPECT_GT(sum.support, 100U);
  EXPECT_GT(sum.extended, 100U);
  EXPECT_GT(sum.fixed, 1000U);
  EXPECT_GT(sum.exact, 1000U);
  EXPECT_GT(sum.symbolic, 100U);
  for (std::size_t n = 1; n <= 5; ++n) EXPECT_GT(limbs[n], 50) << n << " limbs";
}

}  // namespace
}  // namespace delmesher::predicates::predicate_laws_test
