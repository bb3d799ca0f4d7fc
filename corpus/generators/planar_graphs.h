// Planar graphs for meshers of the plane (oracles/plane/shapes.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace tetproof {

inline constexpr const char* kPlanarFamilies =
    "In the plane, FAMILY:SIZE: koch, star, comb, fan, rough, nested, archipelago; and figure (the "
    "paper's figure 2) and tiny-angles.";

bool is_planar_family(const std::string& name);

// Writes FAMILY-SIZE.poly, or .txt (rings) where faces are inside by parity; of tiny-angles `count`
// members from number `first` on. Makes the folder. Returns how many. \throw std::runtime_error if
// a file cannot be written.
std::size_t write_planar_graphs(const std::string& name, std::uint64_t first, std::uint64_t count,
                                const std::filesystem::path& folder);

}  // namespace tetproof
