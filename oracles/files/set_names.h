// Names of the sets of a mesh: of labels and of regions.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "oracles/verdict/report.h"

namespace tetproof::oracles {

// By dimension, 2 of labels and 3 of regions, and number.
using SetNames = std::map<std::pair<int, std::int64_t>, std::string>;

// Compares what sets are called with what they were called, for the numbers of `dimension` that are
// there; names that were not in UTF-8 were in Latin-1. Of equal names all but the first get a
// number, by which programs tell them apart. Blanks, and characters that cannot be printed, count
// as one blank; quotation marks as apostrophes, which .msh has in their place. "label N" of label
// N, "region N" of region N are not names, nor are those of the two sides.
void compare_names(const SetNames& wanted, const SetNames& found, int dimension,
                   const std::vector<std::int64_t>& numbers, OracleReport& report);

// Is a set called so, or, as all but the first set of a name in a file, with a number after it?
bool is_called(const std::string& name, const std::string& wanted);

}  // namespace tetproof::oracles
