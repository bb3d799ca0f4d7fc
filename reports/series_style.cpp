#include "reports/series_style.h"

#include <array>

namespace tetproof {
namespace {

struct Colour {
  std::uint32_t light, dark;
};

// Chosen by farthest points in CIELAB among the colours of enough contrast and moderate chroma. For
// the first eight, colours as seen without red or without green cones count as well (Machado et al.
// 2009).
constexpr std::array<Colour, kSeriesColours> kColours = {{{0x0072b2, 0x4da6ff},
                                                          {0xd55e00, 0xff8c42},
                                                          {0x008a65, 0x2fc49a},
                                                          {0x6c0054, 0x906c9c},
                                                          {0x3c909c, 0x84e4fc},
                                                          {0x602400, 0xd83048},
                                                          {0x0084fc, 0xc0f09c},
                                                          {0x183cb4, 0x306ce4},
                                                          {0x909000, 0x847800},
                                                          {0xfc3c78, 0xfc60c0},
                                                          {0xb47884, 0xfcccc0},
                                                          {0xcc60d8, 0xcc84fc},
                                                          {0x249c24, 0x249018},
                                                          {0x303c24, 0x6c7860},
                                                          {0x908454, 0xfcd848},
                                                          {0xa80018, 0xa86048}}};
constexpr std::size_t kPlain = 8;

// The patterns of the first and of the last eight colours, for each time that the colours repeat.
constexpr unsigned kPatterns[kSeriesStyles / kSeriesColours][2] = {{0, 1}, {2, 3}, {1, 0}, {3, 2}};

}  // namespace

SeriesStyle series_style(std::size_t index) {
  const std::size_t colour = index % kSeriesColours;
  const std::size_t turn = index / kSeriesColours % (kSeriesStyles / kSeriesColours);
  return {kColours[colour].light, kColours[colour].dark, kPatterns[turn][colour < kPlain ? 0 : 1]};
}

}  // namespace tetproof
