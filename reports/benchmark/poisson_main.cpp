// tetproof-poisson MESH...: conjugate gradients on the Poisson equation with linear elements. A
// line of JSON each.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <exception>

#include "reports/benchmark/poisson.h"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: tetproof-poisson MESH...\n", stderr);
    return 2;
  }
  try {
    for (int i = 1; i < argc; ++i) {
      const auto run = tetproof::benchmark::solve_poisson(tetproof::oracles::read_mesh(argv[i]));
      fmt::print(
          "{{\"tetrahedra\": {}, \"unknowns\": {}, \"iterations\": {}, \"converged\": {}, "
          "\"per_root\": {:.4f}, \"largest_error\": {:.3e}, \"mean_error\": {:.3e}}}\n",
          run.tetrahedra, run.unknowns, run.iterations, run.converged,
          run.iterations / std::cbrt(static_cast<double>(run.unknowns)), run.largest_error,
          run.mean_error);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "tetproof-poisson: {}\n", error.what());
    return 1;
  }
  return 0;
}
