// Finds the bounds that the input sets for the smallest angles of a mesh, and the causes of the
// smallest ones of a final mesh.
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

// No mesh that conforms has larger smallest angles, in degrees.
struct AngleBounds {
  double face = 180;  // the smallest angle of a facet (coplanar triangles) at an input vertex
  // The sharpest wedge: the smallest dihedral angle between facets at an input edge, inside. It may
  // be one tetrahedron's alone; no tetrahedron has six dihedral angles above acos(1/3). Corners set
  // no other bound: a tetrahedron has the angles of a spherical triangle there, and the angles of
  // the corner are the wedges of its edges; needles have small face angles, but no small dihedral
  // ones.
  double dihedral = 70.528779365509308;
};

// `record` only has to tell the facets of this surface.
AngleBounds find_bounds(const delmesher::Surface& surface, const delmesher::ExactRecord& record);

struct AngleCauses {
  AngleBounds bounds;
  double smallest = 180;           // face angle of the final mesh, over the tetrahedra inside
  double smallest_dihedral = 180;  // the same
  AngleCause cause = AngleCause::refill;  // of `smallest`
  std::uint64_t faces = 0;                // inside, each counted once per tetrahedron
  std::array<std::uint64_t, 4> below{};   // with an angle below delta, by cause
};

// `result` must be that of tetrahedralize() with Options::want_exact on this surface.
AngleCauses find_angle_causes(const delmesher::Surface& surface, const delmesher::Result& result);

}  // namespace tetproof::benchmark
