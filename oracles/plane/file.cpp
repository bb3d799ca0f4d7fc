#include "oracles/plane/file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "oracles/base/text_reader.h"
#include "oracles/files/gmsh_text.h"
#include "oracles/files/surface_file.h"
#include "oracles/files/vtu_text.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactPoint;
using delmesher::Insideness;
using delmesher::PlanarGraph;
using delmesher::PlaneRecord;
using Point = std::array<double, 2>;
using Edge = std::array<std::uint32_t, 2>;

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(without_gz(path)).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

std::string beside(const std::string& path, const char* extension) {
  const std::filesystem::path plain(without_gz(path));
  return maybe_with_gz(std::filesystem::path(plain).replace_extension(extension).string());
}

Point point(TextReader& reader) {
  const double x = reader.number() + 0.0;  // -0 is 0
  return {x, reader.number() + 0.0};
}

std::int64_t integer_in_line(TextReader& reader, const std::string& path, std::int64_t otherwise) {
  const std::string_view word = reader.word_in_line();
  return word.empty() ? otherwise : TextReader(path, word).integer();
}

std::int32_t integer32(const TextReader& reader, std::int64_t value) {
  if (value != static_cast<std::int32_t>(value)) {
    reader.fail(std::to_string(value) + " is not an integer of 32 bits");
  }
  return static_cast<std::int32_t>(value);
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

// A numbered point of a list of holes or regions.
Point numbered_point(TextReader& reader) {
  reader.integer();
  return point(reader);
}

// Segments as .poly files list them. Nothing else stands in the lines of a file that was written.
void read_segments(TextReader& reader, const std::string& path, std::int64_t first,
                   std::uint64_t vertices, bool written, std::vector<Edge>& segments,
                   std::vector<std::int32_t>& markers) {
  const auto end_line = [&] { written ? reader.expect_line_end() : reader.skip_line(); };
  const std::uint64_t count = reader.count();
  const bool marked = integer_in_line(reader, path, 0) != 0;
  end_line();
  for (std::uint64_t i = 0; i < count; ++i) {
    reader.integer();
    const std::uint32_t a = reader.index(first, vertices);
    segments.push_back({a, reader.index(first, vertices)});
    if (marked) markers.push_back(integer32(reader, integer_in_line(reader, path, 0)));
    end_line();
  }
}

// Commas count as blanks, as delmesher reads Triangle's files and rings.
std::string without_commas(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  return text;
}

// Points of a .poly that are equal are one vertex, and segments between them none.
void merge_equal(PlanarGraph& graph) {
  std::map<Point, std::uint32_t> place;
  std::vector<Point> distinct;
  std::vector<std::uint32_t> becomes;
  for (const Point& p : graph.vertices) {
    const auto found = place.emplace(p, static_cast<std::uint32_t>(distinct.size()));
    if (found.second) distinct.push_back(p);
    becomes.push_back(found.first->second);
  }
  std::vector<Edge> segments;
  std::vector<std::int32_t> markers;
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    const Edge ends = {becomes[graph.segments[i][0]], becomes[graph.segments[i][1]]};
    if (ends[0] == ends[1]) continue;
    segments.push_back(ends);
    if (!graph.markers.empty()) markers.push_back(graph.markers[i]);
  }
  graph.vertices = distinct;
  graph.segments = segments;
  graph.markers = markers;
}

PlanarGraph read_whole_poly(const std::string& path, std::string_view text) {
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
  read_segments(reader, path, first, graph.vertices.size(), false, graph.segments, graph.markers);
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

PlanarGraph read_poly(const std::string& path, std::string_view text) {
  PlanarGraph graph = read_whole_poly(path, text);
  merge_equal(graph);
  return graph;
}

// The files of a triangulation say what delmesher writes, and nothing else.
std::int64_t read_written_nodes(const std::string& path, std::vector<Point>& vertices) {
  const std::string text = read_whole_file(path);
  TextReader nodes(path, text);
  const std::uint64_t count = nodes.count();
  if (integer_in_line(nodes, path, 2) != 2) nodes.fail("vertices are not of the plane");
  const std::int64_t numbers =
      integer_in_line(nodes, path, 0) + integer_in_line(nodes, path, 0);  // attributes, markers
  nodes.expect_line_end();
  std::int64_t first = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::int64_t number = i == 0 ? nodes.index(0, 2) : nodes.integer();
    if (i == 0) first = number;
    if (number != first + static_cast<std::int64_t>(i)) nodes.fail("nodes are not in order");
    vertices.push_back(point(nodes));
    for (std::int64_t k = 0; k < numbers; ++k) nodes.number();
    nodes.expect_line_end();
  }
  nodes.expect_nothing();
  return first;
}

