// tetproof-poisson MESH...: conjugate gradients on the Poisson equation with linear elements. A
// line of JSON each.
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "reports/poisson.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: tetproof-poisson MESH...\n", stderr);
    return 2;
  }
  try {
    for (int i = 1; i < argc; ++i) {
      constexpr unsigned kAnyNumber = -1;
      fmt::print("{}\n", tetproof::to_json(tetproof::solve_poisson(
                             tetproof::oracles::read_mesh(argv[i]), kAnyNumber)));
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "tetproof-poisson: {}\n", error.what());
    return 1;
  }
  return 0;
}
