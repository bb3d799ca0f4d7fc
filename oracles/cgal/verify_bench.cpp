// How long the oracles take for a tetrahedron, as a multiple of CGAL's plain Delaunay of the same
// vertices. Usage: verify_bench INPUT MESH [EXACT]. Both are measured in one run, reading left out.
#include <chrono>
#include <cstdio>
#include <exception>

#include "oracles/cgal/kernel_opinion.h"
#include "oracles/mesh_file.h"
#include "oracles/sidecar.h"
#include "oracles/surface_file.h"
#include "oracles/verify.h"

namespace tetproof::oracles {
namespace {

double seconds() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

// The time that has gone by since the last oracle is the next one's; so each line includes what
// had to be prepared for it.
void measure(const char* input_path, const char* mesh_path, const char* exact_path) {
  const Polyhedron input = read_surface(input_path);
  const MeshFile mesh = read_mesh(mesh_path);
  delmesher::ExactRecord record;
  if (exact_path != nullptr) record = read_sidecar(exact_path);
  double start = seconds();
  const std::size_t delaunay = cgal_delaunay(mesh.vertices).size();
  const double unit = (seconds() - start) / static_cast<double>(delaunay);
  std::printf("CGAL's Delaunay: %zu tetrahedra, %.3g microseconds each\n", delaunay, unit * 1e6);
  VerifyReport report;
  VerifyOptions options;
  if (exact_path != nullptr && !record.refined.empty()) options.stage = Stage::both;
  const double scale = 1 / (unit * static_cast<double>(mesh.tetrahedra.size()));
  double last = seconds();
  options.progress = [&](const OracleReport& oracle) {
    const double now = seconds();
    std::printf("%-32s %8.3f s  %7.2f\n", oracle.name.c_str(), now - last, (now - last) * scale);
    last = now;
  };
  start = last;
  verify(input, mesh, exact_path != nullptr ? &record : nullptr, options, report);
  const double all = seconds() - start;
  std::printf("%-32s %8.3f s  %7.2f times CGAL's Delaunay, per tetrahedron (%zu written)\n",
              verdict_name(report.verdict), all, all * scale, mesh.tetrahedra.size());
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
