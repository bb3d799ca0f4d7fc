// Plain Delaunay of given points: by CGAL, the floor that the mesher's times are compared with, and
// by the mesher's own kernel.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof::benchmark {

struct Timing {
  std::size_t tetrahedra = 0;  // finite ones
  double seconds = 0;          // processor time of this thread
};

// Delaunay_triangulation_3 (EPICK, in CGAL's spatial order) of the nearest doubles; coincident ones
// once.
Timing cgal_delaunay(const std::vector<std::array<double, 3>>& points);

// The mesher's kernel on doubles, and on the points as they are defined.
Timing own_delaunay(const std::vector<std::array<double, 3>>& points);

// The points of a record that the final mesh uses: with their exact definitions, as a run of the
// mesher made them, and as the nearest doubles.
struct FinalPoints {
  explicit FinalPoints(const delmesher::ExactRecord& record);
  Timing own_delaunay() const;

  std::vector<delmesher::ExactRecord::Plane> planes;
  std::vector<delmesher::ExactPoint> all;      // with the corners that definitions refer to
  std::vector<std::uint32_t> used;             // ascending
  std::vector<std::array<double, 3>> nearest;  // of those used, each position once
};

}  // namespace tetproof::benchmark