// The attributes, if there are any.
std::vector<double> read_written_triangles(const std::string& path, std::int64_t first,
                                           PlaneFile& file) {
  const std::string text = read_whole_file(path);
  TextReader ele(path, text);
  const std::uint64_t triangles = ele.count();
  if (integer_in_line(ele, path, 3) != 3) ele.fail("elements are not linear triangles");
  const std::int64_t attributes = integer_in_line(ele, path, 0);
  if (attributes != 0 && attributes != 1) ele.fail("more than one attribute");
  ele.expect_line_end();
  std::vector<double> values;
  for (std::uint64_t t = 0; t < triangles; ++t) {
    if (ele.integer() != first + static_cast<std::int64_t>(t)) ele.fail("triangles not in order");
    std::array<std::uint32_t, 3> corners;
    for (auto& corner : corners) corner = ele.index(first, file.vertices.size());
    file.triangles.push_back(corners);
    if (attributes == 1) values.push_back(ele.number());
    ele.expect_line_end();
  }
  ele.expect_nothing();
  return values;
}

void read_written_poly(const std::string& path, std::int64_t first, PlaneFile& file) {
  const std::string text = read_whole_file(path);
  TextReader poly(path, text);
  if (poly.count() != 0) poly.fail("vertices that belong in the .node file");
  if (integer_in_line(poly, path, 2) != 2) poly.fail("vertices are not of the plane");
  for (const char* what : {"attributes", "markers"}) {
    const std::int64_t count = integer_in_line(poly, path, 0);
    if (count != 0 && count != 1) poly.fail(std::string("no such number of ") + what);
  }
  poly.expect_line_end();
  read_segments(poly, path, first, file.vertices.size(), true, file.edges, file.markers);
  file.lists_edges = true;
  file.markers.resize(file.edges.size(), 0);
  file.lists_holes = true;
  if (poly.at_end()) return;
  for (std::uint64_t left = poly.count(); left > 0; --left) {
    file.holes.push_back(numbered_point(poly));
    poly.expect_line_end();
  }
  if (poly.at_end()) return;
  for (std::uint64_t left = poly.count(); left > 0; --left) {
    const Point at = numbered_point(poly);
    file.regions.push_back({at, poly.number()});
    poly.expect_line_end();
  }
  poly.expect_nothing();
}

PlaneFile read_triangle(const std::string& path) {
  PlaneFile file;
  const std::string poly_path = beside(path, ".poly"), ele_path = beside(path, ".ele");
  const std::int64_t first = read_written_nodes(beside(path, ".node"), file.vertices);
  const std::vector<double> values = read_written_triangles(ele_path, first, file);
  if (!std::filesystem::exists(poly_path)) {
    file.lacks = poly_path;
    return file;
  }
  read_written_poly(poly_path, first, file);
  file.has_attributes = true;
  // Attributes are those of the input's regions if there are any, else they name sides.
  file.names_sides = file.regions.empty();
  if (!file.names_sides) file.attributes = values;
  for (const double value : values) {
    if (!file.names_sides) break;
    if (value != 1 && value != 2) throw ReadError(ele_path + ": an attribute that names no side");
    file.inside.push_back(value == 1 ? 1 : 0);
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
  const Polyhedron surface = read_surface(path, true);
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
    for (const auto& [a, b] :
         read_lines(path, in_obj_lines(read_whole_file(path)), graph.vertices.size())) {
      edges.push_back({a, b});
      divides.emplace(Edge{std::min(a, b), std::max(a, b)}, !surface.triangles.empty());
    }
  }
  return from_edges(std::move(graph), edges, divides);
}

