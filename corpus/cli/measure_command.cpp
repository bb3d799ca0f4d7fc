#include <fmt/core.h>

#include <fstream>

#include "corpus/cli/commands.h"
#include "reports/mesh_quality.h"

namespace tetproof {

int measure_command(const MeasureArguments& arguments) {
  const std::string json = to_json(measure(oracles::read_mesh(arguments.mesh)));
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
