// Where the points are that tell of regions: in which tetrahedra, or within which faces.
#pragma once

#include <span>
#include <vector>

#include "oracles/files/polyhedron.h"
#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

// The tetrahedra that contain each of these points, with those on whose boundary it is, ascending.
std::vector<std::vector<Index>> tetrahedra_around(const ExactPoints& points,
                                                  const TetComplex& complex,
                                                  std::span<const Index> which);

class RegionPoints {
 public:
  RegionPoints(const std::vector<RegionPoint>& given, const TetComplex& complex);

  const std::vector<Index>& around(Index n) const { return around_[n]; }
  // Does an odd number of the faces surround it?
  bool is_within(Index n, std::vector<Face> faces) const;

 private:
  Index first_;         // of the points in points_
  ExactPoints points_;  // those of the complex, then the given ones
  std::vector<std::vector<Index>> around_;
};

}  // namespace tetproof::oracles
