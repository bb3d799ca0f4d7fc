// Every predicate and every stage against rational arithmetic, on every mix of kinds of points.
#include "mesher/predicates/predicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "mesher/predicates/exact_point.h"
#include "mesher/predicates/point_families.h"
#include "mesher/predicates/rational_reference.h"
#include "mesher/predicates/stages.h"

namespace delmesher::predicates::predicates_test {
namespace {

using families::Family;
using families::Random;
using families::Sample;

// How often each stage was certain, over a test: proves that the comparison is not vacuous.
struct StageCounts {
  std::array<std::uint64_t, 3> filter{};  // by sign: -1, 0, +1
  std::array<std::uint64_t, 3> extended{};
  std::array<std::uint64_t, 3> exact{};
  std::array<std::uint64_t, 6> limbs{};  // fixed integers of 1 to 4 limbs, [5]: larger

  static std::size_t slot(int sign) { return static_cast<std::size_t>(sign + 1); }
};

class PredicatesOnFamilies : public ::testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    family_ = families::all()[GetParam()];
    families::fill(sample_, family_, 12, random_);
    for (VertexId v = 0; v < sample_.store.size(); ++v) {
      exact_.push_back(reference::point(sample_.store, v));
    }
  }

  // Points with the kinds given by the digits of `mix` to base 4.
  std::array<VertexId, 5> pick(int count, int mix) {
    std::array<VertexId, 5> v{};
    for (int i = 0; i < count; ++i, mix /= 4) {
      v[static_cast<std::size_t>(i)] = sample_.pick(static_cast<PointKind>(mix % 4), random_);
    }
    return v;
  }

  std::array<reference::Point, 5> rational(const std::array<VertexId, 5>& v) const {
    std::array<reference::Point, 5> p;
    for (std::size_t i = 0; i < 5; ++i) p[i] = exact_[v[i]];
    return p;
  }

  // All stages of a polynomial agree with the reference wherever they are certain.
  template <class Polynomial>
  void check_stages(const Polynomial& polynomial, const std::array<VertexId, 5>& v, int expected) {
    const PointStore& store = sample_.store;
    const int filter = stages::filter(store, polynomial, v.data());
    if (filter != kUnknownSign) {
      ASSERT_EQ(filter, expected) << "filter";
      ++counts_.filter[StageCounts::slot(filter)];
    }
    const int extended = stages::extended(store, polynomial, v.data());
    if (extended != kUnknownSign) {
      ASSERT_EQ(extended, expected) << "extended";
      ++counts_.extended[StageCounts::slot(extended)];
    }
    const stages::ExactArguments arguments(store, v.data(), Polynomial::kPoints);
    ASSERT_EQ(stages::exact(arguments, polynomial), expected) << "exact";
    ASSERT_EQ(stages::big_integers(arguments, polynomial), expected) << "big integers";
    ++counts_.exact[StageCounts::slot(expected)];
    ++counts_.limbs[static_cast<std::size_t>(std::min(stages::limbs_needed(arguments), 5))];
  }

  Random random_{GetParam() + 1};
  Family family_;
  Sample sample_;
  std::vector<reference::Point> exact_;
  StageCounts counts_;
};

TEST_P(PredicatesOnFamilies, Orient3d) {
  Predicates predicates(sample_.store);
  for (int round = 0; round < 2; ++round) {
    for (int mix = 0; mix < 256; ++mix) {
      const auto v = pick(4, mix);
      const int expected = reference::orient3d(rational(v).data());
      check_stages(polynomials::Orient3d{}, v, expected);
      ASSERT_EQ(predicates.orient3d(v[0], v[1], v[2], v[3]), expected);
      ASSERT_EQ(predicates.orient3d(v[1], v[0], v[2], v[3]), -expected);
      ASSERT_EQ(predicates.orient3d(v[0], v[1], v[3], v[2]), -expected);
    }
  }
}

TEST_P(PredicatesOnFamilies, Orient2d) {
  Predicates predicates(sample_.store);
  for (int round = 0; round < 2; ++round) {
    for (int mix = 0; mix < 64; ++mix) {
      const auto v = pick(3, mix);
      for (int axis = 0; axis < 3; ++axis) {
        const int expected = reference::orient2d(axis, rational(v).data());
        check_stages(polynomials::Orient2d{axis}, v, expected);
        ASSERT_EQ(predicates.orient2d(axis, v[0], v[1], v[2]), expected);
        ASSERT_EQ(predicates.orient2d(axis, v[1], v[0], v[2]), -expected);
      }
    }
  }
}

TEST_P(PredicatesOnFamilies, Insphere) {
  Predicates predicates(sample_.store);
  for (int round = 0; round < 1; ++round) {
    for (int mix = 0; mix < 1024; ++mix) {
      const auto v = pick(5, mix);
      const int expected = reference::insphere(rational(v).data());
      check_stages(polynomials::Insphere{}, v, expected);
      ASSERT_EQ(predicates.insphere(v[0], v[1], v[2], v[3], v[4]), expected);
      ASSERT_EQ(predicates.insphere(v[4], v[1], v[2], v[3], v[0]), -expected);
      const int perturbed = predicates.insphere_perturbed(v[0], v[1], v[2], v[3], v[4]);
      if (expected != 0) {
        ASSERT_EQ(perturbed, expected);
      }
    }
  }
}

