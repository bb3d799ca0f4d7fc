#include <fmt/core.h>

#include "corpus/cli/commands.h"
#include "corpus/generators/generate.h"
#include "corpus/generators/planar_graphs.h"
#include "oracles/files/surface_file.h"

namespace tetproof {
namespace {

int list_families() {
  for (const auto* group : {&families(), &sampled_families()}) {
    for (const Family& family : *group) fmt::print("{:<16} {}\n", family.name, family.description);
  }
  fmt::print("{}\n", kPlanarFamilies);
  return 0;
}

std::vector<const Family*> chosen_families(const GenerateArguments& arguments) {
  std::vector<const Family*> chosen;
  for (const std::string& name : arguments.families) {
    if (name == "all") {
      for (const Family& family : families()) chosen.push_back(&family);
    } else if (const Family* family = find_family(name)) {
      chosen.push_back(family);
    } else if (!is_planar_family(name)) {
      throw UsageError("unknown family: " + name + " (see generate --list)");
    }
  }
  if (arguments.families.empty()) {
    throw UsageError("a family is expected (see generate --list), or all");
  }
  if (arguments.folder.empty()) throw UsageError("-o DIR is expected");
  return chosen;
}

}  // namespace

int generate_command(const GenerateArguments& arguments) {
  if (arguments.list) return list_families();
  GenerateRequest request;
  request.families = chosen_families(arguments);
  request.seed = arguments.seed;
  request.first = arguments.first;
  request.count = arguments.count;
  request.twins = arguments.twins;
  request.folder = arguments.folder;
  for (const std::string& model : arguments.models) {
    const oracles::Polyhedron read = oracles::read_surface(model);
    request.models.push_back({read.vertices, read.triangles, read.labels});
  }
  std::size_t graphs = 0;
  for (const std::string& name : arguments.families) {
    if (!is_planar_family(name)) continue;
    graphs += write_planar_graphs(name, arguments.first, arguments.count, arguments.folder);
  }
  if (graphs > 0) fmt::print("{} planar graphs in {}\n", graphs, arguments.folder);
  if (request.families.empty()) return 0;
  const GenerateSummary summary = generate_files(request);
  fmt::print("{} valid polyhedra and {} invalid twins in {}\n", summary.valid, summary.twins,
             arguments.folder);
  for (const std::string& name : summary.missing) fmt::print("could not be made: {}\n", name);
  return summary.missing.empty() ? 0 : 1;
}

}  // namespace tetproof
