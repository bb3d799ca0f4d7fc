#include "oracles/files/surface_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>

#include "oracles/base/text_reader.h"
#include "oracles/files/polygon.h"
#include "oracles/files/three_mf.h"

namespace tetproof::oracles {
namespace {

void add_polygon(Polyhedron& surface, const std::vector<Index>& corners, Index polygon) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    surface.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    surface.polygons.push_back(polygon);
  }
}

Polyhedron read_off(const std::string& path, std::string_view text) {
  TextReader reader(path, text);
  Polyhedron surface;
  if (!reader.word().ends_with("OFF")) reader.fail("the file does not begin with OFF");
  const std::uint64_t vertices = reader.count(), faces = reader.count();
  reader.skip_line();  // number of edges
  for (std::uint64_t i = 0; i < vertices; ++i) {
    const double x = reader.number(), y = reader.number(), z = reader.number();
    surface.vertices.push_back({x, y, z});
    reader.skip_line();
  }
  for (std::uint64_t i = 0; i < faces; ++i) {
    std::vector<Index> corners(reader.count());
    for (Index& corner : corners) corner = reader.index(0, vertices);
    add_polygon(surface, corners, static_cast<Index>(i));
    reader.skip_line();  // colours
  }
  return surface;
}

// Labels numbered from 1 by the first use of a name.
struct NamedLabels {
  std::string name;
  std::map<std::string, std::int32_t> numbers;
  std::vector<std::int32_t> labels;
  void use(std::size_t triangles) {
    const auto next = static_cast<std::int32_t>(numbers.size() + 1);
    labels.resize(triangles, numbers.emplace(name, next).first->second);
  }
};

std::string rest_of_line(TextReader& reader) {
  std::string rest;
  for (auto word = reader.word_in_line(); !word.empty(); word = reader.word_in_line()) {
    rest += (rest.empty() ? "" : " ") + std::string(word);
  }
  return rest;
}

Polyhedron read_obj(const std::string& path, std::string_view text) {
  TextReader reader(path, text);
  Polyhedron surface;
  Index polygons = 0;
  // Labels are the names of the first of these that gives the faces at least two different ones.
  static constexpr std::string_view kNamings[] = {"usemtl", "g", "o"};
  std::array<NamedLabels, 3> namings;
  while (!reader.at_end()) {
    const std::string_view keyword = reader.word();
    for (int i = 0; i < 3; ++i) {
      if (keyword == kNamings[i]) namings[i].name = rest_of_line(reader);
    }
    if (keyword == "v") {
      const double x = reader.number(), y = reader.number(), z = reader.number();
      surface.vertices.push_back({x, y, z});
    } else if (keyword == "f") {
      std::vector<Index> corners;
      for (auto word = reader.word_in_line(); !word.empty(); word = reader.word_in_line()) {
        const std::string_view number = word.substr(0, word.find('/'));
        TextReader one(path, number);
        const std::int64_t value = one.integer();
        const auto count = static_cast<std::int64_t>(surface.vertices.size());
        const std::int64_t index = value < 0 ? count + value : value - 1;
        if (index < 0 || index >= count) reader.fail("a face refers to no vertex");
        corners.push_back(static_cast<Index>(index));
      }
      add_polygon(surface, corners, polygons++);
      for (NamedLabels& naming : namings) naming.use(surface.triangles.size());
    }
    reader.skip_line();
  }
  for (const NamedLabels& naming : namings) {
    if (!surface.labels.empty() || naming.numbers.size() < 2) continue;
    surface.labels = naming.labels;
    for (const auto& [name, number] : naming.numbers) surface.names[{2, number}] = name;
  }
  surface.names_read = true;
  return surface;
}

// Joins equal positions; adding 0.0 turns -0 into +0.
class Welder {
 public:
  explicit Welder(Polyhedron& surface) : surface_(surface) {}
  Index vertex(Position p) {
    for (double& x : p) x += 0.0;
    const auto [at, fresh] = seen_.emplace(p, static_cast<Index>(surface_.vertices.size()));
    if (fresh) surface_.vertices.push_back(p);
    return at->second;
  }
  void triangle(const std::array<Position, 3>& corners) {
    surface_.triangles.push_back({vertex(corners[0]), vertex(corners[1]), vertex(corners[2])});
  }

 private:
  Polyhedron& surface_;
  std::map<Position, Index> seen_;
};

