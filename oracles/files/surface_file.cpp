#include "oracles/files/surface_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
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
  // The number of vertices may stand right behind the keyword.
  const std::string keyword(reader.word());
  const std::size_t digits = std::min(keyword.size(), keyword.find("OFF") + 3);
  if (!keyword.substr(0, digits).ends_with("OFF")) reader.fail("the file does not begin with OFF");
  const std::string number = keyword.substr(digits);
  if (keyword.substr(0, digits).find_first_of("0123456789n") != std::string::npos) {
    reader.fail("vertices of another dimension");
  }
  const std::uint64_t vertices =
      number.empty()
          ? reader.count()
          : reader.possible(static_cast<std::uint64_t>(TextReader(path, number).integer()));
  const std::uint64_t faces = reader.count();
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

Polyhedron read_obj(const std::string& path, std::string_view text, bool planar) {
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
      const double x = reader.number(), y = reader.number();
      const std::string third(reader.word_in_line());
      if (third.empty() && !planar) reader.fail("a vertex of two coordinates");
      const double z = third.empty() ? 0 : TextReader(path, third).number();
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
      if (corners.size() < 3) reader.fail("a face of fewer than three corners");
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

void read_region_points(const std::string& path, TextReader& reader, Polyhedron& surface) {
  const auto number = [&](double& value) {
    const std::string_view word = reader.word_in_line();
    if (!word.empty()) value = TextReader(path, word).number();
    return !word.empty();
  };
  for (const bool is_hole : {true, false}) {
    if (reader.at_end()) return;
    const std::uint64_t count = reader.count();
    reader.skip_line();
    for (std::uint64_t i = 0; i < count; ++i) {
      reader.integer();
      const double x = reader.number(), y = reader.number(), z = reader.number();
      RegionPoint& region = surface.region_points.emplace_back(RegionPoint{{x, y, z}});
      region.is_hole = is_hole;
      double attribute = 0, volume = 0;
      if (!is_hole && number(attribute)) {
        char digits[32];
        region.name.assign(digits, std::to_chars(digits, digits + sizeof digits, attribute).ptr);
        if (number(volume) && volume > 0) region.volume = volume;
      }
      reader.skip_line();
    }
  }
}

// TetGen's .smesh and .poly. Points may be in a .node file of the same name.
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
  const auto read_polygon = [&] {
    std::vector<Index> corners(reader.count());
    for (Index& corner : corners) corner = reader.index(base, surface.vertices.size());
    return corners;
  };
  Index polygons = 0;
  for (std::uint64_t f = 0; f < facets; ++f) {
    std::int64_t marker = 0;
    std::vector<std::vector<Index>> parts;
    std::vector<Position> holes;
    if (poly) {
      const std::uint64_t count = reader.count();
      const std::string_view hole_count = reader.word_in_line();
      const std::int64_t hole_points =
          hole_count.empty() ? 0 : TextReader(path, hole_count).integer();
      const std::string_view given = reader.word_in_line();
      if (!given.empty()) marker = TextReader(path, given).integer();
      reader.skip_line();
      for (std::uint64_t i = 0; i < count; ++i) {
        parts.push_back(read_polygon());
        reader.skip_line();
      }
      for (std::int64_t i = 0; i < hole_points; ++i) {
        reader.integer();
        const double x = reader.number(), y = reader.number(), z = reader.number();
        holes.push_back({x, y, z});
        reader.skip_line();
      }
    } else {
      parts.push_back(read_polygon());
      const std::string_view given = reader.word_in_line();
      if (!given.empty()) marker = TextReader(path, given).integer();
      reader.skip_line();
    }
    std::erase_if(parts, [](const std::vector<Index>& corners) { return corners.size() < 3; });
    if (holes.empty()) {
      for (const std::vector<Index>& corners : parts) add_polygon(surface, corners, polygons++);
    } else {
      const auto triangles =
          parts.empty() ? std::nullopt : cut_facet(surface.vertices, parts, holes);
      if (!triangles) reader.fail("a facet whose holes are not inside its polygons");
      for (const auto& triangle : *triangles) {
        surface.triangles.push_back(triangle);
        surface.polygons.push_back(polygons++);
      }
    }
    if (markers) surface.labels.resize(surface.triangles.size(), static_cast<std::int32_t>(marker));
  }
  read_region_points(path, reader, surface);
  return surface;
}

// Facets of TetGen's files have no orientation: those that hang together by edges of two are turned
// as the first of them goes round.
void agree(Polyhedron& surface) {
  std::map<std::pair<Index, Index>, std::vector<Index>> edges;
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}].push_back(t);
    }
  }
  const auto goes = [&](Index t, Index a, Index b) {
    const auto& c = surface.triangles[t];
    return (c[0] == a && c[1] == b) || (c[1] == a && c[2] == b) || (c[2] == a && c[0] == b);
  };
  std::vector<bool> seen(surface.triangles.size(), false);
  for (Index seed = 0; seed < seen.size(); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = true;
    for (std::vector<Index> open = {seed}; !open.empty();) {
      const Index t = open.back();
      open.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
        const std::vector<Index>& both = edges.at({std::min(a, b), std::max(a, b)});
        if (both.size() != 2) continue;
        const Index other = both[0] == t ? both[1] : both[0];
        if (seen[other]) continue;
        seen[other] = true;
        if (goes(other, a, b)) std::swap(surface.triangles[other][1], surface.triangles[other][2]);
        open.push_back(other);
      }
    }
  }
}

