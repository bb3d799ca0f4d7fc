#include "mesher/planar/resolution.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "mesher/geometry/vector.h"

namespace delmesher::planar {
namespace {

using predicates::Vec3;

// The shortest decimal that is read as the number again: an integer of so many digits, times a
// power of ten.
struct Decimal {
  int digits, power;

  int first() const { return power + digits - 1; }
};

template <class Real>
Decimal shortest(Real x) {
  std::array<char, 32> text{};
  const char* const end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::scientific).ptr;
  const std::string_view all(text.data(), static_cast<std::size_t>(end - text.data()));
  const std::size_t e = all.find('e');
  const auto digits = static_cast<int>(
      std::ranges::count_if(all.substr(0, e), [](char c) { return c >= '0' && c <= '9'; }));
  int exponent = 0;
  const std::string_view number = all.substr(all[e + 1] == '+' ? e + 2 : e + 1);
  std::from_chars(number.data(), number.data() + number.size(), exponent);
  return {digits, exponent - digits + 1};
}

// The double nearest to 10^n on every machine: std::pow is rounded as each library likes.
double power_of_ten(int n) {
  std::array<char, 16> text = {'1', 'e'};
  const char* const end = std::to_chars(text.data() + 2, text.data() + text.size(), n).ptr;
  double power = 0;
  std::from_chars(text.data(), end, power);
  return power;
}

// Without a conversion to float and back, of which gcc 12 at -O3 leaves out some.
bool in_single_precision(double x) {
  int exponent = 0;
  const double integer = std::ldexp(std::frexp(x, &exponent), 24);
  return integer == std::trunc(integer) && exponent <= 128 && (x == 0 || exponent > -126);
}

class Coordinates {
 public:
  explicit Coordinates(const Surface& surface) : surface_(surface) {
    for (const Vec3& v : surface.vertices) {
      for (std::size_t i = 0; i < 3; ++i) {
        largest_[i] = std::max(largest_[i], std::fabs(v[i]));
        single_ = single_ && in_single_precision(v[i]);
      }
    }
  }

  // Units in the last place by axis, 0 for finer ones.
  Vec3 unit_of_decimals() const {
    constexpr int kOfDoubles = 16, kOfSingles = 8;  // digits that numbers of any origin have
    constexpr int kPrinted = 6;                     // fewest that programs print
    int digits = 0, power = 0;
    for (const Vec3& v : surface_.vertices) {
      for (const double x : v) {
        if (x == 0) continue;
        const Decimal d = decimal(x);
        digits = std::max(digits, d.digits);
        power = std::min(power, d.power);
      }
      if (digits >= (single_ ? kOfSingles : kOfDoubles)) return {0, 0, 0};
    }
    Vec3 unit{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      if (power == 0 || largest_[i] == 0) continue;
      const int last = decimal(largest_[i]).first() - digits + 1;
      unit[i] = power_of_ten(digits < kPrinted ? power : std::max(power, last));
    }
    return unit;
  }

  Vec3 unit_of_precision() const {
    Vec3 unit{0, 0, 0};
    for (std::size_t i = 0; i < 3 && single_; ++i) {
      if (largest_[i] > 0) unit[i] = std::ldexp(1.0, std::ilogb(largest_[i]) - 23);
    }
    return unit;
  }

 private:
  Decimal decimal(double x) const {
    return single_ ? shortest(static_cast<float>(x)) : shortest(x);
  }

  const Surface& surface_;
  Vec3 largest_{0, 0, 0};
  bool single_ = true;
};

}  // namespace

double rounding_of_coordinates(const Surface& surface, double most) {
  const Coordinates coordinates(surface);
  const Vec3 precision = coordinates.unit_of_precision();
  Vec3 unit = coordinates.unit_of_decimals();
  for (std::size_t i = 0; i < 3; ++i) unit[i] = std::max(unit[i], precision[i]);
  for (const Vec3& each : {unit, precision}) {
    const double rounding = norm(each) / 2;
    if (rounding <= most) return rounding;
  }
  return 0;
}

}  // namespace delmesher::planar
