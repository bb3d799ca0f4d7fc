#include "mesher/io/read_plane.h"

#include <algorithm>
#include <filesystem>

#include "mesher/io/numbered_lists.h"
#include "mesher/io/text.h"
#include "mesher/predicates/signs_of_doubles.h"

namespace delmesher::io {
namespace {

using Point2 = std::array<double, 2>;

double need_number(TextLines& in, const char* what) {
  std::string_view token;
  if (!in.next_token(token)) fail(at_line(in.line()), std::string(what) + " is missing");
  double value = 0;
  switch (parse_double(token, value)) {
    case NumberStatus::malformed:
      fail(at_line(in.line()), "bad number " + in_quotes(token));
    case NumberStatus::not_finite:
      fail(at_line(in.line()), "non-finite number " + in_quotes(token));
    case NumberStatus::ok:
      break;
  }
  return value + 0.0;  // -0 is 0
}

// Triangle's files (https://www.cs.cmu.edu/~quake/triangle.html), counted from 0 or 1.
class PolyReader {
 public:
  PolyReader(std::string_view text, Polling& polling, PlanarGraph& graph)
      : in_(text), polling_(polling), graph_(graph) {}

  bool read_header() {
    need_line("the number of vertices");
    vertices_ = in_.need_integer<std::uint64_t>("number of vertices");
    const auto dimension = in_.integer_or<std::int64_t>(2, "dimension");
    if (dimension != 2) {
      fail(in_.here(), "vertices of dimension " + std::to_string(dimension) + ", the plane has 2");
    }
    // Attributes, and markers of vertices, are not used.
    in_.integer_or<std::uint64_t>(0, "number of attributes");
    return vertices_ != 0;
  }

  void read_vertices() {
    check_count(vertices_, "vertices");
    graph_.vertices.reserve(vertices_);
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      need_line("a vertex");
      in_.need_number_of_item(i, "vertex", "vertices");
      graph_.vertices.push_back(need_point());
    }
  }

  void read_segments() {
    need_line("the number of segments");
    const auto count = in_.need_integer<std::uint64_t>("number of segments");
    const bool marked = in_.integer_or<std::int64_t>(0, "marker flag") != 0;
    check_count(count, "segments");
    for (std::uint64_t i = 0; i < count; ++i) {
      need_line("a segment");
      in_.need_integer<std::int64_t>("segment number");
      const std::uint32_t a = need_vertex(), b = need_vertex();
      graph_.segments.push_back({a, b});
      if (marked) graph_.markers.push_back(in_.integer_or<std::int32_t>(0, "marker"));
    }
  }

  void read_holes_and_regions(std::vector<std::string>& warnings) {
    if (!in_.lines().next_line()) return;
    const auto holes = in_.need_integer<std::uint64_t>("number of holes");
    check_count(holes, "holes");
    for (std::uint64_t i = 0; i < holes; ++i) {
      need_line("a hole");
      in_.need_integer<std::int64_t>("hole number");
      graph_.holes.push_back(need_point());
    }
    if (!in_.lines().next_line()) return;
    const auto regions = in_.need_integer<std::uint64_t>("number of regions");
    check_count(regions, "regions");
    bool areas = false;
    for (std::uint64_t i = 0; i < regions; ++i) {
      need_line("a region");
      in_.need_integer<std::int64_t>("region number");
      const Point2 point = need_point();
      const double attribute = need_number(in_.lines(), "attribute");
      std::string_view token;
      double area = 0;
      if (in_.lines().next_token(token) && parse_double(token, area) != NumberStatus::ok) {
        fail(in_.here(), "bad number " + in_quotes(token));
      }
      areas = areas || area > 0;
      graph_.regions.push_back({point, attribute});
    }
    if (areas) warnings.push_back("largest areas of regions ignored, see --max-edge");
    if (in_.lines().next_line()) warnings.push_back("lines after the region list ignored");
  }

  void take_base(const PolyReader& nodes) { in_.set_base(nodes.in_.base()); }

