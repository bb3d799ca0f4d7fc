// For solvers: Abaqus .inp and Nastran .bdf.
#include <algorithm>
#include <charconv>
#include <map>
#include <string>
#include <vector>

#include "mesher/io/named_sets.h"
#include "mesher/io/write_formats.h"

namespace delmesher::io {
namespace {

// Some programs read so many characters of a number, and no more.
constexpr std::size_t kInpWidth = 20, kBdfWidth = 16;

// `digits` significant digits, with a point and the shortest exponent.
std::string decimal(double value, int digits) {
  char buffer[64];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
  std::string text(buffer, end);
  std::string exponent;
  if (const std::size_t e = text.find('e'); e != std::string::npos) {
    std::size_t first = e + 1;
    exponent = "E";
    if (text[first] == '-') exponent += "-";
    first = text.find_first_not_of("+-0", first);
    exponent += text.substr(first);
    text.resize(e);
  }
  if (text.find('.') == std::string::npos) text += ".";
  return text + exponent;
}

// The decimal of at most `width` characters that is nearest to the value: the value itself, if so
// many suffice.
std::string decimal_within(double value, std::size_t width) {
  char buffer[64];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific).ptr;
  const auto digits = std::count_if(buffer, std::find(buffer, end, 'e'),
                                    [](char c) { return c >= '0' && c <= '9'; });
  std::string text = decimal(value, static_cast<int>(digits));
  for (int fewer = static_cast<int>(digits) - 1; text.size() > width && fewer > 0; --fewer) {
    text = decimal(value, fewer);
  }
  return text;
}

class AbaqusWriter {
 public:
  AbaqusWriter(TextSink& out, const NamedMesh& named)
      : out_(out), named_(named), mesh_(named.mesh), names_(named.names) {}

  void write() {
    out_.text("*HEADING\ndelmesher\n*NODE\n");
    for (std::size_t i = 0; i < named_.nodes(); ++i) {
      out_.integer(i + 1);
      for (const double x : named_.node(i)) {
        out_.text(", ");
        out_.text(decimal_within(x, kInpWidth));
      }
      out_.text("\n");
    }
    write_elements();
    write_surfaces();
  }

 private:
  void write_elements();
  void write_surfaces();

