#include "mesher/run/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mesher/delmesher_plane.h"

namespace delmesher::run {
namespace {

std::string text(double bound) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.15g", bound);
  return digits;
}

std::string defect(const char* option, const Bounds& bounds, const char* unit = "") {
  const std::string name = option, low = text(bounds.low);
  if (bounds.high == kNoBound) {
    return name + (bounds.above_low ? " must be above " + low : " must be at least " + low) + unit;
  }
  return name +
         (bounds.above_low ? " must be above " + low + " and at most "
                           : " must be between " + low + " and ") +
         text(bounds.high) + unit;
}

}  // namespace

std::string options_defect(const Options& o, const OptionBounds& bounds) {
  constexpr const char* kDegrees = " degrees";
  const struct {
    const char* name;
    double value;
    const Bounds& bounds;
    const char* unit = "";
  } all[] = {{"delta", o.delta, bounds.delta, kDegrees},
             {"tau", o.tau, bounds.tau},
             {"planar", o.planar == kPlanarAuto ? 0 : o.planar, bounds.planar},
             {"acute", o.acute, bounds.acute, kDegrees},
             {"corner", o.corner, bounds.corner, kDegrees},
             {"chamfer radius", o.chamfer_radius, bounds.length},
             {"max edge", o.max_edge, bounds.length},
             {"size growth", o.size_growth, bounds.growth},
             {"budget", static_cast<double>(o.budget), bounds.budget},
             {"time limit", o.time_limit_seconds, bounds.seconds},
             {"max vertices", static_cast<double>(o.max_vertices), bounds.max_vertices},
             {"threads", static_cast<double>(o.threads), bounds.threads}};
  for (const auto& option : all) {
    if (!option.bounds.allow(option.value)) return defect(option.name, option.bounds, option.unit);
  }
  for (std::size_t n = 0; n < o.size_field.size(); ++n) {
    const auto& [point, size] = o.size_field[n];
    const bool finite =
        std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); });
    if (!finite || !std::isfinite(size) || !(size > 0)) {
      return "source " + std::to_string(n) +
             " of the size field has no finite point or no size above 0";
    }
  }
  return {};
}

}  // namespace delmesher::run

namespace delmesher {

Options paper_options() {
  Options options;
  options.acute = options.corner = 90;
  options.gabriel = true;
  options.improve = false;
  options.slivers = true;
  options.planar = 0;
  for (const NamedChoice& choice : kPaperChoices) options.as_paper.*choice.member = true;
  options.region = Region::hull;
  return options;
}

Options plane_options() {
  Options options;
  options.delta = 20.7;
  return options;
}

Options paper_plane_options() {
  Options options = paper_options();
  options.as_paper = {.steiner_point = true};
  options.delta = plane_options().delta;
  options.tau = 0;
  return options;
}

const char* version() {
  return "0.1.0";
}

}  // namespace delmesher
