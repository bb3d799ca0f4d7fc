// The facets on either side of each segment of a complex. Never changes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/surface/plc.h"

namespace delmesher::refine {

class SegmentFacets {
 public:
  // Throws InternalError if more than two facets have a segment in common.
  explicit SegmentFacets(const Plc& plc);

  // By their numbers: the smaller one first, kNone where there is none.
  const std::array<std::uint32_t, 2>& of(std::uint32_t segment) const { return facets_[segment]; }
  int count(std::uint32_t segment) const {
    const auto& [first, second] = facets_[segment];
    return (first != kNone ? 1 : 0) + (second != kNone ? 1 : 0);
  }

 private:
  std::vector<std::array<std::uint32_t, 2>> facets_;
};

}  // namespace delmesher::refine