 private:
  void need_line(const char* what) {
    polling_.poll(8);
    in_.need_line(what);
  }
  void check_count(std::uint64_t count, const char* items) const {
    in_.check_count(count, kMaxVertices - 1, items);
  }
  Point2 need_point() {
    const double x = need_number(in_.lines(), "x");
    return {x, need_number(in_.lines(), "y")};
  }
  std::uint32_t need_vertex() {
    std::string_view token;
    if (!in_.lines().next_token(token)) fail(in_.here(), "vertex of a segment is missing");
    return in_.vertex(token, graph_.vertices.size());
  }

  NumberedLists in_;
  Polling& polling_;
  PlanarGraph& graph_;
  std::uint64_t vertices_ = 0;
};

// Equal points become one vertex, in the order of their first appearance.
std::vector<std::uint32_t> weld(const std::vector<Point2>& points, std::vector<Point2>& vertices) {
  std::vector<std::uint32_t> order(points.size()), first(points.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return points[a] != points[b] ? points[a] < points[b] : a < b;
  });
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && points[order[k]] == points[order[k - 1]];
    first[order[k]] = same ? first[order[k - 1]] : order[k];
  }
  std::vector<std::uint32_t> number(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (first[i] == i) {
      number[i] = static_cast<std::uint32_t>(vertices.size());
      vertices.push_back(points[i]);
    } else {
      number[i] = number[first[i]];
    }
  }
  return number;
}

// As rings are: equal points are one vertex, and no segment has its ends in one.
void weld_graph(PlaneReadResult& result) {
  PlanarGraph& graph = result.graph;
  std::vector<Point2> vertices;
  const std::vector<std::uint32_t> number = weld(graph.vertices, vertices);
  const std::size_t equal = graph.vertices.size() - vertices.size();
  graph.vertices = std::move(vertices);
  std::size_t kept = 0;
  for (std::size_t s = 0; s < graph.segments.size(); ++s) {
    const auto [a, b] = graph.segments[s];
    if (number[a] == number[b]) continue;
    if (!graph.markers.empty()) graph.markers[kept] = graph.markers[s];
    graph.segments[kept++] = {number[a], number[b]};
  }
  const std::size_t dropped = graph.segments.size() - kept;
  graph.segments.resize(kept);
  if (!graph.markers.empty()) graph.markers.resize(kept);
  if (equal > 0) {
    result.warnings.push_back("vertices that repeat others merged: " + std::to_string(equal));
  }
  if (dropped > 0) {
    result.warnings.push_back("segments without length left out: " + std::to_string(dropped));
  }
}

struct CountedEdge {
  std::array<std::uint32_t, 2> ends;  // the smaller index first
  std::uint32_t position;             // of its first appearance
  std::uint32_t count;
};

// Edges with the number of their appearances, in the order of the first.
std::vector<CountedEdge> count_edges(std::vector<std::array<std::uint32_t, 2>> edges) {
  std::vector<CountedEdge> result;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i];
    if (a != b) result.push_back({{std::min(a, b), std::max(a, b)}, i, 1});
  }
  std::sort(result.begin(), result.end(), [](const CountedEdge& e, const CountedEdge& f) {
    return e.ends != f.ends ? e.ends < f.ends : e.position < f.position;
  });
  std::size_t n = 0;
  for (std::size_t k = 0; k < result.size(); ++k) {
    if (n > 0 && result[n - 1].ends == result[k].ends) {
      ++result[n - 1].count;
    } else {
      result[n++] = result[k];
    }
  }
  result.resize(n);
  std::sort(result.begin(), result.end(),
            [](const CountedEdge& e, const CountedEdge& f) { return e.position < f.position; });
  return result;
}

// Adds the edges that are not there yet, in either direction.
void add_lines(const std::vector<std::array<std::uint32_t, 2>>& lines, bool bounding,
               PlanarGraph& graph) {
  const auto sorted = [](const std::array<std::uint32_t, 2>& s) {
    return std::array{std::min(s[0], s[1]), std::max(s[0], s[1])};
  };
  std::vector<std::array<std::uint32_t, 2>> there;
  for (const auto& segment : graph.segments) there.push_back(sorted(segment));
  std::sort(there.begin(), there.end());
  for (const CountedEdge& line : count_edges(lines)) {
    if (std::binary_search(there.begin(), there.end(), line.ends)) continue;
    graph.segments.push_back(line.ends);
    graph.partitions.push_back(!bounding);
  }
}

