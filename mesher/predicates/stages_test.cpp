// Which stage decides, and the supports of points.
#include "mesher/predicates/stages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "mesher/predicates/point_families.h"
#include "mesher/predicates/predicates.h"

namespace delmesher::predicates::stages_test {
namespace {

using families::Random;
using families::Sample;

// Every sign is decided once, the filter decides no zero and supports nothing
// else.
TEST(Stages, EachSignIsDecidedByOne) {
  Random random(21);
  PredicateCounters sum;
  for (const families::Family& family : families::all()) {
    Sample sample;
    families::fill(sample, family, 10, random);
    Predicates p(sample.store);
    for (int i = 0; i < 200; ++i) {
      std::array<VertexId, 5> v;
      for (VertexId& id : v) id = static_cast<VertexId>(random.below(sample.store.size()));
      const std::function<int()> signs[] = {
          [&] { return p.orient3d(v[0], v[1], v[2], v[3]); },
          [&] { return p.orient2d(i % 3, v[0], v[1], v[2]); },
          [&] { return p.insphere(v[0], v[1], v[2], v[3], v[4]); },
          [&] { return p.dot_sign(v[0], v[1], v[2]); },
          [&] { return p.dot_difference_sign(v[0], v[1], v[2], v[3]); },
          [&] { return p.in_diametral_ball(v[0], v[1], v[2], v[3]); },
          [&] { return p.dihedral_sign(v[0], v[1], v[2], v[3]); }};
      for (const auto& sign : signs) {
        const PredicateCounters before = p.counters;
        const int s = sign();
        ASSERT_EQ(p.counters.decided(), before.decided() + 1);
        ASSERT_EQ(p.counters.symbolic, before.symbolic);
        if (s == 0) {
          EXPECT_EQ(p.counters.filter, before.filter);
        } else {
          EXPECT_EQ(p.counters.support, before.support);
        }
      }
    }
    const PredicateCounters one = p.counters;
    const PredicateCounters earlier = sum;
    sum += one;
    EXPECT_EQ(sum.filter, earlier.filter + one.filter);
    EXPECT_EQ(sum.support, earlier.support + one.support);
    EXPECT_EQ(sum.extended, earlier.extended + one.extended);
    EXPECT_EQ(sum.fixed, earlier.fixed + one.fixed);
    EXPECT_EQ(sum.exact, earlier.exact + one.exact);
    EXPECT_EQ(sum.symbolic, earlier.symbolic + one.symbolic);
  }
  EXPECT_GT(sum.filter, 0U);
  EXPECT_GT(sum.support, 0U);
  EXPECT_GT(sum.extended, 0U);
  EXPECT_GT(sum.exact, 0U);
}

TEST(Stages, PerturbationIsCountedWhereItDecides) {
  PointStore store;
  for (int i = 0; i < 8; ++i) store.add_explicit(i & 1, i >> 1 & 1, i >> 2);
  store.add_explicit(0.25, 0.5, 0.25);
  Predicates p(store);
  EXPECT_NE(p.insphere_perturbed(0, 1, 2, 4, 7), 0);  // corners of a cube
  EXPECT_EQ(p.counters.symbolic, 1U);
  EXPECT_NE(p.insphere_perturbed(0, 1, 2, 4, 8), 0);
  EXPECT_EQ(p.insphere_perturbed(0, 1, 2, 4, 4), 0);
  EXPECT_EQ(p.counters.symbolic, 1U);
}

// A coordinate that all four points have proves that they are coplanar; one that only three have
// proves nothing, although the others' bits are too few for the filter.
TEST(Stages, SharedCoordinatesProveZeros) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool shared : {true, false}) {
      PointStore store;
      const double u[] = {0.1, 0.7, 0.3, 0.9}, v[] = {0.2, 0.4, 0.8, 0.6};
      for (std::size_t i = 0; i < 4; ++i) {
        Vec3 p{};
        p[axis] = i == 3 && !shared ? std::nextafter(0.1, 1) : 0.1;
        p[(axis + 1) % 3] = u[i];
        p[(axis + 2) % 3] = v[i];
        store.add_explicit(p[0], p[1], p[2]);
      }
      Predicates p(store);
      EXPECT_EQ(p.orient3d(0, 1, 2, 3) == 0, shared);
      EXPECT_EQ(p.counters.support, shared ? 1U : 0U) << axis;
      EXPECT_EQ(p.counters.decided() - p.counters.support, shared ? 0U : 1U);
    }
  }
}

