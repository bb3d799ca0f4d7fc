#include "fuzz/entry.h"

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "corpus/generators/certify.h"
#include "corpus/generators/generate.h"
#include "mesher/io/parse_surface.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {

std::optional<delmesher::Surface> parse(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto read = delmesher::io::parse_surface(text, "input.off");
  if (!read.ok() || read.format != "OFF") return {};
  if (read.surface.triangles.empty() || read.surface.triangles.size() > kLargestSurface) return {};
  return std::move(read.surface);
}

void report(const Finding& finding, const delmesher::Surface* surface) {
  std::fprintf(stderr, "FINDING %s\n", finding.c_str());
  if (surface != nullptr) std::fputs(to_off(*surface, finding, true).c_str(), stderr);
  std::abort();
}

int on_valid_surface(const std::uint8_t* data, std::size_t size,
                     Finding (*property)(const delmesher::Surface&)) {
  executed();
  const auto surface = parse(data, size);
  if (!surface || !certified_valid(*surface)) return 0;
  if (const Finding finding = property(*surface); !finding.empty()) report(finding, &*surface);
  return 0;
}

int on_any_surface(const std::uint8_t* data, std::size_t size,
                   Finding (*property)(const delmesher::Surface&)) {
  executed();
  const auto surface = parse(data, size);
  if (!surface) return 0;
  if (const Finding finding = property(*surface); !finding.empty()) report(finding, &*surface);
  return 0;
}

int on_bytes(const std::uint8_t* data, std::size_t size, Finding (*property)(Bytes)) {
  executed();
  if (const Finding finding = property({data, size}); !finding.empty()) report(finding);
  return 0;
}

int on_text(const std::uint8_t* data, std::size_t size, Finding (*property)(const std::string&)) {
  executed();
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (const Finding finding = property(text); !finding.empty()) report(finding);
  return 0;
}

namespace {

// x with its exponent modulo `most`.
double narrowed(double x, int most) {
  return x == 0 ? x : std::ldexp(x, std::ilogb(x) % most - std::ilogb(x));
}

}  // namespace

double Bytes::coordinate() {
  switch (below(8)) {
    case 0:
    case 1:
      return last_ = static_cast<double>(static_cast<std::int8_t>(byte()) / 16);
    case 2:
      return last_ = static_cast<std::int8_t>(byte()) / 32.0;
    case 3:
      return last_ = static_cast<std::int8_t>(byte()) * 0.1;
    case 4: {
      const int way = byte();
      // The neighbours of 0 are the smallest numbers of all, which are not of one scale with
      // others.
      if (last_ == 0 && most_exponent_ > 0) {
        return last_ = std::ldexp((way & 1) != 0 ? 1 : -1, -most_exponent_);
      }
      if (!spread_) return last_ = std::nextafter(last_, (way & 1) != 0 ? DBL_MAX : -DBL_MAX);
      const double step = std::ldexp(last_, -8 - (way >> 1) % 32);
      return last_ = (way & 1) != 0 ? last_ + step : last_ - step;
    }
    case 5:
      return last_;
    case 6: {
      const int power = static_cast<std::int8_t>(byte());
      return last_ = std::ldexp(static_cast<std::int8_t>(byte()),
                                most_exponent_ > 0 ? power * most_exponent_ / 128 : power);
    }
    default: {
      const double any = std::bit_cast<double>(word());
      last_ = std::isfinite(any) ? any : 1;
      return last_ = most_exponent_ > 0 ? narrowed(last_, most_exponent_) : last_;
    }
  }
}

double Bytes::parameter() {
  switch (below(3)) {
    case 0:
      return byte() / 16 / 16.0;
    case 1:
      return std::ldexp(byte(), -8 - static_cast<int>(below(50)));
    default:
      return static_cast<double>(word() >> 11) * 0x1p-53;
  }
}

}  // namespace tetproof::fuzz
