#include <fmt/core.h>

#include <fstream>
#include <memory>

#include "corpus/cli/commands.h"
#include "reports/mesh_quality.h"

namespace tetproof {

Command add_measure_command(CLI::App& tetproof) {
  struct Options {
    std::string mesh, output;
  };
  auto options = std::make_shared<Options>();
  CLI::App* app =
      tetproof.add_subcommand("measure", "Angles, counts and orientation of a mesh file, as JSON");
  app->add_option("mesh", options->mesh, "A .mesh, .msh, .vtu, .node or .tet file")->required();
  app->add_option("-o,--output", options->output, "Where to write it (default: standard output)");
  return {app, [options] {
            const std::string json = to_json(measure(oracles::read_mesh(options->mesh)));
            if (options->output.empty()) {
              fmt::print("{}\n", json);
              return 0;
            }
            std::ofstream file(options->output);
            file << json << '\n';
            file.close();
            if (!file) throw std::runtime_error(options->output + ": cannot be written");
            return 0;
          }};
}

}  // namespace tetproof