bool has_extension(const std::string& path, std::string_view extension) {
  return equal_ignoring_case(std::filesystem::path(path).extension().string(), extension);
}

void read_by_format(std::string_view bytes, const std::string& path, const NodeFile& node_file,
                    const std::function<bool()>& go_on, PlaneReadResult& result) {
  Polling polling(go_on);
  if (looks_like_off(bytes) || has_extension(path, ".off") || has_extension(path, ".obj")) {
    ReadOptions options;
    options.planar = true;
    options.go_on = go_on;
    ReadResult surface = parse_surface(bytes, path, options);
    result.code = surface.code;
    result.error = surface.error;
    result.format = surface.format;
    result.warnings = surface.warnings;
    if (surface.ok()) result.graph = outline(surface.surface, surface.lines);
  } else if (has_extension(path, ".poly")) {
    result.format = "poly";
    read_triangle_poly(bytes, node_file, polling, result);
  } else if (has_extension(path, ".stl") || has_extension(path, ".ply") ||
             has_extension(path, ".3mf") || has_extension(path, ".smesh")) {
    fail(at_line(1), "a surface: a planar graph is a .poly, an OFF or OBJ with z = 0, or rings");
  } else {
    result.format = "polygons";
    read_polygons(bytes, polling, result);
  }
}

}  // namespace

void read_triangle_poly(std::string_view text, const NodeFile& node_file, Polling& polling,
                        PlaneReadResult& result) {
  result.graph.insideness = Insideness::enclosed;
  PolyReader reader(text, polling, result.graph);
  if (reader.read_header()) {
    reader.read_vertices();
  } else {
    const auto nodes = node_file ? node_file() : std::nullopt;
    if (!nodes) fail(at_line(1), "no vertices, and no .node file beside it");
    PolyReader node_reader(*nodes, polling, result.graph);
    try {
      if (node_reader.read_header()) node_reader.read_vertices();
    } catch (const ParseError& error) {
      fail(at_line(1), "in the .node file, " + describe(error.position) + ": " + error.reason);
    }
    reader.take_base(node_reader);
  }
  reader.read_segments();
  reader.read_holes_and_regions(result.warnings);
  weld_graph(result);
}

void read_polygons(std::string_view text, Polling& polling, PlaneReadResult& result) {
  TextLines in(text, Comments::anywhere, ',');
  std::vector<Point2> points;
  std::vector<std::size_t> ends;  // of the rings, in points
  const auto close = [&] {
    if (points.size() > (ends.empty() ? 0 : ends.back())) ends.push_back(points.size());
  };
  bool more_columns = false;
  while (in.next_raw_line()) {
    polling.poll(8);
    const std::string_view rest = in.rest_of_line();
    if (rest.empty() || rest[0] == '>') {
      close();
      continue;
    }
    const double x = need_number(in, "x");
    points.push_back({x, need_number(in, "y")});
    more_columns = more_columns || !in.rest_of_line().empty();
    if (points.size() >= kMaxVertices) fail(at_line(in.line()), "too many points");
  }
  close();
  if (ends.empty()) fail({}, "no points");
  if (more_columns) result.warnings.push_back("columns after x and y ignored");
  PlanarGraph& graph = result.graph;
  graph.insideness = Insideness::nested;
  const std::vector<std::uint32_t> number = weld(points, graph.vertices);
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t j = i + 1 < end ? i + 1 : begin;
      if (end - begin == 2 && i > begin) continue;  // a single segment, not there and back
      edges.push_back({number[i], number[j]});
    }
    begin = end;
  }
  for (const CountedEdge& edge : count_edges(std::move(edges))) {
    graph.segments.push_back(edge.ends);
    graph.partitions.push_back(edge.count % 2 == 0);
  }
}