// ------------------------------------------------------------------------------- Gmsh, as written

// The marker in the name of a group of edges.
std::int32_t marker_of(const std::string& path, const GmshText& text, std::int64_t group) {
  constexpr std::string_view kStart = "marker ";
  const auto found = text.names.find({1, group});
  if (found == text.names.end() || !found->second.starts_with(kStart)) {
    throw ReadError(path + ": lines of no marker");
  }
  const std::string number = found->second.substr(kStart.size());
  TextReader reader(path, number, '\0');
  const std::int32_t marker = reader.integer32();
  reader.expect_nothing();
  return marker;
}

// "inside" and "outside", or with regions "region A" and "outside A" for the attribute A.
void add_side(const std::string& path, const std::string& name, PlaneFile& file) {
  const bool outside = name.starts_with("outside");
  file.inside.push_back(outside ? 0 : 1);
  if (name == "inside" || name == "outside") return;
  const std::string_view start = outside ? "outside " : "region ";
  if (!name.starts_with(start)) throw ReadError(path + ": a side by another name");
  const std::string number = name.substr(start.size());
  TextReader reader(path, number, '\0');
  file.attributes.push_back(reader.number());
  reader.expect_nothing();
}

PlaneFile read_gmsh(const std::string& path) {
  PlaneFile file;
  file.lists_edges = file.has_attributes = true;
  std::vector<std::int64_t> groups, surfaces;  // of edges, of triangles
  const auto fail = [&](const char* why) { throw ReadError(path + ": " + why); };
  const GmshText text = read_gmsh_text(path, [&](const GmshElement& element) {
    const auto& n = element.nodes;
    if (element.type == 1) {
      file.edges.push_back({n[0], n[1]});
      groups.push_back(element.group);
    } else if (element.type == 2) {
      file.triangles.push_back({n[0], n[1], n[2]});
      surfaces.push_back(element.group);
    } else {
      fail("an element that is neither a line nor a triangle");
    }
  });
  if (text.groups_differ) fail("an element is in no physical group, or in several");
  if (text.tags_shared) fail("groups of edges and of triangles have one tag");
  for (const std::int64_t group : surfaces) {
    const auto found = text.names.find({2, group});
    if (found == text.names.end()) fail("triangles on neither side");
    const bool exchanged = found->second == (group == 1 ? "outside" : "inside");
    if (group <= 2 && exchanged) fail("a side by another name");
    add_side(path, found->second, file);
  }
  for (const std::int64_t group : groups) file.markers.push_back(marker_of(path, text, group));
  for (const Position& p : text.nodes) {
    if (p[2] != 0) fail("a node is not in the plane");
    file.vertices.push_back({p[0] + 0.0, p[1] + 0.0});
  }
  return file;
}

// ----------------------------------------------------------------------------- .vtu, as written

class VtuReader {
 public:
  VtuReader(const std::string& path, std::string_view text) : vtu_(path, text) {}

  PlaneFile read() {
    file_.lists_edges = file_.names_segments = file_.has_attributes = true;
    const std::vector<double> points = vtu_.required_array("Points", "");
    for (std::size_t i = 0; i < points.size(); i += 3) {
      file_.vertices.push_back({points[i], points[i + 1]});
      if (points[i + 2] != 0) vtu_.fail("a point is not in the plane");
    }
    corners_ = vtu_.required_array("Cells", "connectivity");
    const std::vector<double> types = vtu_.required_array("Cells", "types"),
                              offsets = vtu_.required_array("Cells", "offsets");
    inside_ = vtu_.required_array("CellData", "inside");
    markers_ = vtu_.required_array("CellData", "marker");
    segments_ = vtu_.required_array("CellData", "segment");
    attributes_ = vtu_.array("CellData", "attribute");
    std::size_t start = 0;
    for (std::size_t cell = 0; cell < types.size(); ++cell) {
      if (types[cell] != 5 && types[cell] != 3)
        vtu_.fail("a cell that is neither a line nor a triangle");
      const std::size_t end = start + (types[cell] == 5 ? 3 : 2);
      if (offsets[cell] != static_cast<double>(end) || end > corners_.size()) {
        vtu_.fail("offsets leave the connectivity");
      }
      types[cell] == 5 ? add_triangle(cell, start) : add_edge(cell, start);
      start = end;
    }
    if (start != corners_.size()) vtu_.fail("the connectivity goes on after the last cell");
    return std::move(file_);
  }

