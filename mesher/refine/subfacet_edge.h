// One of the three edges of a subfacet, or none: the handle by which subfacets name each other and
// subsegments name them.
#pragma once

#include <cstdint>

#include "mesher/base/ids.h"

namespace delmesher::refine {

class SubfacetEdge {
 public:
  // The largest number that a handle can hold.
  static constexpr std::uint32_t kMostSubfacets = kNone / 4;

  SubfacetEdge() = default;  // none
  // Edge i is opposite vertex i.
  SubfacetEdge(std::uint32_t subfacet, std::uint32_t edge) : code_(4 * subfacet + edge) {}

  bool exists() const { return code_ != kNone; }
  std::uint32_t subfacet() const { return code_ >> 2; }
  std::uint32_t edge() const { return code_ & 3U; }
  friend bool operator==(SubfacetEdge, SubfacetEdge) = default;

 private:
  std::uint32_t code_ = kNone;
};

}  // namespace delmesher::refine
