#include "mesher/run/options.h"

#include <cmath>

#include "mesher/delmesher_plane.h"

namespace delmesher::run {
namespace {

bool within(double x, const Bounds& bounds) {
  return x >= bounds.low && !(x > bounds.high) && !(bounds.above_low && x == bounds.low);
}

std::string degrees(const char* option, const Bounds& bounds) {
  const auto whole = [](double x) { return std::to_string(static_cast<int>(x)); };
  const std::string high = whole(bounds.high) + " degrees";
  return std::string(option) + (bounds.above_low
                                    ? " must be above " + whole(bounds.low) + " and at most " + high
                                    : " must be between " + whole(bounds.low) + " and " + high);
}

}  // namespace

std::string options_defect(const Options& o, const OptionBounds& bounds) {
  if (!within(o.delta, bounds.delta)) return degrees("delta", bounds.delta);
  if (!within(o.tau, bounds.tau)) return "tau must be between 0 and 1";
  if (!within(o.acute, bounds.acute)) return degrees("acute", bounds.acute);
  if (!within(o.corner, bounds.corner)) return degrees("corner", bounds.corner);
  if (!within(o.chamfer_radius, bounds.length)) return "chamfer radius must not be negative";
  if (!within(o.max_edge, bounds.length)) return "max edge must not be negative";
  if (!within(o.time_limit_seconds, bounds.seconds)) return "time limit must not be negative";
  return {};
}

}  // namespace delmesher::run

namespace delmesher {

Options paper_options() {
  Options options;
  options.acute = options.corner = 90;
  options.gabriel = true;
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
  options.delta = plane_options().delta;
  options.tau = 0;
  return options;
}

const char* version() {
  return "0.1.0";
}

}  // namespace delmesher