Polyhedron read_text_stl(const std::string& path, std::string_view text) {
  TextReader reader(path, text, '\0');
  Polyhedron surface;
  Welder welder(surface);
  std::array<Position, 3> corners;
  int corner = 0;
  std::int32_t solids = 0;
  while (!reader.at_end()) {
    const std::string_view keyword = reader.word();
    if (keyword == "vertex") {
      if (corner == 3) reader.fail("a facet with more than three corners");
      for (double& x : corners[corner]) x = reader.number();
      ++corner;
    } else if (keyword == "endfacet") {
      if (corner != 3) reader.fail("a facet without three corners");
      welder.triangle(corners);
      surface.labels.push_back(solids);
      corner = 0;
    } else if (keyword == "solid") {
      surface.names[{2, ++solids}] = rest_of_line(reader);
    }
  }
  surface.names_read = true;
  if (solids < 2) {
    surface.labels.assign(surface.triangles.size(), 0);
    surface.names.clear();
  }
  return surface;
}

template <class Value>
Value binary(std::string_view bytes, std::size_t at, bool swap = false) {
  char raw[sizeof(Value)];
  std::memcpy(raw, bytes.data() + at, sizeof raw);
  if (swap) std::reverse(raw, raw + sizeof raw);
  return std::bit_cast<Value>(raw);
}

Polyhedron read_binary_stl(const std::string&, std::string_view bytes) {
  Polyhedron surface;
  Welder welder(surface);
  const auto count = binary<std::uint32_t>(bytes, 80);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<Position, 3> corners;
    for (int i = 0; i < 9; ++i) {
      corners[i / 3][i % 3] = binary<float>(bytes, 84 + 50 * t + 12 + 4 * i);
    }
    welder.triangle(corners);
  }
  return surface;
}

// One property of a PLY element: its type, and that of its count if it is a list.
struct PlyProperty {
  std::string name, type, count_type;
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view text)
      : header_(path, text, '\0'), text_(text) {}

  Polyhedron read() {
    read_header();
    Index polygons = 0;
    for (const PlyElement& element : elements_) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        Position position{};
        std::vector<Index> corners;
        for (const PlyProperty& property : element.properties) {
          read_property(element, property, position, corners);
        }
        if (element.name == "vertex") surface_.vertices.push_back(position);
        if (element.name != "face") continue;
        add_polygon(surface_, corners, polygons++);
        if (!label_name_.empty()) surface_.labels.resize(surface_.triangles.size(), label_);
      }
    }
    for (const auto& triangle : surface_.triangles) {
      for (const Index v : triangle) {
        if (v >= surface_.vertices.size()) header_.fail("a face refers to no vertex");
      }
    }
    return std::move(surface_);
  }

 private:
  void read_header() {
    for (auto word = header_.required_word("end_header"); word != "end_header";
         word = header_.required_word("end_header")) {
      if (word == "format") {
        const auto format = header_.word();
        binary_ = format != "ascii";
        swap_ = format == "binary_big_endian";
      } else if (word == "element") {
        elements_.emplace_back();
        elements_.back().name = header_.word();
        elements_.back().count = header_.count();
      } else if (word == "property" && !elements_.empty()) {
        PlyProperty property;
        property.type = header_.word();
        if (property.type == "list") {
          property.count_type = header_.word();
          property.type = header_.word();
        }
        property.name = header_.word();
        elements_.back().properties.push_back(property);
        continue;
      }
      header_.skip_line();
    }
    find_label();
    at_ = text_.find("\nend_header") + 1;
    at_ = text_.find('\n', at_) + 1;
  }

  void find_label() {
    for (const char* name :
         {"label", "region", "marker", "group", "attribute", "material_index", "physical"}) {
      for (const PlyElement& element : elements_) {
        for (const PlyProperty& property : element.properties) {
          const bool fits = element.name == "face" && property.count_type.empty();
          if (label_name_.empty() && fits && property.name == name) label_name_ = name;
        }
      }
    }
  }

  void read_property(const PlyElement& element, const PlyProperty& property, Position& position,
                     std::vector<Index>& corners) {
    if (!property.count_type.empty()) {
      const auto count = static_cast<std::int64_t>(value(property.count_type));
      if (count < 0 || count > static_cast<std::int64_t>(text_.size())) header_.fail("bad list");
      const bool wanted = element.name == "face" &&
                          (property.name == "vertex_indices" || property.name == "vertex_index");
      for (std::int64_t k = 0; k < count; ++k) {
        const double v = value(property.type);
        if (wanted) corners.push_back(v < 0 || v > 4e9 ? kNone : static_cast<Index>(v));
      }
      return;
    }
    const double v = value(property.type);
    if (element.name == "face" && property.name == label_name_) {
      label_ = static_cast<std::int32_t>(v);
    }
    if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
      position[property.name[0] - 'x'] = v;
    }
  }

  double value(const std::string& type) {
    if (!binary_) return header_.number();
    if (type == "double" || type == "float64") return next<double>();
    if (type == "float" || type == "float32") return next<float>();
    if (type == "int" || type == "int32") return next<std::int32_t>();
    if (type == "uint" || type == "uint32") return next<std::uint32_t>();
    if (type == "short" || type == "int16") return next<std::int16_t>();
    if (type == "ushort" || type == "uint16") return next<std::uint16_t>();
    if (type == "char" || type == "int8") return next<std::int8_t>();
    if (type == "uchar" || type == "uint8") return next<std::uint8_t>();
    header_.fail("unknown PLY type " + type);
  }

  template <class Value>
  double next() {
    if (at_ + sizeof(Value) > text_.size()) header_.fail("the file ends too early");
    at_ += sizeof(Value);
    return binary<Value>(text_, at_ - sizeof(Value), swap_);
  }

  TextReader header_;
  std::string_view text_;
  Polyhedron surface_;
  std::vector<PlyElement> elements_;
  std::string label_name_;  // property of the faces that is their label; empty: none
  std::int32_t label_ = 0;
  bool binary_ = false, swap_ = false;
  std::size_t at_ = 0;
};

