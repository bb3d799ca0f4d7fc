// tetproof-netgen SWITCHES INPUT OUT.mesh STATS.json: Netgen fills the surface as it is, as in the
// example ng_vol of its documentation (no upper bound on sizes but the grading). SWITCHES: "-" for
// its defaults, "raw" for no step of volume optimization.
#include <cstddef>
namespace nglib {
#include <netgen/nglib.h>
}

#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "corpus/peer_adapters/adapter.h"

namespace {

using tetproof::adapter::Call;
using tetproof::adapter::finish;

void fill(nglib::Ng_Mesh* mesh, const delmesher::Surface& surface) {
  for (std::array<double, 3> vertex : surface.vertices) nglib::Ng_AddPoint(mesh, vertex.data());
  for (const auto& triangle : surface.triangles) {
    std::array<int, 3> corners;  // counted from 1
    for (std::size_t i = 0; i < 3; ++i) corners[i] = static_cast<int>(triangle[i]) + 1;
    nglib::Ng_AddSurfaceElement(mesh, nglib::NG_TRIG, corners.data());
  }
}

delmesher::TetMesh take(nglib::Ng_Mesh* mesh) {
  delmesher::TetMesh taken;
  taken.vertices.resize(static_cast<std::size_t>(nglib::Ng_GetNP(mesh)));
  for (std::size_t i = 0; i < taken.vertices.size(); ++i) {
    nglib::Ng_GetPoint(mesh, static_cast<int>(i) + 1, taken.vertices[i].data());
  }
  taken.tetrahedra.resize(static_cast<std::size_t>(nglib::Ng_GetNE(mesh)));
  for (std::size_t i = 0; i < taken.tetrahedra.size(); ++i) {
    std::array<int, NG_VOLUME_ELEMENT_MAXPOINTS> corners{};
    nglib::Ng_GetVolumeElement(mesh, static_cast<int>(i) + 1, corners.data());
    for (std::size_t c = 0; c < 4; ++c) {
      taken.tetrahedra[i][c] = static_cast<std::uint32_t>(corners[c] - 1);
    }
  }
  taken.inside.assign(taken.tetrahedra.size(), 1);
  tetproof::adapter::orient(taken);
  return taken;
}

const char* meaning(nglib::Ng_Result result) {
  switch (result) {
    case nglib::NG_SURFACE_INPUT_ERROR:
      return "Netgen: error in the surface";
    case nglib::NG_VOLUME_FAILURE:
      return "Netgen: volume meshing failed";
    default:
      return "Netgen: error";
  }
}

[[noreturn]] void run(const Call& call) {
  const tetproof::adapter::Stopwatch reading;
  const delmesher::Surface surface = tetproof::adapter::read(call);
  const double read_seconds = reading.seconds();
  const tetproof::adapter::Stopwatch meshing;
  try {
    nglib::Ng_Init();
    nglib::Ng_Mesh* mesh = nglib::Ng_NewMesh();
    fill(mesh, surface);
    nglib::Ng_Meshing_Parameters parameters;
    parameters.maxh = 1e6;
    if (call.switches == "raw") parameters.optsteps_3d = 0;
    const nglib::Ng_Result result = nglib::Ng_GenerateVolumeMesh(mesh, &parameters);
    if (result != nglib::NG_OK) finish(call, 4, call.input, meaning(result));
    const delmesher::TetMesh taken = take(mesh);
    tetproof::adapter::deliver(call, surface, taken, read_seconds, meshing.seconds());
  } catch (const std::bad_alloc&) {
    finish(call, 5, call.input, "out of memory");
  } catch (const std::exception& error) {
    finish(call, 4, call.input, std::string("Netgen: ") + error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--version") == 0) {
    std::puts("Netgen " NETGEN_VERSION);
    return 0;
  }
  const std::string switches = argc == 5 ? argv[1] : "";
  if (switches != "-" && switches != "raw") {
    std::fputs("usage: tetproof-netgen -|raw INPUT OUT.mesh STATS.json\n", stderr);
    return 2;
  }
  run({"tetproof-netgen", switches, argv[2], argv[3], argv[4]});
}
