// Measures how long the oracles take, as a multiple of CGAL's plain Delaunay of the mesh's
// vertices, and how much memory. Usage: verify_bench INPUT MESH [EXACT]. Both are measured in one
// run, in processor time, because other programs change that less; reading is left out of the time,
// and CGAL's Delaunay, which a process of its own computes, out of the memory.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <string>

#include "oracles/base/heap.h"
#include "oracles/cgal/kernel_opinion.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/sidecar.h"
#include "oracles/files/surface_file.h"
#include "oracles/verify.h"

namespace tetproof::oracles {
namespace {

double seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The peak of memory, in megabytes: since it was asked for last where Linux forgets it on demand,
// elsewhere so far.
double peak_since_last() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  double kilobytes = static_cast<double>(usage.ru_maxrss);
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) kilobytes = std::strtod(line.c_str() + 6, nullptr);
  }
  std::ofstream("/proc/self/clear_refs") << 5;
  return 1024e-6 * kilobytes;
}

struct Delaunay {
  double seconds = 0;
  std::size_t tetrahedra = 0;
};

// All zero if the process fails.
Delaunay measure_delaunay(const char* mesh_path) {
  Delaunay result;
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    const MeshFile mesh = read_mesh(mesh_path);
    const double start = seconds();
    result.tetrahedra = cgal_delaunay(mesh.vertices).size();
    result.seconds = seconds() - start;
    const bool sent = write(ends[1], &result, sizeof result) == sizeof result;
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  if (read(ends[0], &result, sizeof result) != sizeof result) result = {};
  close(ends[0]);
  if (child > 0) waitpid(child, nullptr, 0);
  return result;
}

// The time and the peak of memory since the last oracle are counted for the next one, so each line
// includes what had to be prepared for it.
void measure(const char* input_path, const char* mesh_path, const char* exact_path) {
  return_large_blocks();
  const auto [unit, delaunay] = measure_delaunay(mesh_path);
  const Polyhedron input = read_surface(input_path);
  MeshFile mesh = read_mesh(mesh_path);
  delmesher::ExactRecord record;
  if (exact_path != nullptr) record = read_sidecar(exact_path);
  double peak = peak_since_last();
  std::printf("%-32s %42.1f MB\n", "reading", peak);
  std::printf("CGAL's Delaunay: %.3f s for %zu tetrahedra; %zu are written\n", unit, delaunay,
              mesh.tetrahedra.size());
  VerifyReport report;
  VerifyOptions options;
  if (exact_path != nullptr && !record.refined.empty()) options.stage = Stage::both;
  const double start = seconds();
  double last = start;
  options.progress = [&, unit = unit](const OracleReport& oracle) {
    const double now = seconds(), here = peak_since_last();
    peak = std::max(peak, here);
    std::printf("%-32s %8.3f s  %7.2f  %20.1f MB\n", oracle.name.c_str(), now - last,
                (now - last) / unit, here);
    last = now;
  };
  const auto written = static_cast<double>(mesh.tetrahedra.size());
  delmesher::ExactRecord* exact = exact_path != nullptr ? &record : nullptr;
  verify(input, mesh, exact, options, report, {&mesh, exact});
  const double all = seconds() - start;
  peak = std::max(peak, peak_since_last());
  std::printf("%-32s %8.3f s  %7.2f times CGAL's Delaunay\n", verdict_name(report.verdict), all,
              all / unit);
  std::printf("at most %.1f MB, what was read included: %.0f bytes per tetrahedron\n", peak,
              1e6 * peak / written);
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
