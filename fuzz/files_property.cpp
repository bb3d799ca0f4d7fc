#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>

#include "corpus/generators/generate.h"
#include "fuzz/plain_files.h"
#include "fuzz/properties.h"
#include "fuzz/scratch.h"
#include "mesher/cli/run.h"
#include "mesher/io/output.h"
#include "mesher/io/parse_surface.h"
#include "mesher/io/read_mesh.h"
#include "mesher/io/test_archives.h"
#include "mesher/io/write_mesh.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/mesh_file.h"
#include "property_tests/leniency.h"

namespace tetproof::fuzz {
namespace {

namespace fs = std::filesystem;

// For a rejected input only the message is checked. Most inputs are rejected, and this leniency
// counts them, so the others are the accepted ones.
Leniency refused("refused-in-one-line", 0.999);
Leniency no_triangles("read-without-triangles", 0.5);
Leniency mesh_refused("mesh-refused-in-one-line", 0.999);
Leniency not_conforming("read-and-not-conforming", 0.999);
Leniency no_boundary("boundary-not-in-format", 0.5);
Leniency no_labels("labels-not-in-format", 0.5);
Leniency not_run("ends-with-its-parsing", 0.999);

bool is_one_line(const std::string& text) {
  return !text.empty() && text.find_first_of("\r\n") == std::string::npos;
}

bool same_bits(const delmesher::Surface& s, const delmesher::Surface& t) {
  if (s.triangles != t.triangles || s.vertices.size() != t.vertices.size()) return false;
  for (std::size_t v = 0; v < s.vertices.size(); ++v) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (std::bit_cast<std::uint64_t>(s.vertices[v][i]) !=
          std::bit_cast<std::uint64_t>(t.vertices[v][i])) {
        return false;
      }
    }
  }
  return true;
}

// Cells as sets with sorted corners, since formats differ in order and orientation.
template <class Cell>
std::multiset<Cell> sorted_cells(const std::vector<Cell>& cells) {
  std::multiset<Cell> result;
  for (Cell cell : cells) {
    std::sort(cell.begin(), cell.end());
    result.insert(cell);
  }
  return result;
}

using Triangle = std::array<std::uint32_t, 3>;
std::multiset<std::pair<Triangle, std::int32_t>> labelled(const std::vector<Triangle>& triangles,
                                                          const std::vector<std::int32_t>& labels) {
  std::multiset<std::pair<Triangle, std::int32_t>> result;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Triangle t = triangles[i];
    std::sort(t.begin(), t.end());
    result.insert({t, labels[i]});
  }
  return result;
}

delmesher::TetMesh read_mesh(Bytes& bytes) {
  delmesher::TetMesh mesh;
  const std::uint32_t vertices = 4 + bytes.below(12);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const double x = bytes.coordinate(), y = bytes.coordinate(), z = bytes.coordinate();
    mesh.vertices.push_back({x, y, z});
  }
  const auto corners = [&](auto& cell) {
    for (std::size_t i = 0; i < cell.size(); ++i) {
      do {
        cell[i] = bytes.empty() ? static_cast<std::uint32_t>(i) : bytes.below(vertices);
      } while (!bytes.empty() && std::find(cell.begin(), cell.begin() + static_cast<long>(i),
                                           cell[i]) != cell.begin() + static_cast<long>(i));
    }
  };
  for (std::uint32_t t = 1 + bytes.below(8); t > 0; --t) {
    corners(mesh.tetrahedra.emplace_back());
    mesh.inside.push_back(static_cast<std::uint8_t>(bytes.below(2)));
  }
  // All triangles of a facet have its label.
  std::array<std::int32_t, 4> label{};
  for (std::int32_t& l : label) l = static_cast<std::int8_t>(bytes.byte());
  for (std::uint32_t t = bytes.below(8); t > 0; --t) {
    corners(mesh.boundary.emplace_back());
    const std::uint32_t facet = bytes.byte();
    mesh.boundary_labels.push_back(label[facet % label.size()]);
    mesh.boundary_facets.push_back(facet);
  }
  return mesh;
}

