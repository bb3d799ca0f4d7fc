// A folder for the files of a target.
#pragma once

#include <filesystem>

namespace tetproof::fuzz {

// A folder of this process, removed at its end.
const std::filesystem::path& scratch();

}  // namespace tetproof::fuzz
