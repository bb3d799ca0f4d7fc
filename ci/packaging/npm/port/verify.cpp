// `tetproof`, with the command `verify` alone.
#include "oracles/verify_command.h"

#include <cstdio>
#include <string_view>

int main(int argc, char** argv) {
  if (argc < 2 || std::string_view(argv[1]) != "verify") {
    std::fputs("tetproof: this build has the command verify alone\n", stderr);
    return 2;
  }
  tetproof::survive_lack_of_memory();
  return tetproof::run_verify(argc - 1, argv + 1);
}