// TetGen's .smesh and .poly. A .poly facet must be one polygon, as no code here cuts holes. Points
// may be in a .node file of the same name.
Polyhedron read_tetgen(const std::string& path, std::string_view text, bool poly) {
  TextReader reader(path, text);
  Polyhedron surface;
  std::int64_t base = 0;
  const auto read_nodes = [&](TextReader& nodes, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t index = nodes.integer();
      if (i == 0) base = index;
      const double x = nodes.number(), y = nodes.number(), z = nodes.number();
      surface.vertices.push_back({x, y, z});
      nodes.skip_line();
    }
  };
  const std::uint64_t own = reader.count();
  reader.skip_line();
  if (own > 0) {
    read_nodes(reader, own);
  } else {
    const std::string node_path = maybe_with_gz(path.substr(0, path.rfind('.')) + ".node");
    const std::string node_text = read_whole_file(node_path);
    TextReader nodes(node_path, node_text);
    const std::uint64_t count = nodes.count();
    nodes.skip_line();
    read_nodes(nodes, count);
  }
  const std::uint64_t facets = reader.count();
  const std::string_view flag = reader.word_in_line();
  const bool markers = !flag.empty() && flag != "0";
  reader.skip_line();
  for (std::uint64_t f = 0; f < facets; ++f) {
    std::int64_t marker = 0;
    if (poly) {
      const std::int64_t polygons = reader.integer();
      const std::string_view holes = reader.word_in_line(), given = reader.word_in_line();
      if (polygons != 1 || (!holes.empty() && holes != "0")) {
        reader.fail("a facet of several polygons or with holes is not read here");
      }
      if (!given.empty()) marker = TextReader(path, given).integer();
      reader.skip_line();
    }
    std::vector<Index> corners(reader.count());
    for (Index& corner : corners) corner = reader.index(base, surface.vertices.size());
    const std::string_view given = reader.word_in_line();
    if (!poly && !given.empty()) marker = TextReader(path, given).integer();
    reader.skip_line();
    add_polygon(surface, corners, static_cast<Index>(f));
    if (markers) surface.labels.resize(surface.triangles.size(), static_cast<std::int32_t>(marker));
  }
  return surface;
}

bool is_binary_stl(std::string_view text) {
  return text.size() >= 84 &&
         text.size() == 84 + 50 * static_cast<std::uint64_t>(binary<std::uint32_t>(text, 80));
}

// Faces of more than three corners are fans.
Polyhedron read_any(const std::string& file) {
  const std::string text = read_whole_file(file), path = without_gz(file);
  const std::string_view start = std::string_view(text).substr(0, 200);
  std::string extension = path.substr(std::min(path.size(), path.rfind('.') + 1));
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (is_zip(start)) return read_three_mf(path, text);
  if (start.starts_with("ply")) return PlyReader(path, text).read();
  if (extension == "obj") return read_obj(path, text);
  if (extension == "smesh" || extension == "poly") {
    return read_tetgen(path, text, extension == "poly");
  }
  if (extension == "stl") {
    return is_binary_stl(text) ? read_binary_stl(path, text) : read_text_stl(path, text);
  }
  return read_off(path, text);
}

}  // namespace

Polyhedron read_surface(const std::string& path) {
  Polyhedron surface = read_any(path);
  cut_polygons(surface);
  return surface;
}

}  // namespace tetproof::oracles
