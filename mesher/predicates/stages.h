// The stages of the predicates, each callable alone. A stage returns -1, 0, +1 if it is certain,
// kUnknownSign otherwise; the exact stage is always certain.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/arithmetic/big_integer.h"
#include "mesher/arithmetic/bounded.h"
#include "mesher/arithmetic/dyadic.h"
#include "mesher/arithmetic/fixed_integer.h"
#include "mesher/predicates/points.h"
#include "mesher/predicates/polynomials.h"

// In the namespace of the numbers, where the polynomials find it by its arguments.
namespace delmesher::arithmetic {

// Positive multiples of s - constant * t, see AngleExcess.
inline Bounded minus_multiple(const Bounded& s, double constant, const Bounded& t) {
  return s - Bounded{constant, 0} * t;
}

inline BoundedPair minus_multiple(const BoundedPair& s, double constant, const BoundedPair& t) {
  return s - BoundedPair{constant, 0, 0} * t;
}

// The constant must be in [0, 1].
inline BigInteger minus_multiple(const BigInteger& s, double constant, const BigInteger& t) {
  const DoubleParts parts = decompose(constant);
  if (parts.magnitude == 0) return s;
  const BigInteger factor(&parts.magnitude, 1, false);
  return (s << static_cast<std::size_t>(-parts.exponent)) - factor * t;
}

}  // namespace delmesher::arithmetic

namespace delmesher::predicates {

namespace stages {

using polynomials::Triple;

inline Triple<Bounded> bounded_point(const PointStore& points, VertexId v) {
  const Approximation& a = points.approximation(v);
  return {{a.x, a.error}, {a.y, a.error}, {a.z, a.error}};
}

inline Triple<BoundedPair> bounded_pair_point(const PointStore& points, VertexId v) {
  const Approximation& a = points.approximation(v);
  const Approximation r = points.remainder(v);
  return {{a.x, r.x, r.error}, {a.y, r.y, r.error}, {a.z, r.z, r.error}};
}

// Doubles, exactly.
inline Triple<BoundedPair> exact_pairs(const Vec3& a) {
  return {{a[0], 0, 0}, {a[1], 0, 0}, {a[2], 0, 0}};
}

// Doubles with running error bounds.
template <class Polynomial>
int filter(const PointStore& points, const Polynomial& polynomial, const VertexId* ids) {
  Triple<Bounded> p[Polynomial::kPoints];
  for (int i = 0; i < Polynomial::kPoints; ++i) p[i] = bounded_point(points, ids[i]);
  return polynomial(p).sign();
}

// Double-doubles with running error bounds.
template <class Polynomial>
int extended(const PointStore& points, const Polynomial& polynomial, const VertexId* ids) {
  Triple<BoundedPair> p[Polynomial::kPoints];
  for (int i = 0; i < Polynomial::kPoints; ++i) p[i] = bounded_pair_point(points, ids[i]);
  return polynomial(p).sign();
}

// The exact coordinates of up to five points, and their common scale.
struct ExactArguments {
  ExactPosition point[5];
  int count = 0;
  std::int32_t exponent = 0;  // every coordinate is a multiple of 2^exponent
  std::int32_t bits = 0;      // and below 2^(exponent + bits)
  // For each point the factor of its numerators with which all points have one denominator, which
  // changes no sign; empty if all denominators are 1.
  std::vector<BigInteger> factor;

  ExactArguments(const PointStore& points, const VertexId* ids, int n);
  explicit ExactArguments(std::span<const Vec3> points);

 private:
  void find_scale();
  void find_factors();
};

inline BigInteger integer_at_scale(const ExactCoordinate& x, std::int32_t exponent) {
  const bool negative = x.size < 0;
  const auto n = static_cast<std::size_t>(negative ? -x.size : x.size);
  if (n == 0) return BigInteger();
  return BigInteger(x.limbs, n, negative, static_cast<std::size_t>(x.exponent - exponent));
}

// Integers of any size.
template <class Polynomial>
int big_integers(const ExactArguments& arguments, const Polynomial& polynomial) {
  Triple<BigInteger> p[Polynomial::kPoints];
  for (int i = 0; i < Polynomial::kPoints; ++i) {
    const auto& x = arguments.point[i].coordinate;
    p[i] = {integer_at_scale(x[0], arguments.exponent), integer_at_scale(x[1], arguments.exponent),
            integer_at_scale(x[2], arguments.exponent)};
    if (arguments.factor.empty()) continue;
    const BigInteger& factor = arguments.factor[static_cast<std::size_t>(i)];
    p[i] = {p[i].x * factor, p[i].y * factor, p[i].z * factor};
  }
  return polynomial(p).sign();
}

inline constexpr int kLargestFixed = 4;

template <int N>
FixedInteger<N> fixed_at_scale(const ExactCoordinate& x, std::int32_t exponent) {
  const bool negative = x.size < 0;
  const int size = negative ? -x.size : x.size;
  if constexpr (N == 1) {
    if (size == 0) return {};
    const std::uint64_t magnitude = x.limbs[0] << (x.exponent - exponent);
    return {{negative ? -magnitude : magnitude}};
  } else {
    return fixed_integer<N>(x.limbs, size, negative, x.exponent - exponent);
  }
}

// Integers of N limbs for differences of coordinates.
template <int N, class Polynomial>
int fixed_integers(const ExactArguments& arguments, const Polynomial& polynomial) {
  Triple<FixedInteger<N>> p[Polynomial::kPoints];
  for (int i = 0; i < Polynomial::kPoints; ++i) {
    const auto& x = arguments.point[i].coordinate;
    p[i] = {fixed_at_scale<N>(x[0], arguments.exponent),
            fixed_at_scale<N>(x[1], arguments.exponent),
            fixed_at_scale<N>(x[2], arguments.exponent)};
  }
  return polynomial(p).sign();
}

// Number of limbs that hold differences of the coordinates, with the room that
// polynomials.h asks for: differences are below 2^(bits + 1) =: 2^B, and B <= 64 N - 2.
inline int limbs_needed(const ExactArguments& arguments) {
  return (arguments.bits + 3 + 63) / 64;
}

template <class Polynomial>
bool fits_fixed(const ExactArguments& arguments) {
  return Polynomial::kFixedSize && arguments.factor.empty() &&
         limbs_needed(arguments) <= kLargestFixed;
}

template <class Polynomial>
bool exact_is_cheap(const ExactArguments& arguments) {
  return fits_fixed<Polynomial>(arguments) && limbs_needed(arguments) <= 3;
}

template <class Polynomial>
int exact(const ExactArguments& arguments, const Polynomial& polynomial) {
  if constexpr (Polynomial::kFixedSize) {
    switch (fits_fixed<Polynomial>(arguments) ? limbs_needed(arguments) : 0) {
      case 1:
        return fixed_integers<1>(arguments, polynomial);
      case 2:
        return fixed_integers<2>(arguments, polynomial);
      case 3:
        return fixed_integers<3>(arguments, polynomial);
      case kLargestFixed:
        return fixed_integers<kLargestFixed>(arguments, polynomial);
      default:
        break;
    }
  }
  return big_integers(arguments, polynomial);
}

template <class Polynomial>
int exact(const PointStore& points, const Polynomial& polynomial, const VertexId* ids) {
  return exact(ExactArguments(points, ids, Polynomial::kPoints), polynomial);
}

}  // namespace stages
}  // namespace delmesher::predicates
