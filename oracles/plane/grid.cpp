#include "oracles/plane/grid.h"

#include <algorithm>
#include <cmath>

namespace tetproof {

PlaneGrid::PlaneGrid(const std::vector<Box>& items) : seen_(items.size(), 0) {
  if (items.empty()) return;
  all_ = items[0];
  for (const Box& box : items) {
    for (std::size_t k = 0; k < 2; ++k) {
      all_.low[k] = std::min(all_.low[k], box.low[k]);
      all_.high[k] = std::max(all_.high[k], box.high[k]);
    }
  }
  side_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(items.size()))) + 1;
  cells_.resize(side_ * side_);
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    const Cell from = cell(items[i].low), to = cell(items[i].high);
    for (std::size_t y = from[1]; y <= to[1]; ++y) {
      for (std::size_t x = from[0]; x <= to[0]; ++x) cells_[y * side_ + x].push_back(i);
    }
  }
}

PlaneGrid::Cell PlaneGrid::cell(const Corner& p) const {
  Cell result{};
  for (std::size_t k = 0; k < 2; ++k) {
    // Halved, so that the largest doubles do not overflow.
    const double extent = all_.high[k] / 2 - all_.low[k] / 2;
    const double place = extent > 0 ? (p[k] / 2 - all_.low[k] / 2) / extent : 0;
    const double scaled = place * static_cast<double>(side_);
    result[k] = scaled >= static_cast<double>(side_) ? side_ - 1
                : scaled > 0                         ? static_cast<std::size_t>(scaled)
                                                     : 0;
  }
  return result;
}

}  // namespace tetproof
