// Decides which tetrahedra of a mesh file are inside, by its region numbers and by parity.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/input_surface.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// Regions are numbers without meaning, but none may hold both tetrahedra inside and outside. A
// region is on the side on which most of its volume lies, by parity of the centroids. Rounding may
// leave the centroid of a sliver along the surface on the other side. Then `complex.inside` follows
// the region, and the sliver may be no thicker than `allowed` (input units), which check_strays
// checks.
class Regions {
 public:
  // Sets complex.inside, which must hold the parity. Both arguments must outlive this.
  Regions(TetComplex& complex, const std::vector<std::int64_t>& regions);

  // `called`, if not empty, says of each tetrahedron whether it is inside; that must be true.
  OracleReport check_strays(double allowed, const std::vector<std::uint8_t>& called) const;

 private:
  const TetComplex& complex_;
  const std::vector<std::int64_t>& regions_;
  std::size_t count_ = 0;
  std::vector<std::size_t> strays_;
};

// Areas are doubles in squares of 2^area_unit() input units: 0, unless the largest coordinate is
// above 2^200 or below 2^-200.
int area_unit(double largest_coordinate);

// In squares of 2^unit input units, rounded.
double surface_area(const TetComplex& complex, const std::vector<Face>& faces, int unit);

// Have the tetrahedra, all together, the volume of the solid, to a millionth? Or to as much as
// rounding of the vertices by at most `rounding` (input units) adds: where walls are thin, that is
// more than any share of the volume.
bool fills(const TetComplex& complex, const InputSurface& surface, double rounding);

}  // namespace tetproof::oracles
