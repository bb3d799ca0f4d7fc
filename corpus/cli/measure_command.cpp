#include <fmt/core.h>

#include <fstream>
#include <stdexcept>

#include "corpus/cli/commands.h"
#include "oracles/base/vectors.h"
#include "oracles/files/mesh_file.h"
#include "reports/mesh_quality.h"
#include "reports/poisson.h"

namespace tetproof {

int measure_command(const MeasureArguments& arguments) {
  const oracles::MeshFile mesh = oracles::read_mesh(arguments.mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!oracles::is_finite(mesh.vertices[v])) {
      throw std::runtime_error(fmt::format("{}: vertex {} is not finite", arguments.mesh, v));
    }
  }
  std::string json = to_json(measure(mesh));
  if (arguments.solver) {
    json.replace(json.rfind('}'), 1, ",\"solver\":" + to_json(solve_poisson(mesh)) + "}");
  }
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
