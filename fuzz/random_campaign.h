// A campaign without instrumentation, with any compiler: inputs come from the target's mutator and
// a small pool of earlier ones. It sees no coverage, but an optimised build without sanitizers runs
// several times as many inputs per second, which finds what depends on numbers rather than on
// paths.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tetproof::fuzz {

struct RandomCampaign {
  double seconds = 60;
  std::uint64_t seed = 1;
  // Folder: SEED-NUMBER.input and SEED-NUMBER.txt, what the target said. Every input has a process
  // of its own then, and leniencies are not counted. If empty, all run in this process, which the
  // first finding ends.
  std::string findings;
  // Files, or folders of them, that half of the inputs are made from; with none, all come from the
  // pool, where files that are rejected for their first lines soon are alone.
  std::vector<std::string> seeds;
  unsigned seconds_each = 120;  // an input that takes longer is a finding too
};

// The files, and those in the folders, in order, as absolute paths. What does not exist is left
// out, with a line on the error stream.
std::vector<std::filesystem::path> files_of(std::span<const std::string> paths);

// Throws std::system_error if the file cannot be read.
std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path);

// Returns the number of findings; prints how many inputs there were and, per kind of finding, one
// line. Throws std::system_error where a file or a process cannot be made, or a seed not read.
std::uint64_t run_random_campaign(const RandomCampaign& campaign);

}  // namespace tetproof::fuzz
