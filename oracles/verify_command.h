// tetproof verify INPUT MESH [--exact FILE] [--promised COMMAND] [--stage refined|final]
//                 [--threads N] [--json]
#pragma once

namespace tetproof {

// GMP ends the program where it gets no memory; out of its allocation functions an exception may be
// thrown all the same, which leaves only the number in hand undefined. From now on it throws
// std::bad_alloc. For the main function, before anything else.
void survive_lack_of_memory();

// argv[0] is "verify". Exit codes: 0 verified, 1 a check failed, 2 usage, 3 a file is unreadable or
// malformed, 4 the input is no valid surface, 5 not enough memory, 6 internal error. Throws
// std::bad_alloc where there is not even memory for the arguments.
int run_verify(int argc, char** argv);

}  // namespace tetproof
