#include "mesher/io/write_plane.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "mesher/io/file_formats.h"

namespace delmesher::io {
namespace {

using Point2 = std::array<double, 2>;

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

int region(const PlaneMesh& mesh, std::size_t t) {
  return mesh.inside[t] != 0 ? 1 : 2;
}

void point(TextSink& out, const Point2& p) {
  out.number(p[0]);
  out.text(" ");
  out.number(p[1]);
}

void line(TextSink& out) {
  out.text("\n");
}

// A region attribute if the input has regions, else 1 inside and 2 outside if there are both.
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

void begin_array(TextSink& out, const char* type, const char* name) {
  out.text("<DataArray type=\"");
  out.text(type);
  out.text("\" Name=\"");
  out.text(name);
  out.text("\" format=\"ascii\">\n");
}

// Triangles, then the edges on segments.
template <class TriangleValue, class EdgeValue>
void cell_array(TextSink& out, const PlaneMesh& mesh, const char* type, const char* name,
                TriangleValue triangle_value, EdgeValue edge_value) {
  begin_array(out, type, name);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    triangle_value(t);
    line(out);
  }
  for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
    edge_value(e);
    line(out);
  }
  out.text("</DataArray>\n");
}

void write_vtu(TextSink& out, const PlaneMesh& mesh) {
  const std::size_t triangles = mesh.triangles.size();
  out.text(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"");
  out.integer(mesh.vertices.size());
  out.text("\" NumberOfCells=\"");
  out.integer(triangles + mesh.edges.size());
  out.text(
      "\">\n<Points>\n"
      "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n");
  for (const Point2& p : mesh.vertices) {
    point(out, p);
    out.text(" 0\n");
  }
  out.text("</DataArray>\n</Points>\n<Cells>\n");
  cell_array(
      out, mesh, "Int64", "connectivity",
      [&](std::size_t t) {
        for (const std::uint32_t v : mesh.triangles[t]) out.integers(v);
      },
      [&](std::size_t e) { out.integers(mesh.edges[e][0], mesh.edges[e][1]); });
  cell_array(
      out, mesh, "Int64", "offsets", [&](std::size_t t) { out.integer(3 * (t + 1)); },
      [&](std::size_t e) { out.integer(3 * triangles + 2 * (e + 1)); });
  cell_array(
      out, mesh, "UInt8", "types", [&](std::size_t) { out.integer(5); },
      [&](std::size_t) { out.integer(3); });
  out.text("</Cells>\n<CellData>\n");
  cell_array(
      out, mesh, "Int8", "inside", [&](std::size_t t) { out.integer(mesh.inside[t] != 0 ? 1 : 0); },
      [&](std::size_t) { out.integer(-1); });
  cell_array(
      out, mesh, "Int32", "marker", [&](std::size_t) { out.integer(0); },
      [&](std::size_t e) { out.integer(mesh.edge_markers[e]); });
  cell_array(
      out, mesh, "Int64", "segment", [&](std::size_t) { out.integer(-1); },
      [&](std::size_t e) { out.integer(mesh.edge_segments[e]); });
  if (!mesh.attributes.empty()) {
    cell_array(
        out, mesh, "Float64", "attribute", [&](std::size_t t) { out.number(mesh.attributes[t]); },
        [&](std::size_t) { out.integer(0); });
  }
  out.text("</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
}

// Gmsh MSH 4.1, ASCII: one curve per marker, one surface per side.
class PlaneGmshWriter {
 public:
  PlaneGmshWriter(TextSink& out, const PlaneMesh& mesh) : out_(out), mesh_(mesh) {
    for (std::size_t e = 0; e < mesh.edges.size(); ++e) {
      curves_[mesh.edge_markers[e]].push_back(e);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      surfaces_[region(mesh, t)].push_back(t);
    }
  }

  void write() {
    out_.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    write_names();
    write_entities();
    write_nodes();
    write_elements();
  }

 private:
  void write_names() {
    out_.text("$PhysicalNames\n");
    out_.integer(curves_.size() + surfaces_.size());
    line(out_);
    int tag = 0;
    for (const auto& [marker, edges] : curves_) {
      out_.integers(1, ++tag);
      out_.text("\"marker ");
      out_.integer(marker);
      out_.text("\"\n");
    }
    for (const auto& [side, triangles] : surfaces_) {
      out_.integers(2, side);
      out_.text(side == 1 ? "\"inside\"\n" : "\"outside\"\n");
    }
    out_.text("$EndPhysicalNames\n");
  }

  void write_entity(int tag) {
    out_.integers(tag);
    for (const Point2& p : {low_, high_}) {
      point(out_, p);
      out_.text(" 0 ");
    }
    out_.integers(1, tag);
    out_.text("0\n");
  }

  void write_entities() {
    if (!mesh_.vertices.empty()) low_ = high_ = mesh_.vertices[0];
    for (const Point2& p : mesh_.vertices) {
      for (std::size_t k = 0; k < 2; ++k) {
        low_[k] = std::min(low_[k], p[k]);
        high_[k] = std::max(high_[k], p[k]);
      }
    }
    out_.text("$Entities\n0 ");
    out_.integers(curves_.size(), surfaces_.size());
    out_.text("0\n");
    for (std::size_t k = 0; k < curves_.size(); ++k) write_entity(static_cast<int>(k) + 1);
    for (const auto& [side, triangles] : surfaces_) write_entity(side);
    out_.text("$EndEntities\n");
  }

  void write_nodes() {
    const std::size_t n = mesh_.vertices.size();
    const int side = surfaces_.empty() ? 1 : surfaces_.begin()->first;
    out_.text("$Nodes\n");
    out_.integers(n == 0 ? 0 : 1, n, n == 0 ? 0 : 1);
    out_.integer(n);
    line(out_);
    if (n != 0) {
      out_.integers(2, side, 0);
      out_.integer(n);
      line(out_);
    }
    for (std::size_t i = 1; i <= n; ++i) {
      out_.integer(i);
      line(out_);
    }
    for (const Point2& p : mesh_.vertices) {
      point(out_, p);
      out_.text(" 0\n");
    }
    out_.text("$EndNodes\n");
  }

  template <class Cells>
  void write_block(int dimension, int tag, int type, const std::vector<std::size_t>& members,
                   const Cells& cells) {
    out_.integers(dimension, tag, type);
    out_.integer(members.size());
    line(out_);
    for (const std::size_t i : members) {
      out_.integers(++element_);
      for (const std::uint32_t v : cells[i]) out_.integers(v + 1);
      line(out_);
    }
  }

  void write_elements() {
    const std::size_t total = mesh_.edges.size() + mesh_.triangles.size();
    out_.text("$Elements\n");
    out_.integers(curves_.size() + surfaces_.size(), total, total == 0 ? 0 : 1);
    out_.integer(total);
    line(out_);
    int tag = 0;
    for (const auto& [marker, edges] : curves_) write_block(1, ++tag, 1, edges, mesh_.edges);
    for (const auto& [side, triangles] : surfaces_) {
      write_block(2, side, 2, triangles, mesh_.triangles);
    }
    out_.text("$EndElements\n");
  }

  TextSink& out_;
  const PlaneMesh& mesh_;
  std::map<std::int32_t, std::vector<std::size_t>> curves_;
  std::map<int, std::vector<std::size_t>> surfaces_;
  Point2 low_ = {0, 0}, high_ = {0, 0};
  std::size_t element_ = 0;
};

double smallest_angle(const PlaneMesh& mesh, std::size_t t) {
  double least = 180;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& v = mesh.triangles[t];
    const Point2 &o = mesh.vertices[v[i]], &a = mesh.vertices[v[(i + 1) % 3]],
                 &b = mesh.vertices[v[(i + 2) % 3]];
    const double ux = a[0] - o[0], uy = a[1] - o[1], vx = b[0] - o[0], vy = b[1] - o[1];
    least = std::min(least, std::atan2(std::fabs(ux * vy - uy * vx), ux * vx + uy * vy) * 57.29578);
  }
  return least;
}

