// Where the segments of a graph meet as they must not, and the graph without these places.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/planar_graph.h"

namespace delmesher::plane {

// By GraphDefect, decided exactly; of each kind at most a million.
std::array<std::vector<std::array<std::uint32_t, 2>>, kGraphDefects> defects_of(
    const PlanarGraph& graph, base::Control& control);

// repair_graph() of a graph whose numbers make sense; adds a line for each change to `done`.
PlanarGraph mended(const PlanarGraph& graph, double weld, std::vector<std::string>& done,
                   base::Control& control);

}  // namespace delmesher::plane
