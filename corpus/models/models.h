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
  std::vector<std::filesystem::path> duplicates;  // left out: same bytes as an earlier one
};

// Files are taken as they are, folders with all their .off, .obj, .stl and .ply files at any depth.
// Links to folders are followed, but a folder that several paths lead to is entered once. \throw
// std::runtime_error if a path does not exist or cannot be read, or a folder has no such file: it
// is most likely another folder than was meant.
ModelList collect_models(const std::vector<std::filesystem::path>& paths);

// Part `index` of `count` (1-based) in a division by hash. A model's part does not depend on the
// rest of the list.
std::vector<Model> shard_of(const std::vector<Model>& models, unsigned index, unsigned count);

// How much of a collection a campaign takes. Every tier is part of the next larger one.
enum class Tier : std::uint8_t {
  smoke,    // 30 models of at most 200 kB: minutes
  nightly,  // 300 of at most 5 MB: a night
  weekly    // all
};

// \throw std::runtime_error for anything but smoke, nightly and weekly.
Tier tier_from_name(const std::string& name);

// The first models by hash among those small enough, in the order of the list, so that a tier
// hardly changes when the collection grows.
std::vector<Model> tier_of(const std::vector<Model>& models, Tier tier);

}  // namespace tetproof
