#include "oracles/plane_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "oracles/surface_file.h"
#include "oracles/text_reader.h"
#include "oracles/vtu_text.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::Insideness;
using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using Point = std::array<double, 2>;
using Edge = std::array<std::uint32_t, 2>;

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

std::string beside(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

Point point(TextReader& reader) {
  const double x = reader.number() + 0.0;  // -0 is 0
  return {x, reader.number() + 0.0};
}

std::int64_t integer_in_line(TextReader& reader, const std::string& path, std::int64_t otherwise) {
  const std::string_view word = reader.word_in_line();
  return word.empty() ? otherwise : TextReader(path, word).integer();
}

// ------------------------------------------------------------------------------------- Triangle

// Numbered points; returns the first number.
std::int64_t read_nodes(TextReader& reader, std::uint64_t count, std::vector<Point>& vertices) {
  std::int64_t first = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t number = reader.integer();
    if (i == 0) first = number;
    if (number != first + static_cast<std::int64_t>(i)) reader.fail("nodes are not in order");
    vertices.push_back(point(reader));
    reader.skip_line();  // attributes and markers
  }
  return first;
}

// Segments as .poly files list them.
void read_segments(TextReader& reader, const std::string& path, std::int64_t first,
                   std::uint64_t vertices, std::vector<Edge>& segments,
                   std::vector<std::int32_t>& markers) {
  const std::uint64_t count = reader.count();
  const bool marked = integer_in_line(reader, path, 0) != 0;
  reader.skip_line();
  for (std::uint64_t i = 0; i < count; ++i) {
    reader.integer();
    const std::uint32_t a = reader.index(first, vertices);
    segments.push_back({a, reader.index(first, vertices)});
    if (marked) {
      markers.push_back(static_cast<std::int32_t>(integer_in_line(reader, path, 0)));
    }
    reader.skip_line();
  }
}

// Commas count as blanks, as delmesher reads Triangle's files and rings.
std::string without_commas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  return text;
}

PlanarGraph read_poly(const std::string& path, std::string_view text) {
  PlanarGraph graph;
  graph.insideness = Insideness::enclosed;
  TextReader reader(path, text);
  const std::uint64_t own = reader.count();
  if (integer_in_line(reader, path, 2) != 2) reader.fail("vertices are not of the plane");
  reader.skip_line();
  std::int64_t first = 0;
  if (own > 0) {
    first = read_nodes(reader, own, graph.vertices);
  } else {
    const std::string node_path = beside(path, ".node");
    const std::string node_text = without_commas(read_whole_file(node_path));
    TextReader nodes(node_path, node_text);
    const std::uint64_t count = nodes.count();
    nodes.skip_line();
    first = read_nodes(nodes, count, graph.vertices);
  }
  read_segments(reader, path, first, graph.vertices.size(), graph.segments, graph.markers);
  if (reader.at_end()) return graph;
  for (std::uint64_t left = reader.count(); left > 0; --left) {
    reader.integer();
    graph.holes.push_back(point(reader));
    reader.skip_line();
  }
  if (reader.at_end()) return graph;
  for (std::uint64_t left = reader.count(); left > 0; --left) {
    reader.integer();
    const Point at = point(reader);
    graph.regions.push_back({at, reader.number()});
    reader.skip_line();
  }
  return graph;
}

