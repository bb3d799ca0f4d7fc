// Random numbers that are the same everywhere, unlike the distributions of the standard library.
#pragma once

#include <cmath>
#include <cstdint>

namespace tetproof {

// SplitMix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  // In [0, n); n > 0.
  std::uint64_t below(std::uint64_t n) { return bits() % n; }
  // In [low, high].
  int integer(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint64_t>(high - low + 1)));
  }
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  bool chance(double share) { return unit() < share; }
  double sign() { return chance(0.5) ? 1 : -1; }
  // From 1 down to 2^-bits, evenly in the exponent; half of the time an exact power of two.
  double tiny(int bits_below_one) {
    const double power = std::ldexp(1.0, -integer(1, bits_below_one));
    return chance(0.5) ? power : power * (1 + unit());
  }
  // The thickness of a wide part. As tiny(), but thick enough for few elements or thin enough for
  // the mesher's filter (about 2^-13 of the diagonal): in between any mesh of good shape has
  // millions of elements.
  double thin(int bits_below_one) {
    if (bits_below_one < 16 || chance(0.3)) return tiny(bits_below_one < 5 ? bits_below_one : 5);
    const double power = std::ldexp(1.0, -integer(16, bits_below_one));
    return chance(0.5) ? power : power * (1 + unit());
  }

 private:
  std::uint64_t state_;
};

}  // namespace tetproof
