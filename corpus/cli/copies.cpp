#include "corpus/cli/copies.h"

#include <fmt/core.h>

#include <filesystem>
#include <set>

#include "corpus/campaigns/printable.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/generate.h"
#include "corpus/models/models.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/surface_file.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

struct Summary {
  std::size_t given = 0, copies = 0, left_out = 0;
};

// `name`: a path within the folder, without extension.
void copy(const fs::path& file, const std::string& name, const fs::path& folder,
          const CopyKind& kind, Summary& sum) {
  const auto leave_out = [&](const std::string& which, const std::string& why) {
    fmt::print("left out: {}: {}\n", printable(which), printable(why));
    ++sum.left_out;
  };
  oracles::Polyhedron read;
  try {
    read = oracles::read_surface(file);
  } catch (const oracles::ReadError& error) {
    return leave_out(name, error.what());
  }
  const delmesher::Surface given{read.vertices, read.triangles, read.labels};
  if (!certified_valid(given)) return leave_out(name, "no valid surface");
  write_off(folder / (name + ".off"), given);
  ++sum.given;
  for (const Copy& made : kind.copies_of(given, name)) {
    if (!made.surface) {
      leave_out(made.name, kind.left_out);
      continue;
    }
    write_off(folder / (made.name + ".off"), *made.surface);
    ++sum.copies;
  }
}

}  // namespace

int write_copies(const CopiesArguments& arguments, const CopyKind& kind) {
  Summary sum;
  std::set<std::string> taken;
  for (const Model& model :
       collect_models({arguments.paths.begin(), arguments.paths.end()}).models) {
    const std::string name = fs::path(oracles::without_gz(model.name)).replace_extension().string();
    std::string free = name;
    for (int n = 2; !taken.insert(free).second; ++n) free = fmt::format("{}-{}", name, n);
    copy(model.path, free, arguments.folder, kind, sum);
  }
  fmt::print("{} surfaces and {} {} in {}, {} left out\n", sum.given, sum.copies, kind.name,
             arguments.folder, sum.left_out);
  return sum.given > 0 ? 0 : 1;
}

}  // namespace tetproof
