// A campaign without instrumentation, with any compiler: inputs come from the target's mutator and
// a small pool of earlier ones. It sees no coverage, but an optimised build without sanitizers runs
// several times as many inputs per second, which finds what depends on numbers rather than on
// paths. Leniencies are not counted.
#pragma once

#include <cstdint>
#include <string>

namespace tetproof::fuzz {

struct RandomCampaign {
  double seconds = 60;
  std::uint64_t seed = 1;
  std::string findings;         // folder: NUMBER.input and NUMBER.txt, what the target said
  unsigned seconds_each = 120;  // an input that takes longer is a finding
};

// Runs every input in a process of its own. Returns the number of findings; prints how many inputs
// there were and, per kind of finding, one line. Throws std::system_error where a file or a process
// cannot be made.
std::uint64_t run_random_campaign(const RandomCampaign& campaign);

}  // namespace tetproof::fuzz
