// Laws of the predicates on all mixes of point kinds, decided by the oracles' integers and by CGAL;
// and the filters of the paper's appendix A against rationals. TETPROOF_ITERATIONS makes it longer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesher/predicates/filter.h"
#include "mesher/predicates/point_families.h"
#include "mesher/predicates/predicates.h"
#include "oracles/base/exact_points.h"
#include "oracles/cgal/kernel_opinion.h"
#include "property_tests/samples.h"

namespace tetproof::predicate_property_test {
namespace {

using delmesher::base::VertexId;
using delmesher::predicates::PointKind;
using delmesher::predicates::Predicates;
using delmesher::predicates::families::Family;
using delmesher::predicates::families::Random;

oracles::ExactPoints exact_points(const delmesher::predicates::PointStore& store) {
  std::vector<delmesher::ExactPoint> points;
  for (VertexId v = 0; v < store.size(); ++v) {
    const delmesher::predicates::PointDefinition d = store.definition(v);
    delmesher::ExactPoint p;
    if (d.kind == PointKind::explicit_point) {
      const auto x = store.nearest(v);
      p = {delmesher::ExactPoint::Kind::explicit_point, 0, 0, 0, x[0], x[1], x[2]};
    } else if (d.kind == PointKind::on_segment) {
      p = {delmesher::ExactPoint::Kind::on_segment, d.corner[0], d.corner[1], 0, d.u, 0, 0};
    } else if (d.kind == PointKind::on_planes) {
      p = {delmesher::ExactPoint::Kind::on_planes, d.corner[0], d.corner[1], d.corner[2], 0, 0, 0};
    } else {
      p = {delmesher::ExactPoint::Kind::on_triangle,
           d.corner[0],
           d.corner[1],
           d.corner[2],
           d.u,
           d.v,
           0};
    }
    points.push_back(p);
  }
  std::vector<delmesher::ExactRecord::Plane> planes;
  for (std::uint32_t n = 0; n < store.plane_count(); ++n) {
    planes.push_back({store.plane(n).spanned, store.plane(n).normal, store.plane(n).through});
  }
  oracles::ExactPoints result;
  EXPECT_EQ(result.assign(points, planes), "");
  return result;
}

struct Tally {
  std::uint64_t decided = 0, zero = 0, by_filter = 0;
};

// One family: every mix of kinds for five points, a few times.
constexpr int kKinds = 4, kMixes = kKinds * kKinds * kKinds * kKinds * kKinds;
void check_family(const Family& family, std::uint64_t seed, int rounds, Tally& tally) {
  Random random(seed);
  delmesher::predicates::families::Sample sample;
  fill(sample, family, 12, random);
  Predicates predicates(sample.store);
  const oracles::ExactPoints points = exact_points(sample.store);
  const oracles::KernelOpinion cgal(points);
  for (int round = 0; round < rounds; ++round) {
    for (int mix = 0; mix < kMixes; ++mix) {
      std::array<VertexId, 5> v;
      int digits = mix;
      for (VertexId& id : v) {
        id = sample.pick(static_cast<PointKind>(digits % kKinds), random);
        digits /= kKinds;
      }
      const auto [a, b, c, d, e] = v;
      const auto approximation = [&](VertexId i) -> const auto& {
        return sample.store.approximation(i);
      };
      const int orientation = oracles::exact::orient3d(points, a, b, c, d);
      ASSERT_EQ(predicates.orient3d(a, b, c, d), orientation) << family.name << mix;
      ASSERT_EQ(cgal.orient3d(a, b, c, d), orientation) << family.name << mix;
      const int quick = delmesher::predicates::filters::orient3d(
          approximation(a), approximation(b), approximation(c), approximation(d));
      if (quick != 0) {
        ASSERT_EQ(quick, orientation) << "a filter was certain and wrong";
      }
      const int sphere = oracles::exact::insphere(points, a, b, c, d, e);
      ASSERT_EQ(predicates.insphere(a, b, c, d, e), sphere) << family.name << mix;
      ASSERT_EQ(cgal.insphere(a, b, c, d, e), sphere) << family.name << mix;
      const int quick_sphere = delmesher::predicates::filters::insphere(
          approximation(a), approximation(b), approximation(c), approximation(d), approximation(e));
      if (quick_sphere != 0) {
        ASSERT_EQ(quick_sphere, sphere) << "a filter was certain and wrong";
      }
      ASSERT_EQ(predicates.dot_sign(a, b, c), oracles::exact::dot_sign(points, b, a, c));
      if (!oracles::exact::collinear(points, a, b, c)) {
        ASSERT_EQ(predicates.in_diametral_ball(a, b, c, d) > 0,
                  oracles::exact::in_diametral_ball(points, a, b, c, d))
            << family.name << mix;
      }
      tally.decided += 2;
      tally.zero += (orientation == 0) + (sphere == 0);
      tally.by_filter += (quick != 0) + (quick_sphere != 0);
      // An exchange of two points inverts the sign.
      ASSERT_EQ(predicates.orient3d(b, a, c, d), -orientation);
      ASSERT_EQ(predicates.insphere(a, b, d, c, e), -sphere);
    }
  }
}

TEST(PredicateLaws, AllMixesAgreeWithIntegersAndWithCgalAndFiltersAreNeverWrong) {
  Tally tally;
  const int rounds = samples::iterations(1);
  std::uint64_t seed = 42;
  for (const Family& family : delmesher::predicates::families::all()) {
    check_family(family, seed++, rounds, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.decided, 5000U);
  EXPECT_GT(tally.zero, tally.decided / 20) << "degenerate cases occur";
  EXPECT_GT(tally.by_filter, tally.decided / 20) << "filters answer";
}

// Appendix A: a sign is guaranteed if |value| > constant * (largest difference)^degree.
TEST(AppendixA, TheFiltersOfThePaperAreNeverWrong) {
  Random random(7);
  std::uint64_t certain = 0, uncertain = 0;
  const auto coordinate = [&] {
    switch (random.below(4)) {
      case 0:
        return random.exponent_between(-3, 3);
      case 1:
        return static_cast<double>(random.below(5)) * 0.1;
      case 2:
        return 1 + random.exponent_between(-52, -40);
      default:
        return random.unit();
    }
  };
  for (int n = 0; n < samples::iterations(4000); ++n) {
    double p[4][3];
    for (auto& point : p) {
      for (double& x : point) x = coordinate();
    }
    if (n % 3 == 0) std::copy_n(p[1], 2, p[2]);  // nearly the same place
    double u[3], v[3], w[3], largest = 0;
    mpq_class exact_u[3], exact_v[3], exact_w[3];
    for (int i = 0; i < 3; ++i) {
      u[i] = p[0][i] - p[3][i];
      v[i] = p[1][i] - p[3][i];
      w[i] = p[2][i] - p[3][i];
      exact_u[i] = mpq_class(p[0][i]) - mpq_class(p[3][i]);
      exact_v[i] = mpq_class(p[1][i]) - mpq_class(p[3][i]);
      exact_w[i] = mpq_class(p[2][i]) - mpq_class(p[3][i]);
      largest = std::max({largest, std::fabs(u[i]), std::fabs(v[i])});
    }
    const double d = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    const int exact_d =
        sgn(mpq_class(exact_u[0] * exact_v[0] + exact_u[1] * exact_v[1] + exact_u[2] * exact_v[2]));
    if (std::fabs(d) > 1.443289932012704e-15 * largest * largest) {
      ++certain;
      ASSERT_EQ((d > 0) - (d < 0), exact_d);
    } else {
      ++uncertain;
    }
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::fabs(w[i]));
    const auto cross = [](const auto* x, const auto* y, auto* z) {
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        z[i] = x[j] * y[k] - x[k] * y[j];
      }
    };
    double m[3], q[3];
    mpq_class exact_m[3], exact_q[3];
    cross(v, w, m);
    cross(u, w, q);
    cross(exact_v, exact_w, exact_m);
    cross(exact_u, exact_w, exact_q);
    const double h = m[0] * q[0] + m[1] * q[1] + m[2] * q[2];
    const int exact_h =
        sgn(mpq_class(exact_m[0] * exact_q[0] + exact_m[1] * exact_q[1] + exact_m[2] * exact_q[2]));
    if (std::fabs(h) > 1.332267629550189e-14 * largest * largest * largest * largest) {
      ++certain;
      ASSERT_EQ((h > 0) - (h < 0), exact_h);
    } else {
      ++uncertain;
    }
  }
  EXPECT_GT(certain, 100U);
  EXPECT_GT(uncertain, 10U) << "the constants were put to the test";
}

}  // namespace
}  // namespace tetproof::predicate_property_test
