// Series can be distinguished: by colour, seen with any cones, and by pattern. Colours are measured
// here from their definitions (sRGB, CIELAB, WCAG 2), not by the code that chose them.
#include "reports/series_style.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <tuple>

namespace tetproof::series_style_test {
namespace {

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

Triple times(const Matrix& m, const Triple& x) {
  Triple y{};
  for (std::size_t i = 0; i < 3; ++i) y[i] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
  return y;
}

Triple linear(std::uint32_t colour) {
  Triple result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = static_cast<double>(colour >> (16 - 8 * i) & 255) / 255;
    result[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return result;
}

constexpr Matrix kToXyz = {{{0.4124564, 0.3575761, 0.1804375},
                            {0.2126729, 0.7151522, 0.0721750},
                            {0.0193339, 0.1191920, 0.9503041}}};
// Machado, Oliveira, Fernandes 2009, severity 1.
constexpr Matrix kNormal = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Matrix kNoRed = {{{0.152286, 1.052583, -0.204868},
                            {0.114503, 0.786281, 0.099216},
                            {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix kNoGreen = {{{0.367322, 0.860646, -0.227968},
                              {0.280085, 0.672501, 0.047413},
                              {-0.011820, 0.042940, 0.968881}}};

Triple lab(std::uint32_t colour, const Matrix& eyes) {
  Triple seen = times(eyes, linear(colour));
  for (double& c : seen) c = std::fmin(1, std::fmax(0, c));
  const Triple xyz = times(kToXyz, seen), white = {0.95047, 1, 1.08883};
  Triple f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / white[i];
    f[i] = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

double difference(std::uint32_t a, std::uint32_t b, const Matrix& eyes) {
  const Triple x = lab(a, eyes), y = lab(b, eyes);
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

double contrast(std::uint32_t a, std::uint32_t b) {
  const double x = times(kToXyz, linear(a))[1], y = times(kToXyz, linear(b))[1];
  return (std::fmax(x, y) + 0.05) / (std::fmin(x, y) + 0.05);
}

TEST(SeriesStyle, TheMeasuresAreRight) {
  EXPECT_NEAR(contrast(0xffffff, 0x000000), 21, 1e-3);
  EXPECT_NEAR(lab(0xffffff, kNormal)[0], 100, 1e-3);
  EXPECT_NEAR(lab(0xff0000, kNormal)[1], 80.1, 0.1);
  EXPECT_LT(difference(0xff0000, 0x808000, kNoGreen), difference(0xff0000, 0x808000, kNormal));
}

// 2.3 is a just noticeable difference in CIELAB; with tens everybody sees different colours.
TEST(SeriesStyle, SixteenColoursDifferInLightAndDark) {
  for (std::size_t i = 0; i < kSeriesColours; ++i) {
    const SeriesStyle a = series_style(i);
    EXPECT_GE(contrast(a.light, kLightGround), 3) << i;  // WCAG 2.1, 1.4.11
    EXPECT_GE(contrast(a.dark, kDarkGround), 3) << i;
    for (std::size_t j = 0; j < i; ++j) {
      const SeriesStyle b = series_style(j);
      EXPECT_GE(difference(a.light, b.light, kNormal), 30) << i << " " << j;
      EXPECT_GE(difference(a.dark, b.dark, kNormal), 30) << i << " " << j;
    }
  }
}

TEST(SeriesStyle, ThoseOfOnePatternDifferWithoutRedOrGreenConesToo) {
  for (std::size_t i = 0; i < 8; ++i) {
    const SeriesStyle a = series_style(i);
    EXPECT_EQ(a.pattern, 0U);
    for (std::size_t j = 0; j < i; ++j) {
      const SeriesStyle b = series_style(j);
      for (const Matrix& eyes : {kNoRed, kNoGreen}) {
        EXPECT_GE(difference(a.light, b.light, eyes), 20) << i << " " << j;
        EXPECT_GE(difference(a.dark, b.dark, eyes), 20) << i << " " << j;
      }
    }
  }
  for (std::size_t i = 8; i < kSeriesColours; ++i) EXPECT_NE(series_style(i).pattern, 0U) << i;
}

TEST(SeriesStyle, NoStyleComesTwice) {
  std::set<std::tuple<std::uint32_t, unsigned>> light, dark;
  for (std::size_t i = 0; i < kSeriesStyles; ++i) {
    const SeriesStyle style = series_style(i);
    EXPECT_TRUE(light.emplace(style.light, style.pattern).second) << i;
    EXPECT_TRUE(dark.emplace(style.dark, style.pattern).second) << i;
    EXPECT_LE(style.pattern, 3U);
  }
}

}  // namespace
}  // namespace tetproof::series_style_test