PlanarGraph outline(const Surface& surface,
                    const std::vector<std::array<std::uint32_t, 2>>& lines) {
  PlanarGraph graph;
  graph.insideness = Insideness::nested;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const auto& [x, y, z] = surface.vertices[i];
    if (z != 0) fail({}, "vertex " + std::to_string(i) + " is not in the plane z = 0");
    graph.vertices.push_back({x + 0.0, y + 0.0});
  }
  std::vector<std::array<std::uint32_t, 2>> edges;
  const auto label = [&](std::size_t t) { return surface.labels.empty() ? 0 : surface.labels[t]; };
  for (const auto& [a, b, c] : surface.triangles) {
    edges.push_back({a, b});
    edges.push_back({b, c});
    edges.push_back({c, a});
  }
  // The last triangle at an edge, to compare labels with the first.
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> at;
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    at.push_back({{std::min(edges[i][0], edges[i][1]), std::max(edges[i][0], edges[i][1])}, i / 3});
  }
  std::sort(at.begin(), at.end());
  // On which side of the edge the triangle lies.
  const auto side = [&](std::uint32_t t, const CountedEdge& edge) {
    const auto [a, b] = edge.ends;
    int sign = 0;
    for (const std::uint32_t v : surface.triangles[t]) {
      if (v != a && v != b) {
        sign = orient2d_sign(graph.vertices[a], graph.vertices[b], graph.vertices[v]);
      }
    }
    return sign;
  };
  for (const CountedEdge& edge : count_edges(edges)) {
    const auto [a, b] = edge.ends;
    if (edge.count > 2) {
      fail({}, "edge " + std::to_string(a) + "-" + std::to_string(b) + " has " +
                   std::to_string(edge.count) + " triangles");
    }
    const auto first = std::lower_bound(at.begin(), at.end(), std::pair(edge.ends, 0U));
    if (edge.count == 2 && side(first->second, edge) * side((first + 1)->second, edge) > 0) {
      fail({}, "triangles " + std::to_string(first->second) + " and " +
                   std::to_string((first + 1)->second) + " overlap");
    }
    if (edge.count == 2 && label(first->second) == label((first + 1)->second)) continue;
    graph.segments.push_back(edge.ends);
    graph.partitions.push_back(edge.count == 2);
  }
  add_lines(lines, surface.triangles.empty(), graph);
  return graph;
}

bool is_plane(std::string_view bytes, const std::string& path) {
  TextLines in(bytes, Comments::anywhere, ',');
  std::string_view token;
  double number = 0;
  if (has_extension(path, ".poly")) {
    return in.next_line() && in.next_token(token) && in.next_token(token) && token == "2";
  }
  for (const char* extension : {".off", ".obj", ".stl", ".ply", ".3mf", ".smesh"}) {
    if (has_extension(path, extension)) return false;
  }
  // Rings: lines of two numbers, after lines that begin with '>'.
  while (in.next_line()) {
    if (in.rest_of_line()[0] == '>') continue;
    for (int i = 0; i < 2; ++i) {
      if (!in.next_token(token) || parse_double(token, number) != NumberStatus::ok) return false;
    }
    return true;
  }
  return false;
}

bool is_plane_file(const std::string& path) {
  if (path == "-") return false;
  try {
    return is_plane(read_file(path), without_gz(path));
  } catch (const FileError&) {
    return false;  // for others to say
  }
}

PlaneReadResult parse_plane(std::string_view bytes, const std::string& path,
                            const NodeFile& node_file, const std::function<bool()>& go_on) {
  return caught<PlaneReadResult>(path, [&](PlaneReadResult& result) {
    read_by_format(bytes, path, node_file, go_on, result);
  });
}

PlaneReadResult read_plane(const std::string& path, const std::function<bool()>& go_on) {
  return caught<PlaneReadResult>(path, [&](PlaneReadResult& result) {
    const std::string bytes = read_file(path, go_on);
    read_by_format(
        bytes, without_gz(path), [&] { return read_beside(path, ".node", go_on); }, go_on, result);
  });
}

}  // namespace delmesher::io
