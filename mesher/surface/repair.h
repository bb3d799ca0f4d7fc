// Makes the repairs of a surface that are safe, and lists them; describes the holes that are left.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/delmesher/repair.h"

namespace delmesher::surface {

// The edges of exactly one triangle, put together where they form a ring: the side of a hole. Where
// they form none, edges at which one more triangle goes one way than the other are taken as well,
// as of three where something else touches the hole. At vertices where several rings meet, edges
// are left over.
struct Hole {
  std::vector<std::uint32_t> corners;  // in the order in which a triangle that fills it goes round
  std::int32_t label = 0;              // of a triangle beside it
  double width = 0;                    // diagonal of its box
};
struct Holes {
  std::vector<Hole> holes;       // by their first corner
  std::uint64_t open_edges = 0;  // all of them
};
Holes holes_of(const Surface& surface);

// A distance within which vertices may be welded so that fewest edges stay open; of several the
// smallest, of one digit.
struct WeldHint {
  double distance = 0;       // 0: only vertices at the same place
  std::uint64_t closed = 0;  // edges that would be open no more; 0: welding closes nothing
};
WeldHint weld_hint(const Surface& surface);

}  // namespace delmesher::surface
