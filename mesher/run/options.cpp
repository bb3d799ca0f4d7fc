#include "mesher/run/options.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "mesher/delmesher/option_table.h"
#include "mesher/delmesher_plane.h"
#include "mesher/geometry/vector.h"

namespace delmesher::run {
namespace {

std::string text(double bound) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.15g", bound);
  return digits;
}

std::string range_defect(const options::Text& option) {
  const options::Bounds& bounds = option.bounds;
  const char* unit = option.unit == options::Unit::degrees ? " degrees" : "";
  const std::string name(option.name), low = text(bounds.low);
  if (bounds.high == options::kNoBound) {
    return name + (bounds.above_low ? " must be above " : " must be at least ") + low + unit;
  }
  return name +
         (bounds.above_low ? " must be above " + low + " and at most "
                           : " must be between " + low + " and ") +
         text(bounds.high) + unit;
}

template <class T>
std::string value_defect(const options::Text& option, const T& value) {
  const auto number = static_cast<double>(value);
  const bool is_word = std::any_of(
      option.words.begin(), option.words.end(),
      [&](const options::Word& word) { return !word.word.empty() && word.value == number; });
  return is_word || option.bounds.allow(number) ? "" : range_defect(option);
}

std::string value_defect(const options::Text& /*option*/, const std::vector<SizeSource>& field) {
  for (std::size_t n = 0; n < field.size(); ++n) {
    const auto& [point, size] = field[n];
    const bool finite =
        std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); });
    if (!finite || !std::isfinite(size) || !(size > 0)) {
      return "source " + std::to_string(n) +
             " of the size field has no finite point or no size above 0";
    }
  }
  return {};
}

// The name of an option that is not as by default, and does nothing with a kept surface; or none.
std::string_view useless_if_kept(const Options& given) {
  const std::vector<options::Value> values = options::values_of(given),
                                    usual = options::values_of(Options());
  for (std::size_t n = 0; n < values.size(); ++n) {
    const options::Text& option = values[n].text;
    if (!option.with_kept_surface && values[n].value != usual[n].value) return option.name;
  }
  return {};
}

std::string combination_defect(const Options& given) {
  const bool complex = given.regions != Regions::solid;
  if (given.tolerance != 0 && (given.want_exact || complex)) {
    return given.want_exact ? "a tolerance has no exact record yet"
                            : "regions with a tolerance is not possible yet";
  }
  if (complex && given.surface == SurfaceChoice::split) return "--regions needs --surface keep";
  if (complex && given.want_exact) return "--regions has no exact record yet";
  if (complex && given.budget > 0) return "--budget with --regions is not possible yet";
  if ((given.regions == Regions::named) == given.region_names.empty()) {
    return "names of regions are for --regions with names";
  }
  if ((given.split_walls == SplitWalls::named) == given.split_wall_names.empty()) {
    return "names of walls are for --split-walls with names";
  }
  if (!complex && given.split_walls != SplitWalls::none) return "--split-walls needs --regions";
  if (!complex && !given.region_sizes.empty()) return "--max-edge of a region needs --regions";
  for (const RegionSize& size : given.region_sizes) {
    if (!(size.max_edge > 0) || !std::isfinite(size.max_edge)) {
      return "max_edge of region " + size.region + " must be above 0";
    }
  }
  if (given.surface != SurfaceChoice::keep && !complex) {
    return given.strict ? "--strict needs --surface keep" : "";
  }
  const std::string_view useless = useless_if_kept(given);
  if (useless.empty()) return {};
  return "--" + options::argument_name(useless) + " does nothing with " +
         (complex ? "--regions" : "--surface keep");
}

std::string combination_defect(const RemeshOptions& given) {
  return given.tolerance == 0 ? "tolerance must not be 0" : "";
}

template <class JobOptions>
std::string combination_defect(const JobOptions& /*given*/) {
  return {};
}

}  // namespace

SurfaceChoice surface_choice(const Options& given) {
  const bool may_keep = useless_if_kept(given).empty() && !given.want_chamfered;
  return given.surface == SurfaceChoice::automatic && !may_keep ? SurfaceChoice::split
                                                                : given.surface;
}

template <class JobOptions>
std::string options_defect(const JobOptions& given) {
  std::string defect;
  options::for_each(given, [&](const options::Text& option, const auto& value) {
    if (defect.empty()) defect = value_defect(option, value);
  });
  return defect.empty() ? combination_defect(given) : defect;
}

template std::string options_defect(const Options&);
template std::string options_defect(const CdtOptions&);
template std::string options_defect(const ImproveOptions&);
template std::string options_defect(const PlaneOptions&);
template std::string options_defect(const CheckOptions&);
template std::string options_defect(const RemeshOptions&);

}  // namespace delmesher::run

namespace delmesher {
namespace {

template <class JobOptions>
void choose_all_of_paper(JobOptions& chosen) {
  for (const options::Value& option : options::values_of(chosen)) {
    if (option.is_paper()) options::set(chosen, option.text.name, 1);
  }
}

}  // namespace

Options paper_options() {
  Options paper;
  paper.surface = SurfaceChoice::split;
  paper.acute = paper.corner = 90;
  paper.gabriel = true;
  paper.improve = false;
  paper.slivers = true;
  paper.planar = 0;
  paper.size = 0;
  paper.region = Region::hull;
  choose_all_of_paper(paper);
  return paper;
}

PlaneOptions paper_plane_options() {
  PlaneOptions paper;
  paper.tau = 0;
  paper.acute = 90;
  paper.region = Region::hull;
  choose_all_of_paper(paper);
  return paper;
}

const char* version() {
  return "0.1.0";
}

}  // namespace delmesher