// From red (0 degrees) over yellow to green (60): one path per colour.
void write_svg(TextSink& out, const PlaneMesh& mesh) {
  constexpr int kColours = 12;
  constexpr double kWidth = 1000;
  Point2 low = {0, 0}, high = {1, 1};
  if (!mesh.vertices.empty()) low = high = mesh.vertices[0];
  for (const Point2& p : mesh.vertices) {
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const double extent = std::max(high[0] / 2 - low[0] / 2, high[1] / 2 - low[1] / 2);
  const auto fraction = [&](double x, double from) {
    return extent > 0 ? (x / 2 - from / 2) / extent * kWidth : 0;
  };
  const auto decimal = [&](double x) {  // to a thousandth
    out.number(std::round(x * 1000) / 1000);
  };
  const auto place = [&](const Point2& p) {
    decimal(fraction(p[0], low[0]));
    out.text(" ");
    decimal(fraction(high[1], low[1]) - fraction(p[1], low[1]));  // y grows downwards
  };
  out.text("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-5 -5 ");
  decimal(fraction(high[0], low[0]) + 10);
  out.text(" ");
  decimal(fraction(high[1], low[1]) + 10);
  out.text(
      "\">\n<style>path{stroke:#333;stroke-width:.3;stroke-linejoin:round;stroke-linecap:round}"
      "</style>\n");
  std::vector<std::vector<std::size_t>> of_colour(kColours + 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto k =
        std::min(kColours - 1, static_cast<int>(smallest_angle(mesh, t) / 60 * kColours));
    of_colour[static_cast<std::size_t>(mesh.inside[t] != 0 ? k : kColours)].push_back(t);
  }
  for (std::size_t k = 0; k <= kColours; ++k) {
    if (of_colour[k].empty()) continue;
    out.text("<path fill=\"");
    if (k == kColours) {
      out.text("#eee");
    } else {
      out.text("hsl(");
      out.integer(120 * k / (kColours - 1));
      out.text(",75%,65%)");
    }
    out.text("\" d=\"");
    for (const std::size_t t : of_colour[k]) {
      const auto& [a, b, c] = mesh.triangles[t];
      out.text("M");
      place(mesh.vertices[a]);
      out.text("L");
      place(mesh.vertices[b]);
      out.text("L");
      place(mesh.vertices[c]);
      out.text("Z");
    }
    out.text("\"/>\n");
  }
  out.text("<path style=\"stroke:#000;stroke-width:1.5\" fill=\"none\" d=\"");
  for (const auto& [a, b] : mesh.edges) {
    out.text("M");
    place(mesh.vertices[a]);
    out.text("L");
    place(mesh.vertices[b]);
  }
  out.text("\"/>\n</svg>\n");
}

void section(TextSink& out, const char* name, std::size_t count) {
  out.text(name);
  out.text(" ");
  out.integer(count);
  line(out);
}

void write_triangles(TextSink& out, const char* name,
                     const std::vector<PlaneRecord::Triangle>& triangles) {
  section(out, name, triangles.size());
  for (const auto& triangle : triangles) {
    for (const std::uint32_t v : triangle.vertices) out.integers(v);
    out.integer(static_cast<int>(triangle.side));
    line(out);
  }
}

void write_edges(TextSink& out, const char* name, const std::vector<PlaneRecord::Edge>& edges) {
  section(out, name, edges.size());
  for (const auto& edge : edges) {
    out.integers(edge.vertices[0], edge.vertices[1]);
    out.integer(edge.segment);
    line(out);
  }
}

struct PlaneOutput {
  const PlaneMesh& mesh;
  const PlanarGraph* graph;  // null: no holes and regions
};

// The extension of the path first, then the extensions of the files beside it.
constexpr std::array<FileFormat<PlaneOutput>, 5> kFormats = {
    {{{".node", ".ele", ".poly"},
      [](Sinks f, const PlaneOutput& o) { write_triangle(*f[0], *f[1], *f[2], o.mesh, o.graph); }},
     {{".vtu"}, [](Sinks f, const PlaneOutput& o) { write_vtu(*f[0], o.mesh); }},
     {{".off"}, [](Sinks f, const PlaneOutput& o) { write_off(*f[0], o.mesh); }},
     {{".msh"}, [](Sinks f, const PlaneOutput& o) { PlaneGmshWriter(*f[0], o.mesh).write(); }},
     {{".svg"}, [](Sinks f, const PlaneOutput& o) { write_svg(*f[0], o.mesh); }}}};

}  // namespace

