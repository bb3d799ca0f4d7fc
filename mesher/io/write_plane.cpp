#include "mesher/io/write_plane.h"

#include <algorithm>
#include <filesystem>

#include "mesher/io/file_formats.h"
#include "mesher/io/write_plane_formats.h"

namespace delmesher::io {
namespace {

const char* inconsistency(const PlaneMesh& mesh) {
  const auto in_range = [&](const auto& cells) {
    return std::all_of(cells.begin(), cells.end(), [&](const auto& cell) {
      return std::all_of(cell.begin(), cell.end(),
                         [&](std::uint32_t v) { return v < mesh.vertices.size(); });
    });
  };
  if (mesh.inside.size() != mesh.triangles.size()) return "inside flags do not match";
  if (mesh.edge_markers.size() != mesh.edges.size()) return "markers do not match";
  if (mesh.edge_segments.size() != mesh.edges.size()) return "segments do not match";
  if (!mesh.attributes.empty() && mesh.attributes.size() != mesh.triangles.size()) {
    return "attributes do not match";
  }
  if (!in_range(mesh.triangles) || !in_range(mesh.edges)) return "a vertex is out of range";
  return nullptr;
}

// The last sections of a .poly.
void write_holes_and_regions(TextSink& out, const PlanarGraph& graph) {
  out.integer(graph.holes.size());
  line(out);
  for (std::size_t i = 0; i < graph.holes.size(); ++i) {
    out.integers(i);
    point(out, graph.holes[i]);
    line(out);
  }
  if (graph.regions.empty()) return;
  out.integer(graph.regions.size());
  line(out);
  for (std::size_t i = 0; i < graph.regions.size(); ++i) {
    out.integers(i);
    point(out, graph.regions[i].point);
    out.text(" ");
    out.number(graph.regions[i].attribute);
    line(out);
  }
}

// The attribute is that of the region if the input has regions, else 1 inside and 2 outside if
// there are both.
void write_triangle(TextSink& node, TextSink& ele, TextSink& poly, const PlaneMesh& mesh,
                    const PlanarGraph* graph) {
  node.integer(mesh.vertices.size());
  node.text(" 2 0 0\n");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    node.integers(i);
    point(node, mesh.vertices[i]);
    line(node);
  }
  const bool sides = std::count(mesh.inside.begin(), mesh.inside.end(), 0) > 0;
  const bool attributes = sides || !mesh.attributes.empty();
  ele.integer(mesh.triangles.size());
  ele.text(attributes ? " 3 1\n" : " 3 0\n");
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ele.integers(t);
    for (const std::uint32_t v : mesh.triangles[t]) ele.integers(v);
    if (!mesh.attributes.empty()) {
      ele.number(mesh.attributes[t]);
    } else if (sides) {
      ele.integer(region(mesh, t));
    }
    line(ele);
  }
  poly.text("0 2 0 0\n");
  poly.integer(mesh.edges.size());
  poly.text(" 1\n");
  for (std::size_t i = 0; i < mesh.edges.size(); ++i) {
    poly.integers(i, mesh.edges[i][0], mesh.edges[i][1]);
    poly.integer(mesh.edge_markers[i]);
    line(poly);
  }
  write_holes_and_regions(poly, graph != nullptr ? *graph : PlanarGraph{});
}

void write_off(TextSink& out, const PlaneMesh& mesh) {
  out.text("OFF\n");
  out.integers(mesh.vertices.size(), mesh.triangles.size());
  out.text("0\n");
  for (const Point2& p : mesh.vertices) {
    point(out, p);
    out.text(" 0\n");
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    out.text("3 ");
    out.integers(a, b);
    out.integer(c);
    line(out);
  }
}

struct PlaneOutput {
  const PlaneMesh& mesh;
  const PlanarGraph* graph;  // null: no holes and regions
  const WriteOptions& options;
};

// The extension of the path first, then the extensions of the files beside it.
constexpr std::array<FileFormat<PlaneOutput>, 5> kFormats = {
    {{{".node", ".ele", ".poly"},
      [](Sinks f, const PlaneOutput& o) { write_triangle(*f[0], *f[1], *f[2], o.mesh, o.graph); }},
     {{".vtu"},
      [](Sinks f, const PlaneOutput& o) { write_plane_vtu(*f[0], o.mesh, o.options.ascii); }},
     {{".off"},
      [](Sinks f, const PlaneOutput& o) { write_off(*f[0], o.mesh); },
      kLacksLabels | kLacksRegions | kLacksSides},
     {{".msh"},
      [](Sinks f, const PlaneOutput& o) {
        write_plane_gmsh(*f[0], o.mesh, o.options.ascii, o.options.msh);
      }},
     {{".svg"}, [](Sinks f, const PlaneOutput& o) { write_svg(*f[0], o.mesh); }}}};

}  // namespace

std::string plane_extensions() {
  return extensions_of(kFormats);
}

std::vector<std::string> plane_files_of(const std::string& path) {
  return files_made(kFormats, path);
}

WriteStatus write_plane(OutputSet& outputs, const std::string& path, const PlaneMesh& mesh,
                        const PlanarGraph* graph, const WriteOptions& options) {
  const char* reason = plane_files_of(path).empty() ? nullptr : inconsistency(mesh);
  if (reason != nullptr) return {path + ": inconsistent mesh: " + reason};
  unsigned there = several(mesh.attributes) ? kLacksRegions : kLacksNothing;
  if (several(mesh.edge_markers)) there |= kLacksLabels;
  if (several(mesh.inside)) there |= kLacksSides;
  return write_by_extension(kFormats, outputs, path, PlaneOutput{mesh, graph, options}, there);
}

WriteStatus write_poly(OutputSet& outputs, const std::string& path, const PlanarGraph& graph) {
  WriteStatus status;
  TextSink* out = outputs.open(path, status);
  if (out == nullptr) return status;
  out->integer(graph.vertices.size());
  out->text(" 2 0 0\n");
  for (std::size_t i = 0; i < graph.vertices.size(); ++i) {
    out->integers(i);
    point(*out, graph.vertices[i]);
    line(*out);
  }
  out->integer(graph.segments.size());
  out->text(graph.markers.empty() ? " 0\n" : " 1\n");
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    out->integers(i, graph.segments[i][0], graph.segments[i][1]);
    if (!graph.markers.empty()) out->integer(graph.markers[i]);
    line(*out);
  }
  write_holes_and_regions(*out, graph);
  return status;
}

bool is_graph_file(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return equal_ignoring_case(extension, ".poly") || equal_ignoring_case(extension, ".txt");
}

WriteStatus write_graph(OutputSet& outputs, const std::string& path, const PlanarGraph& graph) {
  const bool rings = graph.insideness == Insideness::nested;
  const std::string extension = std::filesystem::path(path).extension().string();
  if (equal_ignoring_case(extension, ".poly") == rings) {
    return {path + (rings ? ": a .poly has no nested rings; write .txt"
                          : ": rings have no holes, regions and markers; write .poly")};
  }
  if (!rings) return write_poly(outputs, path, graph);
  WriteStatus status;
  TextSink* out = outputs.open(path, status);
  if (out == nullptr) return status;
  for (std::size_t i = 0; i < graph.segments.size(); ++i) {
    const bool divides = !graph.partitions.empty() && graph.partitions[i] != 0;
    for (int times = divides ? 2 : 1; times > 0; --times) {
      for (const std::uint32_t v : graph.segments[i]) {
        point(*out, graph.vertices[v]);
        line(*out);
      }
      line(*out);
    }
  }
  return status;
}

}  // namespace delmesher::io
