// tetproof verify INPUT MESH [--exact FILE] [--promised COMMAND] [--stage refined|final]
//                 [--declared-deviation SHARE] [--threads N] [--json]
#pragma once

namespace tetproof {

// From now on GMP throws std::bad_alloc where it gets no memory; by default it ends the program. An
// exception may be thrown out of its allocation functions, because it leaves only the number in
// hand undefined. For the main function, before anything else.
void survive_lack_of_memory();

// argv[0] is "verify". Exit codes: 0 verified, 1 a check failed, 2 usage, 3 a file is unreadable or
// malformed, 4 the input is not a valid surface, 5 the file alone leaves the verdict undecided, or
// a limit of memory or size was reached, 6 internal error. Throws std::bad_alloc where there is not
// even memory for the arguments.
int run_verify(int argc, char** argv);

}  // namespace tetproof
