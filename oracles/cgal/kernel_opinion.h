// CGAL's in-sphere and orientation tests on exact points, as a second opinion on exact_points.h.
#pragma once

#include <memory>

#include "oracles/base/exact_points.h"

namespace tetproof::oracles {

class KernelOpinion {
 public:
  explicit KernelOpinion(const ExactPoints& points);
  ~KernelOpinion();
  KernelOpinion(const KernelOpinion&) = delete;
  KernelOpinion& operator=(const KernelOpinion&) = delete;

  // As exact::orient3d and exact::insphere.
  int orient3d(Index a, Index b, Index c, Index d) const;
  int insphere(Index a, Index b, Index c, Index d, Index e) const;

 private:
  struct Kernel;
  std::unique_ptr<const Kernel> kernel_;
};

// Six times the exact volume of the convex hull of some of the points, in integer units; 0 if they
// lie in a plane.
ExactNumber cgal_hull_volume6(const ExactPoints& points, std::span<const Index> corners);

// The tetrahedra of CGAL's Delaunay tetrahedrization of some points, positively oriented. For
// points on one sphere any choice is Delaunay.
std::vector<std::array<Index, 4>> cgal_delaunay(std::span<const Position> points);

}  // namespace tetproof::oracles
