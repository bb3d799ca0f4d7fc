// Input filtering (section 7): drops whole facets responsible for a local feature size below a
// tolerance.
#pragma once

#include "mesher/chamfer/chamfer.h"

namespace delmesher {

struct FilterResult {
  std::vector<std::uint8_t> facet_kept;     // per facet
  std::vector<std::uint8_t> kept_at_first;  // the same after the first step
  std::uint64_t dropped_triangles = 0;
  std::uint64_t rounds = 0;
};

// First step: no two non-incident kept facets, edges or vertices closer than `tolerance` (absolute
// distance). Worst pairs first, as a worklist: dropping a facet re-examines only what it touched.
FilterResult filter_input(const SurfaceTopology& topology, const PointStore& points,
                          double tolerance, Control& control);

// Features made by chamfering may be smaller than the input's by this factor: a chamfer is a third
// of the local feature size, and a bridge across a corner of angle a that times 2 sin(a / 2).
// With 1 the second step drops as much again as the first did (of 131 models that the first step
// touches at tau = 1e-4, 71 % of the triangles stay on average), with 1/16 next to nothing (79 %;
// 80 % without a second step).
inline constexpr double kChamferedFraction = 1.0 / 16;

// Both steps: filters the input, then alternates chamfering and dropping the facets responsible for
// chamfered edges shorter than chamfered_fraction * tolerance (or elements closer), until none
// remain. Returns the last chamfering; the points of rejected rounds are removed from the store.
ChamferResult filter_and_chamfer(const SurfaceTopology& topology, PointStore& points,
                                 Predicates& predicates, ChamferOptions options, double tolerance,
                                 Control& control, FilterResult& filter,
                                 double chamfered_fraction = kChamferedFraction);

}  // namespace delmesher