  TextSink& out_;
  const NamedMesh& named_;
  const TetMesh& mesh_;
  const LabelNames& names_;
  Identifiers identifiers_;
  std::vector<std::size_t> element_ = std::vector<std::size_t>(mesh_.tetrahedra.size());
};

void AbaqusWriter::write_elements() {
  std::size_t next = 1;
  for (const auto& [number, tetrahedra] : tetrahedra_of_regions(mesh_)) {
    out_.text(named_.second_order() ? "*ELEMENT, TYPE=C3D10, ELSET="
                                    : "*ELEMENT, TYPE=C3D4, ELSET=");
    out_.text(identifiers_.make(region_name(named_, number)));
    out_.text("\n");
    for (const std::size_t t : tetrahedra) {
      out_.integer(element_[t] = next++);
      for (const std::uint32_t v : named_.tetrahedron(t)) {
        out_.text(", ");
        out_.integer(v + 1ULL);
      }
      out_.text("\n");
    }
  }
}

// Each label is written as a set of nodes, for prescribed values, and as a surface of faces of
// elements, for loads. A triangle between two tetrahedra belongs to the one behind it.
void AbaqusWriter::write_surfaces() {
  // Abaqus numbers the faces S1 1-2-3, S2 1-4-2, S3 2-4-3, S4 3-4-1; by the corner that is not
  // theirs:
  static constexpr std::array<const char*, 4> kFaces = {"S3", "S4", "S2", "S1"};
  const std::vector<TriangleSides> sides = sides_of_boundary(mesh_);
  for (const auto& [label, triangles] : triangles_of_labels(mesh_)) {
    const std::string name = identifiers_.make(label_name(names_, label));
    std::vector<std::uint32_t> nodes;
    for (const std::size_t i : triangles) {
      const CellNodes all = named_.triangle(i);
      nodes.insert(nodes.end(), all.begin(), all.end());
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    out_.text("*NSET, NSET=" + name + "\n");
    for (std::size_t i = 0; i < nodes.size(); ++i) {  // sixteen a line at most
      out_.integer(nodes[i] + 1ULL);
      out_.text(i % 16 == 15 || i + 1 == nodes.size() ? "\n" : ", ");
    }
    out_.text("*SURFACE, TYPE=ELEMENT, NAME=" + name + "\n");
    for (const std::size_t i : triangles) {
      const auto& [behind, before] = sides[i].sides;
      const TriangleSides::Side& side = behind.apex != TriangleSides::kNone ? behind : before;
      if (side.apex == TriangleSides::kNone) continue;
      out_.integer(element_[side.tetrahedron]);
      out_.text(", ");
      out_.text(kFaces[static_cast<std::size_t>(side.apex)]);
      out_.text("\n");
    }
  }
}

class NastranWriter {
 public:
  NastranWriter(TextSink& out, const NamedMesh& named)
      : out_(out), named_(named), mesh_(named.mesh), names_(named.names) {}

  void write();

 private:
  void number(std::uint64_t value) {
    const std::string text = std::to_string(value);
    out_.text(text + std::string(text.size() < 8 ? 8 - text.size() : 0, ' '));
  }
  void coordinate(double value) {
    const std::string text = decimal_within(value, kBdfWidth);
    out_.text(text + std::string(kBdfWidth - text.size(), ' '));
  }
  void component(std::uint64_t property, const std::string& name) {
    const std::string digits = std::to_string(property);
    out_.text("$HMNAME COMP" + std::string(20 - digits.size(), ' ') + digits + "\"" + name +
              "\"\n");
  }
  // An element's card, in fields of eight characters, eight a line after the keyword.
  void card(const char* keyword, std::uint64_t property, const CellNodes& nodes) {
    out_.text(keyword);
    number(element_++);
    number(property);
    std::size_t fields = 2;
    for (const std::uint32_t v : nodes) {
      if (fields++ == 8) out_.text("+\n+       ");
      number(v + 1ULL);
    }
    out_.text("\n");
  }
  void grid(std::size_t node);

  TextSink& out_;
  const NamedMesh& named_;
  const TetMesh& mesh_;
  const LabelNames& names_;
  std::uint64_t element_ = 1;
};

// Shells and solids number their properties together: a positive label is its own, the others and
// the regions follow the largest.
void NastranWriter::write() {
  const Members regions = tetrahedra_of_regions(mesh_), labels = triangles_of_labels(mesh_);
  std::uint64_t next =
      labels.empty() ? 1 : static_cast<std::uint64_t>(std::max(labels.rbegin()->first, 0)) + 1;
  std::map<std::int32_t, std::uint64_t> property;
  for (auto l = labels.rbegin(); l != labels.rend(); ++l) {
    property[l->first] = l->first > 0 ? static_cast<std::uint64_t>(l->first) : next++;
  }
  const std::uint64_t first_region = next;
  out_.text("$ delmesher\n");
  for (const auto& [label, triangles] : labels)
    component(property[label], label_name(names_, label));
  for (const auto& [number, tetrahedra] : regions) component(next++, region_name(named_, number));
  out_.text("BEGIN BULK\n");
  for (std::size_t i = 0; i < named_.nodes(); ++i) grid(i);
  const char* const triangle = named_.second_order() ? "CTRIA6  " : "CTRIA3  ";
  for (const auto& [label, triangles] : labels) {
    for (const std::size_t i : triangles) card(triangle, property[label], named_.triangle(i));
  }
  next = first_region;
  for (const auto& [number, tetrahedra] : regions) {
    for (const std::size_t t : tetrahedra) card("CTETRA  ", next, named_.tetrahedron(t));
    ++next;
  }
  out_.text("ENDDATA\n");
}

void NastranWriter::grid(std::size_t node) {
  const std::array<double, 3> at = named_.node(node);
  out_.text("GRID*   ");
  number(node + 1);
  out_.text(std::string(24, ' '));
  coordinate(at[0]);
  coordinate(at[1]);
  out_.text("\n*       ");
  coordinate(at[2]);
  out_.text("\n");
}

}  // namespace

void write_abaqus(TextSink& out, const NamedMesh& named) {
  AbaqusWriter(out, named).write();
}

void write_nastran(TextSink& out, const NamedMesh& named) {
  NastranWriter(out, named).write();
}

}  // namespace delmesher::io
