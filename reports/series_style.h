// The styles that tell the series of a chart apart.
//
// Laws: the first kSeriesColours styles differ in colour, in light and in dark pages, and stand out
// from the ground; all kSeriesStyles differ in colour or pattern; from the ninth on a pattern is
// added, so that nobody has to tell more than eight colours apart.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tetproof {

struct SeriesStyle {
  std::uint32_t light, dark;  // 0xRRGGBB, for light and for dark pages
  // 0: plain; 1 to 3: bars are hatched, crossed or dotted, lines dashed, dotted or both, and points
  // have other shapes.
  unsigned pattern;
};

inline constexpr std::size_t kSeriesColours = 16, kSeriesStyles = 64;
// The grounds of charts in light and dark pages (--panel in page/page.css).
inline constexpr std::uint32_t kLightGround = 0xf5f6f8, kDarkGround = 0x1e2328;

// Styles repeat from kSeriesStyles on.
SeriesStyle series_style(std::size_t index);

}  // namespace tetproof
