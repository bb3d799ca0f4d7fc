// Writes surfaces for programs that read other formats than that of the model: triangles with the
// doubles that all our meshers see.
#include <fmt/os.h>

#include <filesystem>

#include "corpus/cli/commands.h"
#include "corpus/models/solids.h"
#include "oracles/files/surface_file.h"

namespace tetproof {
namespace {

using oracles::Polyhedron;
using oracles::Position;

std::string text_of(const Position& p) {
  return fmt::format("{} {} {}", p[0], p[1], p[2]);
}

void write_off(fmt::ostream& out, const Polyhedron& surface) {
  out.print("OFF\n{} {} 0\n", surface.vertices.size(), surface.triangles.size());
  for (const Position& p : surface.vertices) out.print("{}\n", text_of(p));
  for (const auto& t : surface.triangles) out.print("3 {} {} {}\n", t[0], t[1], t[2]);
}

void write_medit(fmt::ostream& out, const Polyhedron& surface) {
  out.print("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", surface.vertices.size());
  for (const Position& p : surface.vertices) out.print("{} 0\n", text_of(p));
  out.print("Triangles\n{}\n", surface.triangles.size());
  for (const auto& t : surface.triangles) {
    const std::size_t at = static_cast<std::size_t>(&t - surface.triangles.data());
    out.print("{} {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1,
              surface.labels.empty() ? 1 : surface.labels[at]);
  }
  out.print("End\n");
}

// Without normals, which readers compute themselves.
void write_stl(fmt::ostream& out, const Polyhedron& surface) {
  out.print("solid model\n");
  for (const auto& t : surface.triangles) {
    out.print("facet normal 0 0 0\nouter loop\n");
    for (const auto v : t) out.print("vertex {}\n", text_of(surface.vertices[v]));
    out.print("endloop\nendfacet\n");
  }
  out.print("endsolid model\n");
}

void label_shells(Polyhedron& surface, const std::string& file) {
  const Solids found = solids_of(surface);
  for (const std::size_t shell : found.shell_of_triangle) {
    surface.labels.push_back(static_cast<std::int32_t>(shell + 1));
  }
  auto out = fmt::output_file(file);
  for (const Solid& solid : found.solids) {
    out.print("{}", solid.outer + 1);
    for (const std::size_t cavity : solid.cavities) out.print(" {}", cavity + 1);
    out.print("\n");
  }
}

}  // namespace

int convert_command(const ConvertArguments& arguments) {
  const std::string extension = std::filesystem::path(arguments.output).extension();
  const auto write = extension == ".off"    ? write_off
                     : extension == ".mesh" ? write_medit
                     : extension == ".stl"  ? write_stl
                                            : nullptr;
  if (write == nullptr) throw UsageError("a name that ends in .off, .mesh or .stl is expected");
  Polyhedron surface = oracles::read_surface(arguments.input);
  surface.labels.clear();
  if (!arguments.solids.empty()) label_shells(surface, arguments.solids);
  auto out = fmt::output_file(arguments.output);
  write(out, surface);
  return 0;
}

}  // namespace tetproof
