// tetproof-floor SIDECAR...: the plain Delaunay tetrahedrization of the final vertices of a run
// (`delmesher mesh --exact SIDECAR`) in three ways: by CGAL, by the mesher's kernel on the same
// doubles, and by that kernel on the points as they are defined. One line of JSON each; the best of
// three runs.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <functional>

#include "oracles/files/sidecar.h"
#include "reports/benchmark/floor.h"

namespace tetproof::benchmark {
namespace {

Timing best_of_three(const std::function<Timing()>& measure) {
  Timing best = measure();
  for (int i = 0; i < 2; ++i) {
    const Timing next = measure();
    if (next.seconds < best.seconds) best = next;
  }
  return best;
}

void report(const char* path) {
  const FinalPoints points(oracles::read_sidecar(path));
  const Timing cgal = best_of_three([&] { return cgal_delaunay(points.nearest); });
  const Timing own = best_of_three([&] { return own_delaunay(points.nearest); });
  const Timing mixed = best_of_three([&] { return points.own_delaunay(); });
  fmt::print(
      "{{\"vertices\": {}, \"cgal_tetrahedra\": {}, \"cgal_seconds\": {:.6f}, "
      "\"explicit_tetrahedra\": {}, \"explicit_seconds\": {:.6f}, \"mixed_tetrahedra\": {}, "
      "\"mixed_seconds\": {:.6f}}}\n",
      points.used.size(), cgal.tetrahedra, cgal.seconds, own.tetrahedra, own.seconds,
      mixed.tetrahedra, mixed.seconds);
}

}  // namespace
}  // namespace tetproof::benchmark

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: tetproof-floor SIDECAR...\n", stderr);
    return 2;
  }
  try {
    for (int i = 1; i < argc; ++i) tetproof::benchmark::report(argv[i]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "tetproof-floor: {}\n", error.what());
    return 3;
  }
  return 0;
}