PlaneFile read_triangle(const std::string& path) {
  PlaneFile file;
  const std::string node_path = beside(path, ".node"), ele_path = beside(path, ".ele"),
                    poly_path = beside(path, ".poly");
  const std::string node_text = read_whole_file(node_path);
  TextReader nodes(node_path, node_text);
  const std::uint64_t count = nodes.count();
  if (integer_in_line(nodes, node_path, 2) != 2) nodes.fail("vertices are not of the plane");
  nodes.skip_line();
  const std::int64_t first = read_nodes(nodes, count, file.vertices);
  const std::string ele_text = read_whole_file(ele_path);
  TextReader ele(ele_path, ele_text);
  const std::uint64_t triangles = ele.count();
  if (integer_in_line(ele, ele_path, 3) != 3) ele.fail("elements are not linear triangles");
  const bool attributes = integer_in_line(ele, ele_path, 0) != 0;
  ele.skip_line();
  std::vector<double> values;
  for (std::uint64_t t = 0; t < triangles; ++t) {
    ele.integer();
    std::array<std::uint32_t, 3> corners;
    for (auto& corner : corners) corner = ele.index(first, count);
    file.triangles.push_back(corners);
    if (attributes) values.push_back(ele.number());
    ele.skip_line();
  }
  if (!std::filesystem::exists(poly_path)) return file;
  const std::string poly_text = read_whole_file(poly_path);
  TextReader poly(poly_path, poly_text);
  poly.integer();
  poly.skip_line();
  read_segments(poly, poly_path, first, count, file.edges, file.markers);
  file.lists_edges = true;
  file.markers.resize(file.edges.size(), 0);
  // Attributes are those of the input's regions if there are any, else they name sides.
  bool regions = false;
  if (!poly.at_end()) {
    for (std::uint64_t left = poly.count(); left > 0; --left) poly.skip_line(), poly.word();
    poly.skip_line();
    regions = !poly.at_end();
  }
  if (attributes && !regions) {
    for (const double value : values) file.inside.push_back(value == 1 ? 1 : 0);
  }
  return file;
}

// ---------------------------------------------------------------------------------------- rings

PlanarGraph from_edges(PlanarGraph graph, const std::vector<Edge>& edges,
                       const std::map<Edge, bool>& divides) {
  std::map<Edge, bool> seen;
  for (const auto& [a, b] : edges) {
    const Edge key = {std::min(a, b), std::max(a, b)};
    const auto found = divides.find(key);
    if (found == divides.end() || !seen.emplace(key, true).second) continue;
    graph.segments.push_back(key);
    graph.partitions.push_back(found->second);
  }
  return graph;
}

PlanarGraph read_rings(const std::string& path, std::string_view text) {
  PlanarGraph graph;
  graph.insideness = Insideness::nested;
  std::map<Point, std::uint32_t> number;
  std::vector<Edge> edges;
  std::map<Edge, int> count;
  std::vector<std::uint32_t> ring;
  const auto close = [&] {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring.size() == 2 && i == 1) continue;  // one segment, not there and back
      const std::uint32_t a = ring[i], b = ring[(i + 1) % ring.size()];
      if (a == b) continue;
      edges.push_back({a, b});
      ++count[{std::min(a, b), std::max(a, b)}];
    }
    ring.clear();
  };
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + (text.substr(end, 2) == "\r\n" ? 2 : 1);
    line = line.substr(0, line.find('#'));
    TextReader reader(path, line);
    if (reader.at_end() || line[line.find_first_not_of(" \t")] == '>') {
      close();
      continue;
    }
    const Point p = point(reader);
    const auto [found, fresh] =
        number.emplace(p, static_cast<std::uint32_t>(graph.vertices.size()));
    if (fresh) graph.vertices.push_back(p);
    ring.push_back(found->second);
  }
  close();
  std::map<Edge, bool> divides;
  for (const auto& [edge, n] : count) divides[edge] = n % 2 == 0;
  return from_edges(std::move(graph), edges, divides);
}

// ------------------------------------------------------------------------------------- OFF, OBJ

// Polylines of an OBJ.
std::vector<Edge> read_lines(const std::string& path, std::string_view text,
                             std::uint64_t vertices) {
  std::vector<Edge> lines;
  TextReader reader(path, text);
  while (!reader.at_end()) {
    const bool line = reader.word() == "l";
    std::int64_t before = -1;
    for (auto word = reader.word_in_line(); line && !word.empty(); word = reader.word_in_line()) {
      std::int64_t v = TextReader(path, word.substr(0, word.find('/'))).integer();
      v = v < 0 ? static_cast<std::int64_t>(vertices) + v : v - 1;
      if (v < 0 || static_cast<std::uint64_t>(v) >= vertices) {
        reader.fail("a line refers to no vertex");
      }
      if (before >= 0 && before != v) {
        lines.push_back({static_cast<std::uint32_t>(before), static_cast<std::uint32_t>(v)});
      }
      before = v;
    }
    reader.skip_line();
  }
  return lines;
}