TEST_P(PredicatesOnFamilies, DotAndOrder) {
  Predicates predicates(sample_.store);
  for (int round = 0; round < 1; ++round) {
    for (int mix = 0; mix < 256; ++mix) {
      const auto v = pick(4, mix);
      const auto p = rational(v);
      using reference::dot;
      using reference::minus;
      const int sign = sgn(dot(minus(p[0], p[1]), minus(p[2], p[1])));
      check_stages(polynomials::Dot{}, v, sign);
      ASSERT_EQ(predicates.dot_sign(v[0], v[1], v[2]), sign);
      const int differences = sgn(dot(minus(p[1], p[0]), minus(p[3], p[2])));
      check_stages(polynomials::DotDifference{}, v, differences);
      ASSERT_EQ(predicates.dot_difference_sign(v[0], v[1], v[2], v[3]), differences);
      int order = 0;
      for (std::size_t i = 0; i < 3 && order == 0; ++i) order = sgn(mpq_class(p[0][i] - p[1][i]));
      ASSERT_EQ(predicates.compare_xyz(v[0], v[1]), order);
    }
  }
}

TEST_P(PredicatesOnFamilies, Balls) {
  Predicates predicates(sample_.store);
  for (int round = 0; round < 1; ++round) {
    for (int mix = 0; mix < 256; ++mix) {
      const auto v = pick(4, mix);
      const auto p = rational(v);
      if (reference::collinear(p[0], p[1], p[2])) continue;
      const int expected = reference::in_diametral_ball(p.data());
      check_stages(polynomials::InDiametralBall{}, v, expected);
      ASSERT_EQ(predicates.in_diametral_ball(v[0], v[1], v[2], v[3]), expected);
    }
  }
}

TEST_P(PredicatesOnFamilies, Angles) {
  Predicates predicates(sample_.store);
  const std::array<double, 6> thresholds = {
      cosine_squared(90), cosine_squared(60), cosine_squared(45), cosine_squared(20), 1.0, 1e-310};
  for (int mix = 0; mix < 256; ++mix) {
    const auto v = pick(4, mix);
    const auto p = rational(v);
    const int dihedral = reference::dihedral_sign(p.data());
    check_stages(polynomials::Dihedral{}, v, dihedral);
    ASSERT_EQ(predicates.dihedral_sign(v[0], v[1], v[2], v[3]), dihedral);
    for (const double t : thresholds) {
      const bool angle =
          reference::below(reference::minus(p[0], p[1]), reference::minus(p[2], p[1]), t);
      ASSERT_EQ(predicates.angle_below(v[0], v[1], v[2], t), angle);
      ASSERT_EQ(predicates.dihedral_below(v[0], v[1], v[2], v[3], t),
                reference::dihedral_below(p.data(), t));
      ASSERT_EQ(predicates.bends_below(v[0], v[1], v[2], v[3], t),
                reference::bends_below(p.data(), t));
      ASSERT_EQ(predicates.edge_plane_angle_below(v[0], v[1], v[2], v[3], t),
                reference::edge_plane_angle_below(p.data(), t));
    }
  }
}

// The three coordinates of the caches agree with the definition.
TEST_P(PredicatesOnFamilies, CachedCoordinates) {
  const PointStore& store = sample_.store;
  for (VertexId v = 0; v < store.size(); ++v) {
    ExactPosition cached;
    store.exact(v, cached);
    const RationalPoint point = exact_point(store, v);
    mpz_class denominator;
    mpz_import(denominator.get_mpz_t(), point.denominator.used(), -1, 8, 0, 0,
               point.denominator.data());
    ASSERT_TRUE(mpz_odd_p(denominator.get_mpz_t()));
    ASSERT_EQ(cached.denominator.size != 0, denominator != 1);
    const Approximation near = store.approximation(v);
    const Approximation rest = store.remainder(v);
    const std::array<double, 3> nearest = {near.x, near.y, near.z};
    const std::array<double, 3> remainder = {rest.x, rest.y, rest.z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const ExactCoordinate& x = cached.coordinate[axis];
      mpz_class mantissa;
      mpz_import(mantissa.get_mpz_t(), static_cast<std::size_t>(std::abs(x.size)), -1, 8, 0, 0,
                 x.limbs);
      mpq_class value = x.size < 0 ? mpz_class(-mantissa) : mantissa;
      if (x.exponent >= 0) {
        value *= mpz_class(1) << static_cast<unsigned>(x.exponent);
      } else {
        value /= mpz_class(1) << static_cast<unsigned>(-x.exponent);
      }
      const Dyadic& y = point.numerator[axis];
      ASSERT_EQ(y.exponent, x.exponent);
      ASSERT_EQ(y.sign(), sgn(value));
      ASSERT_TRUE(std::ranges::equal(std::span(y.mantissa.data(), y.mantissa.used()),
                                     std::span(x.limbs, y.mantissa.used())));
      value /= denominator;
      ASSERT_EQ(value, exact_[v][axis]);
      if (!std::isfinite(nearest[axis])) {
        ASSERT_FALSE(std::isfinite(near.error));
        continue;
      }
      const mpq_class off = abs(value - mpq_class(nearest[axis]));
      ASSERT_LE(off, std::isfinite(near.error) ? mpq_class(near.error) : off);
      // Nearest: not farther than the neighbouring doubles.
      for (const double towards : {-HUGE_VAL, HUGE_VAL}) {
        const double other = std::nextafter(nearest[axis], towards);
        if (std::isfinite(other)) {
          ASSERT_LE(off, mpq_class(abs(value - mpq_class(other))));
        }
      }
      if (std::isfinite(rest.error)) {
        ASSERT_LE(mpq_class(abs(value - mpq_class(nearest[axis]) - mpq_class(remainder[axis]))),
                  mpq_class(rest.error));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Families, PredicatesOnFamilies, ::testing::Range<std::size_t>(0, families::all().size()),
    [](const ::testing::TestParamInfo<std::size_t>& parameter) {
      std::string name = families::all()[parameter.param].name;
      std::replace_if(
          name.begin(), name.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return name;
    });

}  // namespace
}  // namespace delmesher::predicates::predicates_test
