// Options by name, for interfaces that have no struct: C and Python.
#pragma once

#include <string_view>
#include <vector>

#include "mesher/delmesher.h"

namespace delmesher {

// Names as in Options; `order` and `steiner_point` of AsPaper, `time_limit` in seconds, `region` 0
// or 1 (hull). Switches are 0 or 1, counts are whole. False if there is no such option, or if the
// value is not of its type. The call that is given the options checks their ranges.
bool set_option(Options& options, std::string_view name, double value);

// All names.
std::vector<std::string_view> option_names();

}  // namespace delmesher