PlanarGraph read_faces(const std::string& path, bool obj) {
  const Polyhedron surface = read_surface(path);
  PlanarGraph graph;
  graph.insideness = Insideness::nested;
  for (const auto& [x, y, z] : surface.vertices) {
    if (z != 0) throw ReadError(path + ": a vertex is not in the plane z = 0");
    graph.vertices.push_back({x + 0.0, y + 0.0});
  }
  std::vector<Edge> edges;
  std::map<Edge, std::vector<std::int32_t>> labels;  // of the triangles at an edge
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = surface.triangles[t][i], b = surface.triangles[t][(i + 1) % 3];
      edges.push_back({a, b});
      labels[{std::min(a, b), std::max(a, b)}].push_back(
          surface.labels.empty() ? 0 : surface.labels[t]);
    }
  }
  std::map<Edge, bool> divides;
  for (const auto& [edge, at] : labels) {
    if (at.size() == 1) divides[edge] = false;
    if (at.size() > 1 && at.front() != at.back()) divides[edge] = true;
  }
  if (obj) {
    for (const auto& [a, b] : read_lines(path, read_whole_file(path), graph.vertices.size())) {
      edges.push_back({a, b});
      divides.emplace(Edge{std::min(a, b), std::max(a, b)}, !surface.triangles.empty());
    }
  }
  return from_edges(std::move(graph), edges, divides);
}

// ------------------------------------------------------------------------------- Gmsh, as written

PlaneFile read_gmsh(const std::string& path, std::string_view text) {
  TextReader reader(path, text, '\0');
  PlaneFile file;
  file.lists_edges = true;
  std::map<std::int64_t, std::uint32_t> nodes;
  std::map<std::int64_t, std::int32_t> markers;  // by physical tag, here also the curve's own
  for (auto word = reader.word(); !word.empty(); word = reader.word()) {
    if (word == "$MeshFormat") {
      if (reader.number() != 4.1 || reader.integer() != 0) reader.fail("no text of version 4.1");
    } else if (word == "$PhysicalNames") {
      for (std::uint64_t left = reader.count(); left > 0; --left) {
        const std::int64_t dimension = reader.integer(), tag = reader.integer();
        if (dimension == 1 && reader.word() == "\"marker") {
          std::string_view number = reader.word_in_line();
          number = number.substr(0, number.find('"'));
          markers[tag] = static_cast<std::int32_t>(TextReader(path, number).integer());
        }
        reader.skip_line();
      }
    } else if (word == "$Nodes") {
      const std::uint64_t blocks = reader.count();
      for (int i = 0; i < 3; ++i) reader.integer();
      for (std::uint64_t block = 0; block < blocks; ++block) {
        for (int i = 0; i < 3; ++i) reader.integer();
        const std::uint64_t count = reader.count();
        for (std::uint64_t i = 0; i < count; ++i) {
          const auto n = static_cast<std::uint32_t>(nodes.size());
          if (!nodes.emplace(reader.integer(), n).second) reader.fail("a node is there twice");
        }
        for (std::uint64_t i = 0; i < count; ++i) {
          file.vertices.push_back(point(reader));
          if (reader.number() != 0) reader.fail("a node is not in the plane");
        }
      }
    } else if (word == "$Elements") {
      const auto node = [&] {
        const auto found = nodes.find(reader.integer());
        if (found == nodes.end()) reader.fail("an element refers to no node");
        return found->second;
      };
      const std::uint64_t blocks = reader.count();
      for (int i = 0; i < 3; ++i) reader.integer();
      for (std::uint64_t block = 0; block < blocks; ++block) {
        reader.integer();
        const std::int64_t entity = reader.integer(), type = reader.integer();
        if (type != 1 && type != 2) reader.fail("an element that is no line and no triangle");
        for (std::uint64_t left = reader.count(); left > 0; --left) {
          reader.integer();
          if (type == 1) {
            const std::uint32_t a = node();
            file.edges.push_back({a, node()});
            file.markers.push_back(markers[entity]);
          } else {
            const std::uint32_t a = node(), b = node();
            file.triangles.push_back({a, b, node()});
            file.inside.push_back(entity == 1 ? 1 : 0);
          }
        }
      }
    }
  }
  return file;
}

