#include "corpus/peers/programs/adapter.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <utility>

#include "mesher/delmesher_files.h"
#include "mesher/io/write_mesh.h"

namespace tetproof::adapter {
namespace {

bool positive(const delmesher::TetMesh& mesh, const std::array<std::uint32_t, 4>& t) {
  double e[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int c = 0; c < 3; ++c) e[i][c] = mesh.vertices[t[i + 1]][c] - mesh.vertices[t[0]][c];
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
             e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
             e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]) >
         0;
}

void write_statistics(const std::string& path, const delmesher::Surface& surface,
                      const delmesher::TetMesh& mesh, double read, double meshing, double write) {
  std::ofstream out(path);
  out.precision(9);
  const auto inside = std::count(mesh.inside.begin(), mesh.inside.end(), 1);
  out << "{\"input\": {\"vertices\": " << surface.vertices.size()
      << ", \"triangles\": " << surface.triangles.size() << "}, \"status\": \"ok\", "
      << "\"phases_seconds\": {\"read\": " << read << ", \"tetrahedralize\": " << meshing
      << ", \"write\": " << write << "}, \"final\": {\"vertices\": " << mesh.vertices.size()
      << ", \"tetrahedra\": " << mesh.tetrahedra.size() << ", \"interior_tetrahedra\": " << inside
      << "}}\n";
}

// Without the end of static objects: what a library of a peer leaves behind is not to be judged
// here.
[[noreturn]] void end(int code) {
  std::fflush(nullptr);
  _exit(code);
}

}  // namespace

void finish(const Call& call, int code, const std::string& file, const std::string& reason) {
  if (code != 0) {
    std::fprintf(stderr, "%s: %s: %s\n", call.program.c_str(), file.c_str(), reason.c_str());
  }
  end(code);
}

delmesher::Surface read(const Call& call) {
  delmesher::io::ReadResult read = delmesher::io::read_surface(call.input);
  if (!read.ok()) finish(call, 3, call.input, read.error);
  return std::move(read.surface);
}

void orient(delmesher::TetMesh& mesh) {
  const auto count = std::count_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(),
                                   [&](const auto& t) { return positive(mesh, t); });
  if (2 * static_cast<std::size_t>(count) >= mesh.tetrahedra.size()) return;
  for (auto& t : mesh.tetrahedra) std::swap(t[2], t[3]);
}

void deliver(const Call& call, const delmesher::Surface& surface, const delmesher::TetMesh& mesh,
             double reading, double meshing) {
  const Stopwatch writing;
  delmesher::io::OutputSet outputs;
  delmesher::io::WriteStatus status = delmesher::io::write_mesh(outputs, call.output, mesh);
  if (status.ok()) status = outputs.commit();
  if (!status.ok()) finish(call, 3, call.output, status.error);
  write_statistics(call.stats, surface, mesh, reading, meshing, writing.seconds());
  finish(call, 0, call.input, "");
}

int run(const Peer& peer, int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--version") == 0) {
    std::printf("%s %s\n", peer.name, peer.version);
    end(0);
  }
  const std::string switches = argc == 5 ? argv[1] : "";
  if (switches != "-" && switches != "raw") {
    std::fprintf(stderr, "usage: %s -|raw INPUT OUT.mesh STATS.json\n", peer.program);
    return 2;
  }
  const Call call = {peer.program, switches, argv[2], argv[3], argv[4]};
  const Stopwatch reading;
  const delmesher::Surface surface = read(call);
  const double read_seconds = reading.seconds();
  const Stopwatch meshing;
  try {
    const delmesher::TetMesh mesh = peer.mesh(surface, switches == "raw");
    deliver(call, surface, mesh, read_seconds, meshing.seconds());
  } catch (const std::bad_alloc&) {
    finish(call, 5, call.input, "out of memory");
  } catch (const std::exception& error) {
    finish(call, 4, call.input, std::string(peer.name) + ": " + error.what());
  }
}

}  // namespace tetproof::adapter
