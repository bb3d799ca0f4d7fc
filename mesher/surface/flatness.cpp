#include "mesher/surface/flatness.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesher/predicates/vector.h"
#include "mesher/surface/edge_bends.h"
#include "mesher/surface/planar_growth.h"
#include "mesher/surface/resolution.h"

namespace delmesher::surface {
namespace {

using predicates::Vec3;

// Are the bends above `least` what coordinates that are off by `rounding` make of flat faces?
bool explains(double rounding, const std::vector<double>& bends, double least) {
  constexpr double kExplained = 1.25, kMore = 4, kTimes = 4.5;
  const auto count = [&bends](double low, double high) {
    return static_cast<double>(std::ranges::count_if(
        bends, [=](double x) { return std::fabs(x) > low && std::fabs(x) <= high; }));
  };
  const double most = kExplained * rounding;
  return count(least, most) > kTimes * std::max(1.0, count(std::max(least, most), kMore * most));
}

// Planar groups, those of one triangle among them.
std::size_t groups_within(const MeasuredSurface& surface, double flat, Control& control) {
  PlanarGrowth growth(surface, flat, flat, control);
  growth.grow_all();
  return static_cast<std::size_t>(std::ranges::count_if(
      growth.groups(), [](const PlanarGrowth::Group& g) { return !g.triangles.empty(); }));
}

// Does `more` make groups one that `flat` leaves apart, and twice as much no others?
bool makes_flat(const Surface& surface, double flat, double more, Control& control) {
  constexpr double kFewer = 0.97, kSame = 0.9;
  const MeasuredSurface measured(surface);
  const auto groups = [&](double within) {
    return static_cast<double>(groups_within(measured, within, control));
  };
  const double with_more = groups(more);
  return with_more <= kFewer * groups(flat) && groups(2 * more) >= kSame * with_more;
}

}  // namespace

double flatness(const Surface& surface, Control& control) {
  constexpr double kFlat = 0x1p-20;  // of the diagonal
  constexpr double kUlps = 0x1p-46;  // of the largest coordinate: 64
  constexpr double kOfRounding = 1.5, kOfNoise = 4, kMostRounded = 0x1p-14;  // of the diagonal
  Vec3 low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  double largest = 0;
  for (const Vec3& v : surface.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], v[i]);
      high[i] = std::max(high[i], v[i]);
      largest = std::max(largest, std::fabs(v[i]));
    }
  }
  const double diagonal = norm(subtract(high, low));
  if (!(diagonal > 0) || !std::isfinite(diagonal)) return 0;
  const std::vector<double> all = edge_bends(surface);
  const double least = kUlps * largest, most = kFlat * diagonal;
  double flat = least / 4;
  for (const double x : all) {
    if (std::fabs(x) <= most) flat = std::max(flat, std::fabs(x));
  }
  double result = std::min(4 * flat, most);
  const double rounding = rounding_of_coordinates(surface, kMostRounded / kOfRounding * diagonal);
  if (explains(rounding, all, least)) result = std::max(result, kOfRounding * rounding);
  // Less is flat already.
  const double noise =
      noise_of_bends(all, least, result / kOfNoise, kMostRounded / kOfNoise * diagonal);
  const bool noisy = noise > 0 && makes_flat(surface, result, kOfNoise * noise, control);
  return noisy ? kOfNoise * noise : result;
}

}  // namespace delmesher::surface
