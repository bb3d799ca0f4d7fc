#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "corpus/cli/commands.h"
#include "oracles/base/vectors.h"
#include "oracles/files/mesh_file.h"
#include "oracles/plane/file.h"
#include "reports/mesh_quality.h"
#include "reports/plane_quality.h"
#include "reports/poisson.h"

namespace tetproof {

namespace {

void demand_finite(bool finite, const std::string& file, std::size_t v) {
  if (!finite) throw std::runtime_error(fmt::format("{}: vertex {} is not finite", file, v));
}

std::string measured(const MeasureArguments& arguments) {
  if (arguments.plane) {
    const oracles::PlaneFile mesh = oracles::read_plane_file(arguments.mesh);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const auto& [x, y] = mesh.vertices[v];
      demand_finite(std::isfinite(x) && std::isfinite(y), arguments.mesh, v);
    }
    return to_json(measure_plane(mesh));
  }
  const oracles::MeshFile mesh = oracles::read_mesh(arguments.mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    demand_finite(oracles::is_finite(mesh.vertices[v]), arguments.mesh, v);
  }
  std::string json = to_json(measure(mesh));
  if (arguments.solver) {
    json.replace(json.rfind('}'), 1, ",\"solver\":" + to_json(solve_poisson(mesh)) + "}");
  }
  return json;
}

}  // namespace

int measure_command(const MeasureArguments& arguments) {
  if (arguments.plane && arguments.solver) throw UsageError("--solver: of tetrahedra alone");
  const std::string json = measured(arguments);
  if (arguments.output.empty()) {
    fmt::print("{}\n", json);
    return 0;
  }
  std::ofstream file(arguments.output);
  file << json << '\n';
  file.close();
  if (!file) throw std::runtime_error(arguments.output + ": cannot be written");
  return 0;
}

}  // namespace tetproof
