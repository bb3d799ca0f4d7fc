// Measures how long the oracles take, as a multiple of CGAL's plain Delaunay of the mesh's
// vertices, and how much memory. Usage: verify_bench INPUT MESH [EXACT]. Both are measured in one
// run, in processor time, because other programs change that less; reading is left out of the time.
#include <sys/resource.h>

#include <cstdio>
#include <ctime>
#include <exception>

#include "oracles/cgal/kernel_opinion.h"
#include "oracles/mesh_file.h"
#include "oracles/sidecar.h"
#include "oracles/surface_file.h"
#include "oracles/verify.h"

namespace tetproof::oracles {
namespace {

double seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The peak of memory so far.
double megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024e-6 * static_cast<double>(usage.ru_maxrss);
}

// The time since the last oracle is counted for the next one, so each line includes what had to be
// prepared for it.
void measure(const char* input_path, const char* mesh_path, const char* exact_path) {
  const Polyhedron input = read_surface(input_path);
  const MeshFile mesh = read_mesh(mesh_path);
  delmesher::ExactRecord record;
  if (exact_path != nullptr) record = read_sidecar(exact_path);
  std::printf("%-32s %42.1f MB\n", "reading", megabytes());
  double start = seconds();
  const std::size_t delaunay = cgal_delaunay(mesh.vertices).size();
  const double unit = seconds() - start;
  std::printf("CGAL's Delaunay: %.3f s for %zu tetrahedra; %zu are written\n", unit, delaunay,
              mesh.tetrahedra.size());
  VerifyReport report;
  VerifyOptions options;
  if (exact_path != nullptr && !record.refined.empty()) options.stage = Stage::both;
  double last = seconds();
  options.progress = [&](const OracleReport& oracle) {
    const double now = seconds();
    std::printf("%-32s %8.3f s  %7.2f  %20.1f MB\n", oracle.name.c_str(), now - last,
                (now - last) / unit, megabytes());
    last = now;
  };
  start = last;
  verify(input, mesh, exact_path != nullptr ? &record : nullptr, options, report);
  const double all = seconds() - start;
  std::printf("%-32s %8.3f s  %7.2f times CGAL's Delaunay\n", verdict_name(report.verdict), all,
              all / unit);
  std::printf("at most %.1f MB, CGAL's and what was read included: %.0f bytes per tetrahedron\n",
              megabytes(), 1e6 * megabytes() / static_cast<double>(mesh.tetrahedra.size()));
}

}  // namespace
}  // namespace tetproof::oracles

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fputs("usage: verify_bench INPUT MESH [EXACT]\n", stderr);
    return 2;
  }
  try {
    tetproof::oracles::measure(argv[1], argv[2], argc == 4 ? argv[3] : nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "verify_bench: %s\n", error.what());
    return 3;
  }
  return 0;
}
