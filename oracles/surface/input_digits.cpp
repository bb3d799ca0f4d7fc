#include "oracles/surface/input_digits.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "oracles/base/box.h"
#include "oracles/surface/edge_noise.h"

namespace tetproof::oracles {
namespace {

std::string printed(double x, std::chars_format format, int places) {
  std::array<char, 512> text{};
  return {text.begin(), std::to_chars(text.begin(), text.end(), x, format, places).ptr};
}

template <class Real>
bool is_read_from(Real x, const std::string& text) {
  Real read = 0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  return read == x;
}

// Decimals that all numbers so far are read from again.
class Digits {
 public:
  // No more than `most_places` behind the point and `most_digits` in all are looked for.
  Digits(bool single, int most_places, int most_digits)
      : single_(single), most_places_(most_places), most_digits_(most_digits) {}

  void add(double x) {
    const auto reads = [&](std::chars_format format, int places) {
      const std::string text = printed(x, format, places);
      return single_ ? is_read_from(static_cast<float>(x), text) : is_read_from(x, text);
    };
    while (places_ <= most_places_ && !reads(std::chars_format::fixed, places_)) ++places_;
    while (digits_ <= most_digits_ && !reads(std::chars_format::scientific, digits_ - 1)) ++digits_;
  }
  bool many() const { return digits_ > most_digits_; }
  int places() const { return places_; }
  int digits() const { return digits_; }

 private:
  bool single_;
  int most_places_, most_digits_;
  int places_ = 0, digits_ = 1;
};

// Is it a float, not below the normal ones?
bool has_24_bits(double x) {
  if (x == 0) return true;
  const int power = std::ilogb(x);
  if (power < -126 || power > 127) return false;  // nor if it is not finite
  const double integer = std::scalbn(x, 23 - power);
  return std::nearbyint(integer) == integer;
}

struct Extent : Box {
  bool single = true;

  explicit Extent(std::span<const Position> vertices) : Box(box_of(vertices)) {
    for (const Position& p : vertices) single = single && std::ranges::all_of(p, has_24_bits);
  }
};

using Units = std::array<double, 3>;

Units decimal_units(std::span<const Position> vertices, const Extent& extent) {
  // Finer places are of no account.
  const int fine = static_cast<int>(std::ceil(12 - std::log10(extent.diagonal())));
  Digits needed(extent.single, std::max(fine, 0), extent.single ? 7 : 15);
  for (const Position& p : vertices) {
    for (const double x : p) needed.add(x);
    if (needed.many()) return {};
  }
  Units units{};
  if (needed.places() == 0) return units;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(extent.largest(i) > 0)) continue;
    units[i] = std::pow(10, -needed.places());
    if (needed.digits() < 6) continue;
    // Printed as all are: in single precision 0.01 is slightly less than that.
    const std::string text =
        printed(extent.largest(i), std::chars_format::scientific, needed.digits() - 1);
    const int exponent = std::stoi(text.substr(text.find('e') + 1));
    units[i] = std::max(units[i], std::pow(10, exponent - needed.digits() + 1));
  }
  return units;
}

Units single_units(const Extent& extent) {
  Units units{};
  for (std::size_t i = 0; i < 3 && extent.single; ++i) {
    if (extent.largest(i) > 0) units[i] = std::ldexp(1, std::ilogb(extent.largest(i)) - 23);
  }
  return units;
}

constexpr double kAlways = 0x1p-18;

// Six times what rounding to the last place moves a vertex by; 0 if nothing is known of it.
double share_in_units(std::span<const Position> vertices) {
  constexpr double kMost = 0x1p-12, kSlack = 1e-9;
  const Extent extent(vertices);
  if (!(extent.diagonal() > 0) || !std::isfinite(extent.diagonal())) return 0;
  const Units single = single_units(extent);
  Units units = decimal_units(vertices, extent);
  for (std::size_t i = 0; i < 3; ++i) units[i] = std::max(units[i], single[i]);
  for (const Units& u : {units, single}) {
    const double share = 3 * std::hypot(u[0], u[1], u[2]) / extent.diagonal();
    if (share <= kMost * (1 + kSlack)) return share;
  }
  return 0;
}

// In units of a power of two just above the largest coordinate, if that is of no ordinary size.
// Empty if it is, or if a number would lose digits.
std::vector<Position> in_own_units(std::span<const Position> vertices) {
  constexpr int kOrdinary = 64;
  const double largest = box_of(vertices).largest();
  if (!(largest > 0) || !std::isfinite(largest)) return {};
  const int exponent = std::ilogb(largest) + 1;
  if (std::abs(exponent) <= kOrdinary) return {};
  std::vector<Position> scaled(vertices.begin(), vertices.end());
  for (Position& p : scaled) {
    for (double& x : p) {
      const double given = x;
      x = std::ldexp(given, -exponent);
      if (std::ldexp(x, exponent) != given) return {};
    }
  }
  return scaled;
}

// In the units given, and in those of its own.
std::array<double, 2> shares(std::span<const Position> vertices) {
  return {share_in_units(vertices), share_in_units(in_own_units(vertices))};
}

}  // namespace

double automatic_planar_share(std::span<const Position> vertices) {
  return std::max(kAlways, std::ranges::max(shares(vertices)));
}

double automatic_planar_share(const Polyhedron& surface) {
  constexpr double kOfNoise = 16, kResolved = 1.25 / 6, kFlat = 0x1p-22;
  const std::array<double, 2> known = shares(surface.vertices);
  double share = std::max(kAlways, std::ranges::max(known));
  const std::set<double> resolved = {0.0, std::max(kResolved * known[0], kFlat),
                                     std::max(kResolved * known[1], kFlat)};
  for (const double least : resolved) {
    share = std::max(share, kOfNoise * noise_of_edges(surface, least));
  }
  return share;
}

}  // namespace tetproof::oracles