// Signs that the filter does not decide go to integers where these are short, else to
// double-doubles: a point that is off the plane of the others by 2^-52, and one of these at 2^-250
// instead of zero.
TEST(Stages, ShortNumbersGoToIntegersLongOnesToDoubleDoubles) {
  for (const double x : {0.0, 0x1p-250}) {
    PointStore store;
    store.add_explicit(x, 0, 0);
    store.add_explicit(1, 0.5, 0.25);
    store.add_explicit(0.25, 1, 0.5);
    store.add_explicit(1.25, 1.5, 0.75 + 0x1p-52);
    Predicates p(store);
    EXPECT_EQ(p.orient3d(0, 1, 2, 3), 1);
    EXPECT_EQ(p.counters.filter, 0U);
    EXPECT_EQ(p.counters.extended, x == 0 ? 0U : 1U);
    EXPECT_EQ(p.counters.fixed, x == 0 ? 1U : 0U);
  }
}

// Differences of coordinates of b bits are below 2^(b + 1) =: 2^B, and B <= 64 N - 2.
TEST(Stages, LimbsHoldDifferencesOfTheCoordinates) {
  for (const int bits : {2, 40, 60, 61, 62, 63, 100, 124, 125, 126, 127, 188, 189, 190, 253, 254}) {
    for (const int low : {0, -30, -900}) {
      PointStore store;
      store.add_explicit(std::ldexp(1.0, low), 0, 0);
      store.add_explicit(0, std::ldexp(1.0, low + bits - 1), 0);
      const VertexId ids[] = {0, 1};
      const stages::ExactArguments arguments(store, ids, 2);
      EXPECT_EQ(arguments.exponent, low);
      EXPECT_EQ(arguments.bits, bits);
      const int limbs = stages::limbs_needed(arguments);
      EXPECT_LE(bits + 1, 64 * limbs - 2);
      EXPECT_GT(bits + 1, 64 * (limbs - 1) - 2);
      EXPECT_EQ(stages::exact_is_cheap<polynomials::Orient3d>(arguments), limbs <= 3);
      EXPECT_FALSE(stages::exact_is_cheap<polynomials::AngleExcess>(arguments));
    }
  }
}

// Supports that are set late, replaced by longer and shorter ones: nobody else's change.
TEST(PointStore, SupportsOfOthersStay) {
  Random random(23);
  PointStore store;
  std::vector<std::vector<PlaneId>> planes;
  std::vector<std::vector<std::uint32_t>> lines;
  for (int i = 0; i < 6; ++i) store.add_explicit(random.unit(), random.unit(), random.unit());
  for (int round = 0; round < 400; ++round) {
    if (round % 10 == 0) store.add_on_segment(0, 1, random.unit());
    if (round % 10 == 5) store.add_explicit(random.unit(), 1, 1);
    planes.resize(store.size());
    lines.resize(store.size());
    const auto v = static_cast<VertexId>(random.below(store.size()));
    planes[v].resize(random.below(4));
    lines[v].resize(random.below(3));
    std::uint32_t next = static_cast<std::uint32_t>(10 * round);
    for (auto& id : planes[v]) id = next++;
    for (auto& id : lines[v]) id = next++;
    store.set_supports(v, planes[v], lines[v]);
    for (VertexId u = 0; u < store.size(); ++u) {
      ASSERT_TRUE(std::equal(planes[u].begin(), planes[u].end(), store.planes(u).begin(),
                             store.planes(u).end()));
      ASSERT_TRUE(std::equal(lines[u].begin(), lines[u].end(), store.lines(u).begin(),
                             store.lines(u).end()));
    }
  }
}

// Far from the origin, differences of implicit points are right to more digits than their doubles.
TEST(PointStore, DifferencesUseWhatDoublesLeaveOver) {
  PointStore store;
  store.add_explicit(0x1p40, 0x1p41, -0x1p40);
  store.add_explicit(0x1p40 + 1, 0x1p41 + 3, -0x1p40 - 2);
  const double t = 0x1.5555p-30, s = 0x1.3333p-28;
  const VertexId a = store.add_on_segment(1, 0, t), b = store.add_on_segment(1, 0, s);
  const Vec3 d = store.difference(a, b);
  const double edge[3] = {1, 3, -2};
  for (std::size_t k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(d[k], (s - t) * edge[k]);
  const Vec3 plain = store.difference(0, 1);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(plain[k], edge[k]);
  EXPECT_EQ(store.remainder(0).x, 0);
  EXPECT_EQ(store.definition(0).kind, PointKind::explicit_point);
  EXPECT_EQ(store.definition(a).u, t);
  EXPECT_TRUE(store.is_explicit(1));
  EXPECT_FALSE(store.is_explicit(b));
}

}  // namespace
}  // namespace delmesher::predicates::stages_test
