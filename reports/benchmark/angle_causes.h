// Finds the causes of the smallest angles of a final mesh.
#pragma once

#include <array>
#include <cstdint>

#include "mesher/delmesher.h"

namespace tetproof::benchmark {

// The causes of an angle below delta of a face of the final mesh, in order of precedence.
enum class AngleCause : std::uint8_t {
  input_corner,  // the angle is at a chamfered input vertex
  cdt_steiner,   // a vertex was added by the last step
  filtered,      // a vertex lies on a facet that the filter dropped
  refill,  // another vertex was chamfered, or no vertex is new: the region cut off, filled again
  count
};
inline constexpr std::array<const char*, 4> kAngleCauseNames = {"input_corner", "cdt_steiner",
                                                                "filtered", "refill"};

struct AngleCauses {
  // Smallest angle of a facet (coplanar triangles) at an input vertex, degrees: no mesh that
  // conforms has a larger smallest angle.
  double bound = 180;
  double smallest = 180;  // face angle of the final mesh, over the tetrahedra inside
  AngleCause cause = AngleCause::refill;  // of `smallest`
  std::uint64_t faces = 0;                // inside, each counted once per tetrahedron
  std::array<std::uint64_t, 4> below{};   // with an angle below delta, by cause
};

// `result` must be that of tetrahedralize() with Options::want_exact on this surface.
AngleCauses find_angle_causes(const delmesher::Surface& surface, const delmesher::Result& result);

}  // namespace tetproof::benchmark
