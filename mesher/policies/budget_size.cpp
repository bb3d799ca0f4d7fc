#include "mesher/policies/budget_size.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesher/policies/default_size.h"
#include "mesher/refine/prediction.h"

namespace delmesher::policies {
namespace {

constexpr double kAim = 0.95, kUnknown = 2;  // of the budget

double cube(double x) {
  return x * x * x;
}

}  // namespace

bool BudgetSize::is_wanted(const Options& options, const Result& without_size) {
  return options.budget > 0 && options.size == kSizeAuto && options.planar != 0 &&
         !options.approximate && options.region == Region::interior && without_size.status.ok() &&
         static_cast<double>(without_size.mesh.tetrahedra.size()) <
             kFullBudget * static_cast<double>(options.budget);
}

BudgetSize::BudgetSize(const Options& options, const Result& without_size)
    : budget_(static_cast<double>(options.budget)),
      fitting_{cube(options.max_edge > 0 ? kMostOfSize / options.max_edge
                                         : 1 / without_size.statistics.bbox_diagonal),
               static_cast<double>(without_size.mesh.tetrahedra.size())} {
  const Part part = part_of(without_size.mesh);
  // With shorter edges there are more, because a tetrahedron is no larger than a regular one.
  const double shortest = std::cbrt(6 * std::numbers::sqrt2 * part.volume / budget_) / kMostOfSize;
  too_much_ = {cube(1 / shortest), kUnknown * budget_};
  constexpr double kLeast = 1.25;
  try_density(std::max(cube(1 / refine::size_for(kAim * budget_, part.volume, part.area)),
                       kLeast * fitting_.density));
}

void BudgetSize::try_density(double density) {
  // The last bits of a root are not the same everywhere.
  size_ = static_cast<float>(1 / std::cbrt(density));
  is_done_ = is_done_ || !(size_ > 0) || !std::isfinite(size_);
}

void BudgetSize::fits(double tetrahedra) {
  is_done_ = tetrahedra >= kFullBudget * budget_;
  fitting_ = {cube(1 / size_), tetrahedra};
  has_fitted_ = true;
  go_on(fitting_);
}

void BudgetSize::is_too_much(double tetrahedra) {
  too_much_ = {cube(1 / size_), tetrahedra > budget_ ? tetrahedra : kUnknown * budget_};
  was_too_much_ = true;
  go_on(too_much_);
}

void BudgetSize::go_on(const Tried& last) {
  const double aim = kAim * budget_;
  constexpr double kClosest = 1.03, kMargin = 0.05, kPower = 0.9;
  const double ratio = too_much_.density / fitting_.density;
  is_done_ = is_done_ || ratio < kClosest;
  const double span = std::log(ratio);
  double share =
      std::log(aim / fitting_.tetrahedra) / std::log(too_much_.tetrahedra / fitting_.tetrahedra);
  if (!has_fitted_ || !was_too_much_) {
    // Larger steps each time: where small features have most tetrahedra, sizes hardly change them.
    const double step = std::log(aim / last.tetrahedra) * ++steps_ / kPower;
    share = (std::log(last.density / fitting_.density) + step) / span;
  } else if (ratio * ratio > ratio_) {
    share = (share + 0.5) / 2;  // an end that stays is too far off
  }
  ratio_ = ratio;
  try_density(fitting_.density * std::exp(std::clamp(share, kMargin, 1 - kMargin) * span));
}

}  // namespace delmesher::policies