// ----------------------------------------------------------------------------- .vtu, as written

PlaneFile read_vtu(const std::string& path, std::string_view text) {
  const VtuText vtu(path, text);
  const auto fail = [&](const std::string& why) { vtu.fail(why); };
  const auto points = vtu.array("Points", ""), corners = vtu.array("Cells", "connectivity"),
             types = vtu.array("Cells", "types"), offsets = vtu.array("Cells", "offsets"),
             inside = vtu.array("CellData", "inside"), markers = vtu.array("CellData", "marker"),
             segments = vtu.array("CellData", "segment");
  PlaneFile file;
  file.lists_edges = file.names_segments = true;
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    file.vertices.push_back({points[i], points[i + 1]});
    if (points[i + 2] != 0) fail("a point is not in the plane");
  }
  if (types.size() != offsets.size()) fail("types and offsets differ in length");
  for (const auto* values : {&inside, &markers, &segments}) {
    if (!values->empty() && values->size() != types.size()) fail("cell data of another length");
  }
  std::size_t start = 0;
  for (std::size_t cell = 0; cell < types.size(); ++cell) {
    const std::size_t size = types[cell] == 5 ? 3 : 2;
    if (types[cell] != 5 && types[cell] != 3) fail("a cell that is no line and no triangle");
    if (offsets[cell] != static_cast<double>(start + size) || start + size > corners.size()) {
      fail("offsets leave the connectivity");
    }
    const auto corner = [&](std::size_t k) {
      const std::int64_t v = vtu.integer(corners[start + k]);
      if (v < 0 || v >= static_cast<std::int64_t>(file.vertices.size())) {
        fail("a cell refers to no point");
      }
      return static_cast<std::uint32_t>(v);
    };
    if (size == 3) {
      file.triangles.push_back({corner(0), corner(1), corner(2)});
      if (!inside.empty()) file.inside.push_back(inside[cell] == 1 ? 1 : 0);
    } else {
      file.edges.push_back({corner(0), corner(1)});
      file.markers.push_back(
          markers.empty() ? 0 : static_cast<std::int32_t>(vtu.integer(markers[cell])));
      if (!segments.empty()) {
        file.segments.push_back(segments[cell] < 0
                                    ? 0xffffffffU
                                    : static_cast<std::uint32_t>(vtu.integer(segments[cell])));
      }
    }
    start += size;
  }
  return file;
}

PlaneFile read_off(const std::string& path, std::string_view text) {
  TextReader reader(path, text);
  PlaneFile file;
  if (reader.word() != "OFF") reader.fail("the file does not begin with OFF");
  const std::uint64_t vertices = reader.count(), faces = reader.count();
  reader.skip_line();
  for (std::uint64_t i = 0; i < vertices; ++i) {
    file.vertices.push_back(point(reader));
    if (reader.number() != 0) reader.fail("a vertex is not in the plane");
  }
  for (std::uint64_t i = 0; i < faces; ++i) {
    if (reader.integer() != 3) reader.fail("a face that is no triangle");
    const std::uint32_t a = reader.index(0, vertices), b = reader.index(0, vertices);
    file.triangles.push_back({a, b, reader.index(0, vertices)});
    reader.skip_line();
  }
  return file;
}

