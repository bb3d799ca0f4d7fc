// Surfaces in 3MF: an archive of zip with models in XML.
#pragma once

#include <string>
#include <string_view>

#include "oracles/files/polyhedron.h"

namespace tetproof::oracles {

bool is_zip(std::string_view bytes);

// The objects as the build places them, each with a label of its own if there are several, from 1
// in the order of their first use. Objects of a type that is not a model are left out, and so are
// PrusaSlicer's modifiers. Throws ReadError.
Polyhedron read_three_mf(const std::string& path, std::string_view bytes);

}  // namespace tetproof::oracles
