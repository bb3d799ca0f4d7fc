// tetproof-netgen SWITCHES INPUT OUT.mesh STATS.json: Netgen fills the surface as it is, as in the
// example ng_vol of its documentation (no upper bound on sizes but the grading). SWITCHES: "-" for
// its defaults, "raw" for no step of volume optimization.
#include <cstddef>
namespace nglib {
#include <netgen/nglib.h>
}

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "corpus/peers/programs/adapter.h"
#include "oracles/surface/input_surface.h"

namespace {

// The triangles, each oriented away from the inside as parity has it: Netgen needs that, and a
// surface may have some of its shells the other way round.
std::vector<std::array<std::uint32_t, 3>> oriented(const delmesher::Surface& surface) {
  tetproof::oracles::Polyhedron polyhedron;
  for (const auto& vertex : surface.vertices) polyhedron.vertices.push_back(vertex);
  for (const auto& triangle : surface.triangles) polyhedron.triangles.push_back(triangle);
  tetproof::oracles::ExactPoints points;
  std::string why = points.assign(polyhedron.vertices);
  tetproof::oracles::InputSurface input;
  if (why.empty()) why = input.assign(polyhedron, points);
  if (!why.empty()) throw std::runtime_error(why);
  return input.triangles();
}

void fill(nglib::Ng_Mesh* mesh, const delmesher::Surface& surface) {
  for (std::array<double, 3> vertex : surface.vertices) nglib::Ng_AddPoint(mesh, vertex.data());
  for (const auto& triangle : oriented(surface)) {
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
      return "error in the surface";
    case nglib::NG_VOLUME_FAILURE:
      return "volume meshing failed";
    default:
      return "error";
  }
}

delmesher::TetMesh mesh(const delmesher::Surface& surface, bool raw) {
  nglib::Ng_Init();
  nglib::Ng_Mesh* mesh = nglib::Ng_NewMesh();
  fill(mesh, surface);
  nglib::Ng_Meshing_Parameters parameters;
  parameters.maxh = 1e6;
  if (raw) parameters.optsteps_3d = 0;
  const nglib::Ng_Result result = nglib::Ng_GenerateVolumeMesh(mesh, &parameters);
  if (result != nglib::NG_OK) throw std::runtime_error(meaning(result));
  return take(mesh);
}

}  // namespace

int main(int argc, char** argv) {
  return tetproof::adapter::run({"tetproof-netgen", "Netgen", NETGEN_VERSION, mesh}, argc, argv);
}
