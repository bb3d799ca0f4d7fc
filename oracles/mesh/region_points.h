// Where the points are that tell of regions: in which tetrahedra, or within which faces.
#pragma once

#include <vector>

#include "oracles/files/polyhedron.h"
#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

class RegionPoints {
 public:
  RegionPoints(const std::vector<RegionPoint>& given, const TetComplex& complex);

  // The tetrahedra that contain point n, with those on whose boundary it is, ascending.
  const std::vector<Index>& around(Index n) const { return around_[n]; }
  // Does an odd number of the faces surround it?
  bool is_within(Index n, std::vector<Face> faces) const;

 private:
  bool contains(const Tet& tet, Index point) const;

  Index first_;         // of the points in points_
  ExactPoints points_;  // those of the complex, then the given ones
  std::vector<std::vector<Index>> around_;
};

}  // namespace tetproof::oracles
