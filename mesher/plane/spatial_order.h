// Orders in which consecutive points lie close together, in space and so in memory.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/ids.h"

namespace delmesher::plane {

// Where along a Hilbert curve that fills a square a point lies. The same for coordinates that are
// scaled by a power of two.
class SpatialKey {
 public:
  // The square on the larger side of the rectangle, which has to contain all points.
  SpatialKey(const std::array<double, 2>& low, const std::array<double, 2>& high);
  std::uint64_t operator()(double x, double y) const;

 private:
  std::array<double, 2> low_;
  double extent_;
};

// The positions of the points in their order along the curve.
std::vector<std::uint32_t> order_along_curve(std::span<const std::array<double, 2>> points);

// Makes a biased randomized insertion order (Amenta, Choi, Rote 2003) out of one along the curve:
// rounds of doubling size, each along the curve.
void arrange_in_rounds(std::vector<VertexId>& order);

}  // namespace delmesher::plane
