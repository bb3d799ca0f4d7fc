#include "mesher/surface/carrier_key.h"

#include <cmath>

#include "mesher/arithmetic/words.h"

namespace delmesher::surface {
namespace {

using Residue = std::uint64_t;
using Residue3 = std::array<Residue, 3>;

constexpr Residue kPrime = (Residue{1} << 61) - 1;

Residue add(Residue a, Residue b) {
  const Residue sum = a + b;
  return sum >= kPrime ? sum - kPrime : sum;
}

Residue subtract(Residue a, Residue b) {
  return a >= b ? a - b : a + kPrime - b;
}

Residue multiply(Residue a, Residue b) {
  const DoubleWord product = multiply_add(a, b, 0, 0);
  return add(product.low & kPrime, product.high << 3U | product.low >> 61U);
}

// Fermat: a^(p-2).
Residue inverse(Residue a) {
  Residue result = 1;
  for (Residue exponent = kPrime - 2; exponent != 0; exponent >>= 1) {
    if ((exponent & 1) != 0) result = multiply(result, a);
    a = multiply(a, a);
  }
  return result;
}

// 2^61 = 1 modulo the prime, so a power of two is a rotation of 61 bits.
Residue residue(double x) {
  int exponent = 0;
  const double fraction = std::frexp(std::fabs(x), &exponent);
  const auto mantissa = static_cast<Residue>(std::ldexp(fraction, 53));
  const int shift = (((exponent - 53) % 61) + 61) % 61;
  const Residue value = multiply(mantissa, Residue{1} << shift);
  return std::signbit(x) && value != 0 ? kPrime - value : value;
}

Residue3 residues(const Vec3& p) {
  return {residue(p[0]), residue(p[1]), residue(p[2])};
}

Residue3 subtract(const Residue3& a, const Residue3& b) {
  return {subtract(a[0], b[0]), subtract(a[1], b[1]), subtract(a[2], b[2])};
}

Residue3 cross(const Residue3& a, const Residue3& b) {
  Residue3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    result[i] = subtract(multiply(a[j], b[k]), multiply(a[k], b[j]));
  }
  return result;
}

CarrierKey normalized(CarrierKey key) {
  Residue factor = 0;
  for (Residue& c : key.coordinates) {
    if (factor == 0 && c != 0) factor = inverse(c);
    c = multiply(c, factor);
  }
  return key;
}

}  // namespace

CarrierKey plane_key(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Residue3 p = residues(a);
  const Residue3 n = cross(subtract(residues(b), p), subtract(residues(c), p));
  const Residue offset = add(add(multiply(n[0], p[0]), multiply(n[1], p[1])), multiply(n[2], p[2]));
  return normalized({{n[0], n[1], n[2], offset, 0, 0}});
}

CarrierKey line_key(const Vec3& a, const Vec3& b) {
  const Residue3 p = residues(a);
  const Residue3 d = subtract(residues(b), p);
  const Residue3 m = cross(p, d);
  return normalized({{d[0], d[1], d[2], m[0], m[1], m[2]}});
}

}  // namespace delmesher::surface