 private:
  std::uint32_t corner(std::size_t k) const {
    const std::int64_t v = vtu_.integer(corners_[k]);
    if (v < 0 || v >= static_cast<std::int64_t>(file_.vertices.size())) {
      vtu_.fail("a cell refers to no point");
    }
    return static_cast<std::uint32_t>(v);
  }

  void add_triangle(std::size_t cell, std::size_t k) {
    file_.triangles.push_back({corner(k), corner(k + 1), corner(k + 2)});
    if (inside_[cell] != 0 && inside_[cell] != 1) vtu_.fail("a side that is neither 0 nor 1");
    file_.inside.push_back(inside_[cell] == 1 ? 1 : 0);
    if (markers_[cell] != 0) vtu_.fail("a marker of a triangle");
    if (segments_[cell] != -1) vtu_.fail("a segment of a triangle");
    if (!attributes_.empty()) file_.attributes.push_back(attributes_[cell]);
  }

  void add_edge(std::size_t cell, std::size_t k) {
    file_.edges.push_back({corner(k), corner(k + 1)});
    if (inside_[cell] != -1) vtu_.fail("a side of a line");
    file_.markers.push_back(vtu_.integer32(markers_[cell]));
    const std::int64_t segment = vtu_.integer(segments_[cell]);
    const bool known = segment >= 0 && segment < 0xffffffff;
    file_.segments.push_back(known ? static_cast<std::uint32_t>(segment) : 0xffffffffU);
  }

  const VtuText vtu_;
  PlaneFile file_;
  std::vector<double> corners_, inside_, markers_, segments_, attributes_;
};

PlaneFile read_off(const std::string& path, std::string_view text) {
  TextReader reader(path, text);
  PlaneFile file;
  file.names_sides = false;
  reader.expect("OFF");
  const std::uint64_t vertices = reader.count(), faces = reader.count();
  integer_in_line(reader, path, 0);  // of edges
  reader.expect_line_end();
  for (std::uint64_t i = 0; i < vertices; ++i) {
    file.vertices.push_back(point(reader));
    if (reader.number() != 0) reader.fail("a vertex is not in the plane");
    reader.expect_line_end();
  }
  for (std::uint64_t i = 0; i < faces; ++i) {
    if (reader.integer() != 3) reader.fail("a face that is not a triangle");
    const std::uint32_t a = reader.index(0, vertices), b = reader.index(0, vertices);
    file.triangles.push_back({a, b, reader.index(0, vertices)});
    reader.expect_line_end();
  }
  reader.expect_nothing();
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
      p.x = reader_.exact_number();
      if (kind == "E") p.y = reader_.exact_number();
    });
    reader_.list("corners", record_.corners, [&](auto& corner) {
      corner.vertex = vertex();
      corner.distance = reader_.exact_number();
    });
    reader_.list("dropped", record_.dropped, [&](auto& segment) { segment = number(); });
    reader_.expect("bounds");
    record_.delta = reader_.exact_number();
    record_.acute = reader_.exact_number();
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
  text = without_commas(in_plain_lines(std::move(text), '#'));
  return extension == ".poly" ? read_poly(path, text) : read_rings(path, text);
}

PlaneFile read_plane_file(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension == ".node" || extension == ".ele") return read_triangle(path);
  if (extension != ".vtu" && extension != ".msh" && extension != ".off") {
    throw ReadError(path + ": no triangulation is read from it (.node, .ele, .vtu, .msh, .off)");
  }
  if (extension == ".msh") return read_gmsh(path);
  const std::string text = read_whole_file(path);
  return extension == ".vtu" ? VtuReader(path, text).read() : read_off(path, text);
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