// Vertices at one place become one where each of them ends an edge of one triangle alone, and edges
// are closed by that: seams of textures and normals, in OBJ and PLY.
void close_seams(Polyhedron& surface) {
  using Edge = std::pair<Index, Index>;
  std::map<Edge, int> edges;
  const auto edge = [](Index a, Index b) { return Edge(std::min(a, b), std::max(a, b)); };
  for (const auto& t : surface.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[edge(t[k], t[(k + 1) % 3])];
  }
  std::vector<bool> ends(surface.vertices.size(), false);
  for (const auto& [e, count] : edges) {
    if (count == 1) ends[e.first] = ends[e.second] = true;
  }
  std::map<Position, Index> at;
  std::vector<Position> vertices;
  std::vector<Index> number;
  for (Index v = 0; v < surface.vertices.size(); ++v) {
    const auto next = static_cast<Index>(vertices.size());
    const Index taken = ends[v] ? at.emplace(surface.vertices[v], next).first->second : next;
    if (taken == next) vertices.push_back(surface.vertices[v]);
    number.push_back(taken);
  }
  std::map<Edge, int> closed;
  for (const auto& [e, count] : edges) closed[edge(number[e.first], number[e.second])] += count;
  const auto open = [](const std::map<Edge, int>& all) {
    return std::ranges::count_if(all, [](const auto& e) { return e.second == 1; });
  };
  if (open(closed) >= open(edges)) return;
  surface.vertices = std::move(vertices);
  for (auto& triangle : surface.triangles) {
    for (Index& v : triangle) v = number[v];
  }
}

bool is_binary_stl(std::string_view text) {
  return text.size() >= 84 &&
         text.size() == 84 + 50 * static_cast<std::uint64_t>(binary<std::uint32_t>(text, 80));
}

// What the triangles of a format may not agree in at their edges.
enum class Seams : std::uint8_t { none, vertices, orientation };

// Faces of more than three corners are fans.
Polyhedron read_any(const std::string& file, bool planar, Seams& seams) {
  const std::string text = read_whole_file(file), path = without_gz(file);
  const std::string_view start = std::string_view(text).substr(0, 200);
  std::string extension = path.substr(std::min(path.size(), path.rfind('.') + 1));
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (is_zip(start)) return read_three_mf(path, text);
  const bool ply = start.starts_with("ply"), tetgen = extension == "smesh" || extension == "poly";
  seams = ply || extension == "obj" ? Seams::vertices : tetgen ? Seams::orientation : Seams::none;
  if (ply) return PlyReader(path, text).read();
  if (extension == "obj") return read_obj(path, in_obj_lines(text), planar);
  if (tetgen) return read_tetgen(path, in_plain_lines(text, '#'), extension == "poly");
  if (extension == "stl") {
    return is_binary_stl(text) ? read_binary_stl(path, text)
                               : read_text_stl(path, in_plain_lines(text, '\0'));
  }
  return read_off(path, in_plain_lines(text, '#'));
}

}  // namespace

std::string in_plain_lines(std::string text, char comment) {
  bool in_comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char& c = text[i];
    if (c == '\r') c = i + 1 < text.size() && text[i + 1] == '\n' ? ' ' : '\n';
    if (c == '\v' || c == '\f') c = ' ';
    in_comment = c != '\n' && (in_comment || (comment != '\0' && c == comment));
    if (in_comment) c = ' ';
  }
  return text;
}

std::string in_obj_lines(std::string text) {
  text = in_plain_lines(std::move(text), '\0');
  bool in_comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    in_comment = text[i] != '\n' && (in_comment || text[i] == '#');
    if (text[i] != '\\' || in_comment) continue;
    std::size_t end = std::min(text.size(), text.find_first_not_of(" \t", i + 1));
    if (end > i + 1 && end < text.size() && text[end] == '#') end = text.find('\n', end);
    if (end < text.size() && text[end] != '\n') continue;
    end = std::min(text.size(), end + (end < text.size() ? 1 : 0));
    text.replace(i, end - i, end - i, ' ');
  }
  return text;
}

Polyhedron read_surface(const std::string& path, bool planar) {
  Seams seams = Seams::none;
  Polyhedron surface = read_any(path, planar, seams);
  cut_polygons(surface);
  if (seams == Seams::orientation) agree(surface);
  if (seams == Seams::vertices) close_seams(surface);
  return surface;
}

}  // namespace tetproof::oracles