std::string plane_extensions() {
  return extensions_of(kFormats);
}

std::vector<std::string> plane_files_of(const std::string& path) {
  return files_made(kFormats, path);
}

WriteStatus write_plane(OutputSet& outputs, const std::string& path, const PlaneMesh& mesh,
                        const PlanarGraph* graph) {
  const char* reason = plane_files_of(path).empty() ? nullptr : inconsistency(mesh);
  if (reason != nullptr) return {path + ": inconsistent mesh: " + reason};
  return write_by_extension(kFormats, outputs, path, PlaneOutput{mesh, graph});
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

WriteStatus write_plane_exact(OutputSet& outputs, const std::string& path,
                              const PlaneRecord& record) {
  WriteStatus status;
  TextSink* out = outputs.open(path, status);
  if (out == nullptr) return status;
  out->text("delmesher-plane-exact 1\n");
  section(*out, "points", record.points.size());
  for (const ExactPoint& p : record.points) {
    if (p.kind == ExactPoint::Kind::explicit_point) {
      out->text("E ");
      out->hex(p.x);
      out->text(" ");
      out->hex(p.y);
    } else {
      out->text("S ");
      out->integers(p.i, p.j);
      out->hex(p.x);
    }
    line(*out);
  }
  section(*out, "corners", record.corners.size());
  for (const auto& corner : record.corners) {
    out->integers(corner.vertex);
    out->hex(corner.radius);
    line(*out);
  }
  section(*out, "dropped", record.dropped.size());
  for (const std::uint32_t segment : record.dropped) {
    out->integer(segment);
    line(*out);
  }
  out->text("bounds ");
  out->hex(record.delta);
  out->text(" ");
  out->hex(record.acute);
  line(*out);
  write_triangles(*out, "refined", record.refined);
  write_edges(*out, "refined_edges", record.refined_edges);
  write_triangles(*out, "final", record.final);
  write_edges(*out, "final_edges", record.final_edges);
  section(*out, "mesh_vertices", record.mesh_vertices.size());
  for (const std::uint32_t v : record.mesh_vertices) {
    out->integer(v);
    line(*out);
  }
  out->text("end\n");
  return status;
}

}  // namespace delmesher::io
