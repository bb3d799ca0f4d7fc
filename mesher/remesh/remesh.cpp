#include "mesher/remesh/remesh.h"

#include <utility>

#include "mesher/remesh/coarsening.h"
#include "mesher/remesh/shaping.h"
#include "mesher/surface/validity.h"

namespace delmesher::remesh {
namespace {

// Of the diagonal, and of the largest coordinate.
constexpr double kLeastTolerance = 1e-7, kLeastShare = 1e-12;
constexpr int kRounds = 6;
constexpr double kWorthwhile = 0.98;  // a round that leaves more triangles is the last

// Roundings have to be far less than the tolerance.
std::string tolerance_defect(const Surface& surface, double tolerance, double diagonal) {
  const double largest = largest_coordinate(surface);
  if (tolerance >= kLeastTolerance * diagonal && tolerance >= kLeastShare * largest) return {};
  return "tolerance must be at least 1e-7 of the diagonal of the surface, and 1e-12 of its "
         "distance from the origin";
}

void change(State& state, Control& control) {
  for (int round = 0; round < kRounds; ++round) {
    const auto before = static_cast<double>(state.mesh().count());
    coarsen(state, control);
    make_rounder(state, false, control);
    if (static_cast<double>(state.mesh().count()) > kWorthwhile * before) break;
  }
  do {
    make_rounder(state, true, control);
  } while (split_long(state, control));
}

}  // namespace

Remeshed remesh(const Surface& surface, const RemeshGoals& given, const LocalFrame& frame,
                Control& control) {
  control.enter(Phase::check);
  surface::ValidityResult validity = surface::check_validity(surface, true, control);
  Remeshed result{.status = std::move(validity.report.status),
                  .warnings = std::move(validity.report.warnings),
                  .surface = {},
                  .diagonal = validity.report.bbox_diagonal};
  if (!result.status.ok()) return result;
  RemeshGoals goals = given;
  if (goals.tolerance < 0) goals.tolerance *= -result.diagonal;
  result.tolerance = goals.tolerance;
  std::string defect = tolerance_defect(surface, goals.tolerance, result.diagonal);
  if (!defect.empty()) {
    result.status = {StatusCode::invalid_options, std::move(defect)};
    return result;
  }
  control.enter(Phase::remesh);
  State state(surface::oriented_outwards(surface, validity), goals, frame);
  change(state, control);
  result.surface = state.surface();
  if (surface.labels.empty()) result.surface.labels.clear();
  return result;
}

}  // namespace delmesher::remesh
