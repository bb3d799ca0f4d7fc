#include "mesher/refine/segment_facets.h"

#include "mesher/base/check.h"

namespace delmesher::refine {

SegmentFacets::SegmentFacets(const Plc& plc)
    : facets_(plc.segments.size(), std::array<std::uint32_t, 2>{kNone, kNone}) {
  for (std::uint32_t f = 0; f < plc.facets.size(); ++f) {
    for (const PlcFacet::Side& side : plc.facets[f].boundary) {
      auto& [first, second] = facets_[side.segment];
      std::uint32_t& use = first == kNone ? first : second;
      DELMESHER_CHECK(use == kNone, "a segment bounds more than two facets");
      use = f;
    }
  }
}

}  // namespace delmesher::refine
