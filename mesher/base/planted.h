// Deliberate errors, to measure how soon the fuzz targets find them. They exist in fuzz builds
// configured with TETPROOF_PLANTED_BUGS only, where TETPROOF_PLANTED_BUG=N in the environment
// chooses one; elsewhere planted() is the constant false.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace delmesher {

enum class Planted : std::uint8_t {
  none,
  implicit_error,        // the error bound of implicit points is 10 % too small
  perturbed_tie,         // the second tie-break of the perturbation has the wrong sign
  rounded_coordinate,    // rounded coordinates count as exact when they are equal
  obtuse_dihedral,       // an obtuse dihedral angle is compared as if it were acute
  segment_encroachment,  // one vertex around a subsegment is not looked at
  facet_encroachment,    // one of the two vertices beside a subfacet is not looked at
  rounding_check,        // what doubles cannot decide counts as positive after rounding
  reader_index,          // an index one beyond the last is let through
  coplanar,              // what the filter cannot decide counts as coplanar
  nesting,               // components two levels deep are left as if they were one level deep
  edge_distance,         // local feature size forgets about pairs of edges
  chamfer_distance,      // chamfers are up to 3 % wider than allowed
  filter_worklist,       // an element whose neighbour was dropped is not looked at again
  written_digits,        // numbers are written with 16 digits
  shared_vertex,         // triangles that share a vertex are never compared
  decided_zero,          // the filter takes a value equal to its error bound for positive
  stale_incident,        // only the new vertex learns which tetrahedra are new
  coplanar_ghost,        // a point in the plane of a hull face never conflicts with its ghost
  merged_facet,          // merging two sets of coplanar triangles leaves part of one behind
  unscaled_radius        // radii stay in the small units of a model of extreme size
};

#ifdef DELMESHER_PLANTED_BUGS
inline const int kPlantedBug = [] {
  const char* number = std::getenv("TETPROOF_PLANTED_BUG");
  return number == nullptr ? 0 : std::atoi(number);
}();
inline bool planted(Planted bug) {
  return static_cast<int>(bug) == kPlantedBug;
}
#else
constexpr bool planted(Planted) {
  return false;
}
#endif

}  // namespace delmesher
