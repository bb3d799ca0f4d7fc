#include "mesher/planar/flatness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "mesher/geometry/vector.h"
#include "mesher/planar/edge_bends.h"
#include "mesher/planar/planar_growth.h"
#include "mesher/planar/resolution.h"

namespace delmesher::planar {
namespace {

using predicates::Vec3;

constexpr double kExplained = 1.25;  // bends up to so many roundings
constexpr double kMore = 4;          // and larger ones up to so many times that
constexpr double kRough = 0.45;

double count_bends(const std::vector<double>& bends, double low, double high) {
  return static_cast<double>(std::ranges::count_if(
      bends, [=](double x) { return std::fabs(x) > low && std::fabs(x) <= high; }));
}

// Are the bends above `least` what coordinates that are off by `rounding` make of flat faces?
bool explains(double rounding, const std::vector<double>& bends, double least) {
  constexpr double kTimes = 4.5;
  const double most = kExplained * rounding;
  return count_bends(bends, least, most) >
         kTimes * std::max(1.0, count_bends(bends, std::max(least, most), kMore * most));
}

// Are the bends from `least` to `most` those of a curved surface, of which as many edges are bent
// by a little more, or edges beside each other alike?
bool are_of_curves(const Surface& surface, const std::vector<double>& bends, double least,
                   double most) {
  const double small = count_bends(bends, least, most);
  return small > 0 && (count_bends(bends, most, kMore * most) >= small ||
                       roughness(surface, least, most) < kRough);
}

class PlanarGroups {
 public:
  PlanarGroups(const Surface& surface, Control& control) : surface_(surface), control_(control) {}

  // Those of one triangle among them.
  double within(double flat) const {
    PlanarGrowth growth(surface_, flat, flat, control_);
    growth.grow_all();
    return static_cast<double>(std::ranges::count_if(
        growth.groups(), [](const PlanarGrowth::Group& g) { return !g.triangles.empty(); }));
  }

 private:
  const MeasuredSurface surface_;
  Control& control_;
};

// What bends noise makes of flat faces, if it does and more than `flat` is needed for it; else 0.
// Bends are those of two triangles, and the corners of many are farther from their plane: how much,
// depends on their shapes.
double bend_of_noise(const PlanarGroups& groups, double flat, double noise) {
  constexpr double kLeast = 2, kStep = std::numbers::sqrt2;  // of the noise
  constexpr double kSettled = 0.5, kHardly = 0.01, kFewer = 0.97;
  constexpr double kSame = 0.1, kNearly = 0.25, kOfFewer = 1.0 / 3, kOfMany = 0.02;
  std::array<double, 5> bound, count;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    bound[i] = i == 0 ? kLeast * noise : kStep * bound[i - 1];
    count[i] = groups.within(bound[i]);
  }
  const double before = groups.within(flat);
  // Where flat faces have become whole, the next step makes fewer groups one with others than the
  // one before, or hardly any. Where it makes as many, these are facets that were meant. (Of a
  // curved surface, groups become fewer with the root of the bound: by 29 % at twice.)
  const auto step = [&](std::size_t i) { return count[i] - count[i + 1]; };
  const double hardly = kHardly * std::max(count[0], before - count[0]);
  std::size_t best = 0;
  while (best < 2 && step(best + 1) <= std::max(kSettled * step(best), hardly)) ++best;
  const auto noisy = [&](std::size_t i) {
    const double fewer = before - count[i], with_twice = count[i] - count[i + 2];
    return count[i] <= kFewer * before &&
           with_twice <= std::max({kSame * count[i], kOfMany * fewer,
                                   std::min(kNearly * count[i], kOfFewer * fewer)});
  };
  // Where few groups of many triangles are left, a step that is not the last one may be any.
  while (best < 2 && !noisy(best) && 2 * count[best] < before) ++best;
  return noisy(best) ? bound[best] : 0;
}

}  // namespace

double flatness(const Surface& surface, Control& control) {
  constexpr double kFlat = 0x1p-20;                            // of the diagonal
  constexpr double kUlps = 0x1p-46;                            // of the largest coordinate: 64
  constexpr double kOfRounding = 1.5, kMostRounded = 0x1p-14;  // of the diagonal
  constexpr double kMostNoise = kMostRounded / 4;
  constexpr std::ptrdiff_t kFewest = 8;
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
  const double rounding = rounding_of_coordinates(surface, kMostRounded / kOfRounding * diagonal);
  const bool meant = rounding == 0 && are_of_curves(surface, all, least, most);
  double result = meant ? least : std::min(4 * flat, most);
  if (explains(rounding, all, least)) result = std::max(result, kOfRounding * rounding);
  std::optional<const PlanarGroups> groups;
  const auto look_for_noise = [&](double resolved, std::ptrdiff_t fewest) {
    // Less than half is flat already.
    const double noise = noise_of_bends(all, resolved, result / 2, kMostNoise * diagonal, fewest);
    if (noise == 0 || roughness(surface, resolved, noise) < kRough) return;
    if (!groups) groups.emplace(surface, control);
    result = std::max(result, bend_of_noise(*groups, result, noise));
  };
  look_for_noise(least, kFewest);
  // What the coordinates cannot resolve, or is flat in any case, says nothing about coarser noise,
  // and may hide it.
  look_for_noise(std::max({least, kExplained * rounding, most / 4}), 2 * kFewest);
  return result;
}

}  // namespace delmesher::planar