// A package of 3MF with this model, so that a fuzzer need not find checksums.
std::string package_of(const std::string& model) {
  return delmesher::io::Zip().add("3D/3dmodel.model", model, false).finish();
}

Finding written_and_read(const delmesher::TetMesh& mesh, const std::string& extension) {
  const std::string path = (scratch() / ("mesh" + extension)).string();
  delmesher::io::OutputSet outputs;
  if (const auto status = delmesher::io::write_mesh(outputs, path, mesh); !status.ok()) {
    return "writer refuses: " + status.error;
  }
  if (const auto status = outputs.commit(); !status.ok()) return "writer fails: " + status.error;
  const oracles::MeshFile read = oracles::read_mesh(path);
  if (read.vertices != mesh.vertices) return "vertices of " + extension + ": differ when read back";
  if (sorted_cells(read.tetrahedra) != sorted_cells(mesh.tetrahedra)) {
    return "tetrahedra of " + extension + ": differ when read back";
  }
  if (extension == ".tet") {
    no_boundary.take();
    return {};
  }
  if (sorted_cells(read.boundary) != sorted_cells(mesh.boundary)) {
    return "boundary of " + extension + ": differs when read back";
  }
  if (read.labels.size() != read.boundary.size()) {
    no_labels.take();
  } else if (labelled(read.boundary, read.labels) !=
             labelled(mesh.boundary, mesh.boundary_labels)) {
    return "labels of " + extension + ": differ when read back";
  }
  return {};
}

}  // namespace

// A plain file must be read, exactly as it stands.
Finding plain_is_read(const delmesher::io::ReadResult& read, const TriangleSoup& plain) {
  if (!read.ok()) return "reader plain: refused, " + read.error;
  TriangleSoup ours;
  for (const auto& [a, b, c] : read.surface.triangles) {
    const auto& v = read.surface.vertices;
    ours.push_back({v[a], v[b], v[c]});
  }
  return ours == plain ? "" : "reader plain: other triangles";
}

Finding reader_holds(const std::string& text, const std::string& name) {
  judging({&refused, &no_triangles});
  const bool model = name.ends_with(".3mf") && !text.starts_with("PK");
  const auto first = delmesher::io::parse_surface(model ? package_of(text) : text, name);
  const auto plain = plain_triangles(text, name);
  if (plain && !first.ok()) return plain_is_read(first, *plain);
  if (!first.ok()) {
    refused.take();
    return is_one_line(first.error) ? "" : "reader error: not one line";
  }
  const delmesher::Surface& s = first.surface;
  if (!s.labels.empty() && s.labels.size() != s.triangles.size()) return "reader labels: too few";
  for (const auto& t : s.triangles) {
    for (const std::uint32_t v : t) {
      if (v >= s.vertices.size()) return "reader index: out of range";
    }
  }
  if (plain) {
    if (Finding f = plain_is_read(first, *plain); !f.empty()) return f;
  }
  delmesher::Surface unlabelled = s;
  unlabelled.labels.clear();
  if (unlabelled.triangles.empty()) {
    no_triangles.take();
    return {};
  }
  const auto again = delmesher::io::parse_surface(to_off(unlabelled), "again.off");
  if (!again.ok()) return "reader round trip: " + again.error;
  return same_bits(unlabelled, again.surface) ? "" : "reader round trip: differs";
}

