// tetproof verify INPUT MESH [--exact FILE] [--stage refined|final] [--threads N] [--json]
#pragma once

namespace tetproof {

// argv[0] is "verify". Exit codes: 0 verified, 1 a check failed, 2 usage, 3 a file is unreadable or
// malformed, 4 the input is no valid surface.
int run_verify(int argc, char** argv);

}  // namespace tetproof
