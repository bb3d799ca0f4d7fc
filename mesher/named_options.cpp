#include "mesher/named_options.h"

#include <array>
#include <cmath>

namespace delmesher {
namespace {

bool set(bool& target, double value) {
  target = value != 0;
  return value == 0 || value == 1;
}

bool set(double& target, double value) {
  target = value;
  return true;  // the call that uses it refuses a NaN
}

template <class Count>
bool set_count(Count& target, double value, double most) {
  if (!(value >= 0 && value <= most) || value != std::floor(value)) return false;
  target = static_cast<Count>(value);
  return true;
}

struct NamedOption {
  std::string_view name;
  bool (*set)(Options&, double);
};

constexpr std::array<NamedOption, 20> kOptions = {{
    {"delta", [](Options& o, double x) { return set(o.delta, x); }},
    {"tau", [](Options& o, double x) { return set(o.tau, x); }},
    {"budget", [](Options& o, double x) { return set_count(o.budget, x, kBounds.budget.high); }},
    {"acute", [](Options& o, double x) { return set(o.acute, x); }},
    {"corner", [](Options& o, double x) { return set(o.corner, x); }},
    {"gabriel", [](Options& o, double x) { return set(o.gabriel, x); }},
    {"improve", [](Options& o, double x) { return set(o.improve, x); }},
    {"slivers", [](Options& o, double x) { return set(o.slivers, x); }},
    {"approximate", [](Options& o, double x) { return set(o.approximate, x); }},
    {"simplify_bridges", [](Options& o, double x) { return set(o.simplify_bridges, x); }},
    {"chamfer_radius", [](Options& o, double x) { return set(o.chamfer_radius, x); }},
    {"planar", [](Options& o, double x) { return set(o.planar, x); }},
    {"max_edge", [](Options& o, double x) { return set(o.max_edge, x); }},
    {"size_growth", [](Options& o, double x) { return set(o.size_growth, x); }},
    {"order", [](Options& o, double x) { return set(o.as_paper.order, x); }},
    {"steiner_point", [](Options& o, double x) { return set(o.as_paper.steiner_point, x); }},
    {"region",
     [](Options& o, double x) {
       bool hull = false;
       const bool known = set(hull, x);
       o.region = hull ? Region::hull : Region::interior;
       return known;
     }},
    {"max_vertices",
     [](Options& o, double x) { return set_count(o.max_vertices, x, kBounds.max_vertices.high); }},
    {"time_limit", [](Options& o, double x) { return set(o.time_limit_seconds, x); }},
    {"threads", [](Options& o, double x) { return set_count(o.threads, x, kBounds.threads.high); }},
}};

}  // namespace

bool set_option(Options& options, std::string_view name, double value) {
  for (const NamedOption& option : kOptions) {
    if (option.name == name) return option.set(options, value);
  }
  return false;
}

std::vector<std::string_view> option_names() {
  std::vector<std::string_view> names;
  for (const NamedOption& option : kOptions) names.push_back(option.name);
  return names;
}

}  // namespace delmesher
