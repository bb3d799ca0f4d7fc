// Archives for readers of archives, so that a fuzzer need not find checksums.
#pragma once

#include <string>

namespace tetproof::fuzz {

// A package of 3MF with this model.
std::string package_of(const std::string& model);

}  // namespace tetproof::fuzz
