// Decides for files whether each is a valid surface: closed, manifold, oriented, without
// self-intersections; and writes the manifest of a collection. This is how the paper's 3942 models
// are derived from Thingi10K.
//
// Laws: the manifest depends on the files only, not on the order or number of jobs; a file that is
// in the manifest already, with the same bytes, is not looked at again; every file of a folder is
// in it, also those that cannot be read.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "corpus/campaigns/supervise/supervisor.h"
#include "corpus/models/models.h"

namespace tetproof {

enum class Validity : std::uint8_t {
  valid,
  invalid,     // a surface, but not a valid one
  unreadable,  // no surface at all
  undecided    // the check reached a limit or failed
};

struct Classification {
  std::string file, sha256, licence;
  std::uint64_t bytes = 0;
  Validity validity = Validity::undecided;
  std::optional<std::uint64_t> vertices, triangles, components;
  std::map<std::string, std::uint64_t> defects;  // by kind, for example "open edge"
  std::string reason;                            // the first defect, or why it is not readable

  // Nothing if the check did not get that far.
  std::optional<bool> closed() const;
  std::optional<bool> manifold() const;
  std::optional<bool> oriented() const;
  std::optional<bool> self_intersecting() const;
};

struct ClassifyOptions {
  std::filesystem::path supervisor, delmesher;
  std::filesystem::path scratch;  // folder for files of the children
  unsigned jobs = 1;
  Limits limits = {.wall_seconds = 300, .cpu_seconds = 300, .memory_bytes = 4ull << 30};
};

// Judges by `delmesher check`, in a child process per file. Stops early after interrupt_campaign(),
// with the results so far. `done` is called for each in the order in which they end.
std::vector<Classification> classify(const std::vector<Model>& models,
                                     const ClassifyOptions& options,
                                     const std::function<void(const Classification&)>& done);

// The manifest, sorted by file name.
std::string manifest_csv(std::vector<Classification> all);
std::string manifest_json(std::vector<Classification> all);

// A manifest written before. Unknown columns are ignored. \throw std::runtime_error if it is none.
std::vector<Classification> read_manifest(const std::filesystem::path& path);

const char* validity_name(Validity validity);

}  // namespace tetproof
