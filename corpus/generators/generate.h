// Certified members of the families, and writing them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corpus/generators/families.h"
#include "mesher/delmesher.h"

namespace tetproof {

// Member number `index` of a family, certified valid; the same for the same arguments on every
// machine. Nothing if no candidate passed, which is a defect of the family.
std::optional<delmesher::Surface> generate(const Family& family, std::uint64_t seed,
                                           std::uint64_t index,
                                           const std::vector<delmesher::Surface>& models = {});

// OFF with shortest round-trip coordinates; `hex` adds the exact values as comments.
std::string to_off(const delmesher::Surface& surface, const std::string& comment = {},
                   bool hex = false);

// Writes that, and makes the folder. \throw std::runtime_error if it cannot be written.
void write_off(const std::filesystem::path& path, const delmesher::Surface& surface,
               const std::string& comment = {}, bool hex = false);

struct GenerateRequest {
  std::vector<const Family*> families;
  std::uint64_t seed = 1, first = 0, count = 10;
  bool twins = false;
  std::filesystem::path folder;
  std::vector<delmesher::Surface> models;
};

struct GenerateSummary {
  std::uint64_t valid = 0, twins = 0;
  std::vector<std::string> missing;  // members or twins that could not be made
};

// Writes FAMILY-SEED-INDEX.off, twins as twins/FAMILY-SEED-INDEX-KIND.off, and manifest.csv with
// what to expect of each. \throw std::runtime_error if a file cannot be written.
GenerateSummary generate_files(const GenerateRequest& request);

}  // namespace tetproof
