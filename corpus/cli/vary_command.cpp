#include <fmt/core.h>

#include <filesystem>
#include <stdexcept>

#include "corpus/cli/commands.h"
#include "corpus/generate/certify.h"
#include "corpus/generate/generate.h"
#include "corpus/generate/vary.h"
#include "corpus/models.h"
#include "oracles/surface_file.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

struct Summary {
  std::size_t given = 0, copies = 0, left_out = 0;
};

// `name`: a path within the folder, without extension.
void vary(const fs::path& file, const std::string& name, const fs::path& folder, Summary& sum) {
  const auto leave_out = [&](const std::string& which, const char* why) {
    fmt::print("left out: {}: {}\n", which, why);
    ++sum.left_out;
  };
  const oracles::Polyhedron read = oracles::read_surface(file);
  const delmesher::Surface given{read.vertices, read.triangles, read.labels};
  if (!certified_valid(given)) return leave_out(name, "no valid surface");
  write_off(folder / (name + ".off"), given);
  ++sum.given;
  for (const ExactCopy& copy : exact_copies(given)) {
    const std::string copy_name = fmt::format("{}@{}", name, copy.suffix);
    if (!copy.surface) {
      leave_out(copy_name, "not in doubles");
      continue;
    }
    // An exact copy is as valid as what it is a copy of.
    if (!certified_valid(*copy.surface)) throw std::logic_error(copy_name + ": not valid");
    write_off(folder / (copy_name + ".off"), *copy.surface);
    ++sum.copies;
  }
}

}  // namespace

int vary_command(const VaryArguments& arguments) {
  Summary sum;
  for (const Model& model :
       collect_models({arguments.paths.begin(), arguments.paths.end()}).models) {
    vary(model.path, fs::path(model.name).replace_extension(), arguments.folder, sum);
  }
  fmt::print("{} surfaces and {} exact copies in {}, {} left out\n", sum.given, sum.copies,
             arguments.folder, sum.left_out);
  return sum.given > 0 ? 0 : 1;
}

}  // namespace tetproof
