// Finds the input triangle of a facet that contains a point of its plane, in doubles: it steers the
// choice of an anchor for an on-triangle point, which lies exactly in the plane whatever triangle
// is chosen.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/predicates/points.h"
#include "mesher/surface/topology.h"

namespace delmesher::surface {

class FacetLocator {
 public:
  FacetLocator(const SurfaceTopology& topology, const PointStore& points);

  // The input triangle of the facet containing `p` or nearest to containing it.
  std::uint32_t triangle_at(FacetId facet, const Vec3& p);

 private:
  // Triangles of one facet binned by the cells of a planar grid (compressed rows).
  struct Grid {
    std::array<double, 2> low{};
    std::array<double, 2> cell{};
    std::array<std::uint32_t, 2> count{};
    std::vector<std::uint32_t> begin, triangles;
  };
  void build(FacetId facet);
  std::array<std::uint32_t, 2> cell_of(const Grid& grid, double x, double y) const;
  // Smallest barycentric coordinate of p in the triangle: negative outside.
  double inside_by(FacetId facet, std::uint32_t triangle, const Vec3& p) const;

  const SurfaceTopology& topology_;
  const PointStore& points_;
  std::vector<Grid> grids_;
  std::vector<std::uint8_t> built_;
};

}  // namespace delmesher::surface
