// SHA-256, which identifies models and binaries.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tetproof {

// Both in lower-case hexadecimal.
std::string sha256_of(std::string_view text);

// \throw std::runtime_error if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace tetproof
