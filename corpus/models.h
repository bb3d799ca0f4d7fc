// The models of a campaign: surface files, identified by the hash of their bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tetproof {

struct Model {
  std::filesystem::path path;  // absolute
  std::string name;            // relative to the folder that was given, or the file's name
  std::string sha256;
  std::uint64_t bytes = 0;
};

struct ModelList {
  std::vector<Model> models;  // in the order of the arguments, folders sorted by path
  std::vector<std::filesystem::path> duplicates;  // same bytes as an earlier one: left out
};

// Files are taken as they are; folders with all their .off, .obj, .stl and .ply files, at any
// depth. \throw std::runtime_error if a path does not exist or cannot be read.
ModelList collect_models(const std::vector<std::filesystem::path>& paths);

// Part `index` of `count` (1-based) in a division by hash, the same whatever else is in the list.
std::vector<Model> shard_of(const std::vector<Model>& models, unsigned index, unsigned count);

}  // namespace tetproof
