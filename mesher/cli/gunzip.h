// Input that is compressed with gzip, if the program is built with zlib.
#pragma once

#include <functional>

#include "mesher/delmesher_files.h"

namespace delmesher::cli {

// For ReadOptions::gunzip; `go_on` is asked many times a second, and ends it. Null without zlib.
io::Gunzip gunzip(const std::function<bool()>& go_on);

}  // namespace delmesher::cli
