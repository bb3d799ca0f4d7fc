// The stages of the predicates, each callable alone. A stage returns -1, 0, +1 if it is certain,
// kUnknownSign otherwise; the exact stage is always certain.
#pragma once

#include "mesher/arithmetic/big_integer.h"
#include "mesher/arithmetic/bounded.h"
#include "mesher/arithmetic/dyadic.h"
#include "mesher/predicates/points.h"
#include "mesher/predicates/polynomials.h"

namespace delmesher {

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

// The exact coordinates of up to five points and what they have in common.
struct ExactArguments {
  ExactPosition point[5];
  int count = 0;
  std::int32_t exponent = 0;  // every coordinate is a multiple of 2^exponent
  std::int32_t bits = 0;      // and below 2^(exponent + bits)

  ExactArguments(const PointStore& points, const VertexId* ids, int n);
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
  }
  return polynomial(p).sign();
}

template <class Polynomial>
int exact(const PointStore& points, const Polynomial& polynomial, const VertexId* ids) {
  const ExactArguments arguments(points, ids, Polynomial::kPoints);
  return big_integers(arguments, polynomial);
}

}  // namespace stages
}  // namespace delmesher