Finding mesh_reader_holds(const std::string& text, const std::string& name) {
  judging({&mesh_refused, &not_conforming});
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == '\f' && name.ends_with(".node")) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  const auto beside = [&](const char* extension) -> std::optional<std::string> {
    const std::size_t part = std::string_view(extension) == ".ele" ? 1 : 2;
    return part < parts.size() ? std::optional(parts[part]) : std::nullopt;
  };
  const auto first = delmesher::io::parse_mesh(parts[0], name, beside);
  if (!first.ok()) {
    mesh_refused.take();
    return is_one_line(first.error) ? "" : "mesh reader error: not one line";
  }
  const delmesher::TetMesh& mesh = first.mesh;
  for (const auto& t : mesh.tetrahedra) {
    for (const std::uint32_t v : t) {
      if (v >= mesh.vertices.size()) return "mesh reader index: out of range";
    }
  }
  const std::string path = (scratch() / name).string();
  if (const auto status = delmesher::io::write_mesh(path, mesh); !status.ok()) {
    return "mesh reader round trip: " + status.error;
  }
  const auto again = delmesher::io::read_mesh(path);
  if (!again.ok()) return "mesh reader round trip: " + again.error;
  if (again.mesh.vertices != mesh.vertices ||
      sorted_cells(again.mesh.tetrahedra) != sorted_cells(mesh.tetrahedra) ||
      labelled(again.mesh.boundary, again.mesh.boundary_labels) !=
          labelled(mesh.boundary, mesh.boundary_labels)) {
    return "mesh reader round trip: differs";
  }
  delmesher::ImproveOptions options;
  options.max_vertices = 3000;
  const delmesher::Result result = delmesher::improve_mesh(mesh, options);
  if (result.status.code == delmesher::StatusCode::invalid_mesh) {
    not_conforming.take();
    return is_one_line(result.status.message) ? "" : "improve message: not one line";
  }
  if (result.status.code == delmesher::StatusCode::internal_error) {
    return "improve: " + result.status.message;
  }
  return result.statistics.rounding_inverted == 0 ? "" : "improve: inverted tetrahedra";
}

Finding writers_hold(Bytes bytes) {
  judging({&no_boundary, &no_labels});
  constexpr const char* kExtensions[] = {".mesh", ".msh", ".vtu", ".node", ".tet"};
  const char* extension = kExtensions[bytes.below(5)];
  try {
    return written_and_read(read_mesh(bytes), extension);
  } catch (const oracles::ReadError& error) {
    return "written file of " + std::string(extension) + ": " + error.what();
  }
}

Finding command_line_holds(const std::string& text) {
  if (text.find('/') != std::string::npos) return {};  // stays in its own folder
  judging({&not_run});
  fs::current_path(scratch());
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == '\n') {
      words.emplace_back();
    } else if (c != '\0') {
      words.back() += c;
    }
  }
  // Standard input may be somebody's terminal.
  if (std::any_of(words.begin(), words.end(), delmesher::io::is_standard_stream)) return {};
  const delmesher::cli::Parsed parsed = delmesher::cli::parse_arguments(words);
  if (!parsed.run) {
    not_run.take();
    const bool known = parsed.exit_code == 0 || parsed.exit_code == 2;
    return known ? "" : "command line: parsing ends with " + std::to_string(parsed.exit_code);
  }
  std::string said;
  const auto fails = [](const delmesher::Surface&, const auto&) {
    delmesher::Result result;
    result.status = {delmesher::StatusCode::invalid_surface, "not a surface"};
    return result;
  };
  const auto no_surface = [](const delmesher::Surface&, const delmesher::CheckOptions&) {
    delmesher::SurfaceReport report;
    report.status = {delmesher::StatusCode::invalid_surface, "not a surface"};
    return report;
  };
  const int code = delmesher::cli::run(
      parsed.command, {fails, fails, no_surface},
      {[](const std::string&) {}, [&](const std::string& line) { said += line; }});
  if (code < 0 || (code > 6 && code != 130)) {
    return "command line: exit code " + std::to_string(code);
  }
  if (code != 0 && ("\n" + said).find("\ndelmesher: ") == std::string::npos)
    return "command line: says nothing of " + said;
  return {};
}

}  // namespace tetproof::fuzz