// --------------------------------------------------------------------------------------- record

class RecordReader {
 public:
  RecordReader(const std::string& path, std::string_view text) : reader_(path, text) {}

  PlaneRecord read(unsigned* version) {
    reader_.expect("delmesher-plane-exact");
    const std::uint32_t found = reader_.index(0, 2);
    if (version != nullptr) *version = found;
    reader_.list("points", record_.points, [&](ExactPoint& p) {
      const std::string_view kind = reader_.required_word("E or S");
      if (kind != "E" && kind != "S") reader_.fail("unknown kind of point");
      if (kind == "S") {
        p.kind = ExactPoint::Kind::on_segment;
        p.i = vertex();
        p.j = vertex();
      }
      p.x = reader_.number();
      if (kind == "E") p.y = reader_.number();
    });
    reader_.list("corners", record_.corners, [&](auto& corner) {
      corner.vertex = vertex();
      corner.radius = reader_.number();
    });
    reader_.list("dropped", record_.dropped, [&](auto& segment) { segment = number(); });
    reader_.expect("bounds");
    record_.delta = reader_.number();
    record_.acute = reader_.number();
    read_mesh("refined", record_.refined, record_.refined_edges);
    read_mesh("final", record_.final, record_.final_edges);
    reader_.list("mesh_vertices", record_.mesh_vertices, [&](auto& v) { v = vertex(); });
    reader_.expect_end("end");
    return std::move(record_);
  }

 private:
  void read_mesh(const std::string& name, std::vector<PlaneRecord::Triangle>& triangles,
                 std::vector<PlaneRecord::Edge>& edges) {
    reader_.list(name, triangles, [&](auto& triangle) {
      for (auto& v : triangle.vertices) v = vertex();
      triangle.side = static_cast<PlaneRecord::Side>(reader_.index(0, 3));
    });
    reader_.list(name + "_edges", edges, [&](auto& edge) {
      for (auto& v : edge.vertices) v = vertex();
      edge.segment = number();
    });
  }
  std::uint32_t number() { return reader_.index(0, 0x100000000U); }
  std::uint32_t vertex() { return reader_.index(0, record_.points.size()); }

  TextReader reader_;
  PlaneRecord record_;
};

}  // namespace

PlanarGraph read_plane_graph(const std::string& path) {
  const std::string extension = extension_of(path);
  std::string text = read_whole_file(path);
  const std::string_view start = std::string_view(text).substr(0, 4096);
  TextReader first(path, start);
  const std::string_view word = first.word();
  if (extension == ".off" || extension == ".obj" || (word.size() < 8 && word.ends_with("OFF"))) {
    return read_faces(path, extension == ".obj");
  }
  text = without_commas(std::move(text));
  return extension == ".poly" ? read_poly(path, text) : read_rings(path, text);
}

PlaneFile read_plane_file(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".node" || extension == ".ele") return read_triangle(path);
  if (extension != ".vtu" && extension != ".msh" && extension != ".off") {
    throw ReadError(path + ": no triangulation is read from it (.node, .ele, .vtu, .msh, .off)");
  }
  const std::string text = read_whole_file(path);
  PlaneFile file = extension == ".vtu"   ? read_vtu(path, text)
                   : extension == ".msh" ? read_gmsh(path, text)
                                         : read_off(path, text);
  return file;
}

PlaneRecord read_plane_sidecar(const std::string& path, unsigned* version) {
  const std::string text = read_whole_file(path);
  return RecordReader(path, text).read(version);
}

PlaneFile plane_file_of(const delmesher::PlaneMesh& mesh) {
  PlaneFile file;
  file.vertices = mesh.vertices;
  file.triangles = mesh.triangles;
  file.inside = mesh.inside;
  file.lists_edges = true;
  file.edges = mesh.edges;
  file.markers = mesh.edge_markers;
  file.names_segments = true;
  file.segments = mesh.edge_segments;
  return file;
}

}  // namespace tetproof::oracles
