#include <fmt/core.h>

#include <filesystem>

#include "corpus/cli/commands.h"
#include "corpus/generate/certify.h"
#include "corpus/generate/generate.h"
#include "corpus/generate/rotate.h"
#include "corpus/models.h"
#include "oracles/surface_file.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

struct Summary {
  std::size_t given = 0, rotated = 0, left_out = 0;
};

// `name`: a path within the folder, without extension.
void rotate(const fs::path& file, const std::string& name, const fs::path& folder, Summary& sum) {
  const auto leave_out = [&](const std::string& which, const char* why) {
    fmt::print("left out: {}: {}\n", which, why);
    ++sum.left_out;
  };
  const oracles::Polyhedron read = oracles::read_surface(file);
  const delmesher::Surface given{read.vertices, read.triangles, read.labels};
  if (!certified_valid(given)) return leave_out(name, "no valid surface");
  write_off(folder / (name + ".off"), given);
  ++sum.given;
  for (std::size_t r = 0; r < kRotations.size(); ++r) {
    for (const Precision precision : {Precision::doubles, Precision::single}) {
      const std::string copy =
          fmt::format("{}@r{}{}", name, r + 1, precision == Precision::single ? "s" : "");
      const delmesher::Surface surface = rotated(given, kRotations[r], precision);
      if (!certified_valid(surface)) {
        leave_out(copy, "not valid once it is rounded");
        continue;
      }
      write_off(folder / (copy + ".off"), surface);
      ++sum.rotated;
    }
  }
}

}  // namespace

int rotate_command(const RotateArguments& arguments) {
  Summary sum;
  for (const Model& model :
       collect_models({arguments.paths.begin(), arguments.paths.end()}).models) {
    rotate(model.path, fs::path(model.name).replace_extension(), arguments.folder, sum);
  }
  fmt::print("{} surfaces and {} rotated copies in {}, {} left out\n", sum.given, sum.rotated,
             arguments.folder, sum.left_out);
  return sum.given > 0 ? 0 : 1;
}

}  // namespace tetproof
