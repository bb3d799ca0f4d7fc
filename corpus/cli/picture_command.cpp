#include <fmt/core.h>

#include <filesystem>
#include <fstream>

#include "corpus/cli/commands.h"
#include "oracles/base/text_reader.h"
#include "oracles/envelope.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/surface_file.h"
#include "reports/picture.h"

namespace tetproof {

int picture_command(const PictureArguments& arguments) {
  if (arguments.verdict.empty() && arguments.sentence.empty()) {
    throw UsageError("--verdict or --sentence is required");
  }
  if (std::filesystem::path(arguments.output).extension() != ".svg") {
    throw UsageError("-o: a name that ends in .svg is expected");
  }
  std::string sentence = arguments.sentence;
  if (sentence.empty()) {
    const auto said = sentence_with_place(oracles::read_whole_file(arguments.verdict));
    if (!said)
      throw oracles::ReadError(arguments.verdict + ": no verdict of tetproof verify --json");
    sentence = *said;
  }
  const oracles::MeshFile mesh = oracles::read_mesh(arguments.mesh);
  oracles::Polyhedron surface = oracles::read_surface(arguments.input);
  // The oracles judge such a mesh by its own boundary, except for the distance.
  const bool is_own = arguments.own_surface && !sentence.starts_with("envelope:");
  if (is_own) surface = oracles::boundary_of(mesh);
  const std::string svg = picture_of(surface, mesh, sentence);
  if (svg.empty()) {
    fmt::print(stderr, "tetproof: {}: no place is named\n",
               arguments.verdict.empty() ? arguments.sentence : arguments.verdict);
    return 1;
  }
  std::ofstream file(arguments.output);
  file << svg;
  file.close();
  if (!file) throw std::runtime_error(arguments.output + ": cannot be written");
  return 0;
}

}  // namespace tetproof
