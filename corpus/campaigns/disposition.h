// The disposition of a run, judged by how the child ended. The mesh is judged afterwards, from the
// file.
#pragma once

#include <cstdint>
#include <string>

#include "corpus/campaigns/supervise/supervisor.h"
#include "reports/results.h"

namespace tetproof {

enum class ExitCodes : std::uint8_t {
  ours,    // delmesher's: 1 mesh with inverted tetrahedra, 3 and 4 bad input, 5 limit, 6 bug
  unknown  // 0 is success, 128 and a signal that crashes make a crash, anything else is a refusal
};

struct Judgement {
  Disposition disposition = Disposition::ok;
  std::string reason;
  bool mesh_expected = false;  // a file should be there, to be measured
};

Judgement judge(const Outcome& outcome, ExitCodes codes);

// The last line of a text that is not blank.
std::string last_line(const std::string& text);

}  // namespace tetproof
