#include "mesher/cli/defects.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "mesher/io/text.h"

namespace delmesher::cli {
namespace {

using Kind = Defect::Kind;

std::uint64_t count_of(const SurfaceReport& report, Kind kind) {
  return report.defect_counts[static_cast<std::size_t>(kind)];
}

const std::vector<std::array<std::uint32_t, 2>>& places_of(const SurfaceReport& report, Kind kind) {
  return report.places[static_cast<std::size_t>(kind)];
}

using Colour = std::array<int, 3>;
constexpr Colour kGrey = {190, 190, 190}, kRed = {220, 40, 40}, kOrange = {250, 150, 30},
                 kViolet = {150, 60, 190}, kBlue = {50, 90, 220}, kGreen = {40, 160, 70};

Colour colour_of(Kind kind) {
  switch (kind) {
    case Kind::self_intersection:
      return kRed;
    case Kind::open_edge:
      return kOrange;
    case Kind::non_manifold_edge:
    case Kind::non_manifold_vertex:
      return kViolet;
    case Kind::inconsistent_orientation:
      return kBlue;
    case Kind::degenerate_triangle:
    case Kind::duplicate_triangle:
      return kGreen;
    default:
      return kGrey;
  }
}

struct WrongEdge {
  std::array<std::uint32_t, 2> vertices;
  std::vector<std::uint32_t> triangles;
  Kind kind;
};

// Edges of one triangle, of more than two, and of two that run along it the same way.
std::vector<WrongEdge> wrong_edges(const Surface& surface) {
  struct Use {
    std::vector<std::uint32_t> triangles;
    int forward = 0;  // of them go from the lower to the higher vertex
  };
  std::map<std::array<std::uint32_t, 2>, Use> edges;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corners = surface.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      Use& use = edges[{std::min(a, b), std::max(a, b)}];
      use.triangles.push_back(t);
      use.forward += a < b ? 1 : 0;
    }
  }
  std::vector<WrongEdge> wrong;
  for (auto& [vertices, use] : edges) {
    const std::size_t count = use.triangles.size();
    if (vertices[0] == vertices[1] || (count == 2 && use.forward == 1)) continue;
    const Kind kind = count == 1  ? Kind::open_edge
                      : count > 2 ? Kind::non_manifold_edge
                                  : Kind::inconsistent_orientation;
    wrong.push_back({vertices, std::move(use.triangles), kind});
  }
  return wrong;
}

// What is wrong at each triangle, if anything is. What says most comes last, so that it is seen: a
// triangle of a wrong vertex may be as it should be, one that meets another is not.
std::vector<std::optional<Kind>> kinds_at(const Surface& surface, const SurfaceReport& report,
                                          const std::vector<WrongEdge>& edges) {
  std::vector<std::optional<Kind>> kinds(surface.triangles.size());
  const auto mark_around_vertices = [&](Kind kind) {
    std::vector<std::uint8_t> wrong(surface.vertices.size(), 0);
    for (const auto& place : places_of(report, kind)) wrong[place[0]] = 1;
    for (std::size_t t = 0; t < kinds.size(); ++t) {
      for (const std::uint32_t v : surface.triangles[t]) {
        if (v < wrong.size() && wrong[v] != 0) kinds[t] = kind;
      }
    }
  };
  mark_around_vertices(Kind::non_manifold_vertex);
  for (const Kind kind :
       {Kind::inconsistent_orientation, Kind::open_edge, Kind::non_manifold_edge}) {
    for (const WrongEdge& edge : edges) {
      if (edge.kind != kind) continue;
      for (const std::uint32_t t : edge.triangles) kinds[t] = kind;
    }
  }
  mark_around_vertices(Kind::non_finite);
  for (const Kind kind : {Kind::index_out_of_range, Kind::degenerate_triangle,
                          Kind::duplicate_triangle, Kind::self_intersection}) {
    for (const auto& place : places_of(report, kind)) {
      for (const std::uint32_t t : place) kinds[t] = kind;
    }
  }
  return kinds;
}

template <class Value>
void vtu_array(std::string& out, const char* attributes, std::size_t count, const Value& value) {
  out += std::string("<DataArray ") + attributes + " format=\"ascii\">\n";
  for (std::size_t i = 0; i < count; ++i) out += value(i) + "\n";
  out += "</DataArray>\n";
}

template <std::size_t size>
std::string numbers(const std::array<std::uint32_t, size>& list) {
  std::string text;
  for (const std::uint32_t n : list) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}

std::string coordinates(const std::array<double, 3>& p) {
  std::string text;
  for (const double x : p) {
    if (!text.empty()) text += ' ';
    io::append_double(text, x);
  }
  return text;
}

// To the points; `kind_name(k)`: of number k + 1.
template <class KindName, class Point>
std::string begin_vtu(std::size_t kinds, const KindName& kind_name, std::size_t points,
                      const Point& point, std::size_t cells) {
  std::string out = "<?xml version=\"1.0\"?>\n<!-- delmesher, defect: 0 none";
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    out += ", " + std::to_string(kind + 1) + " " + kind_name(kind);
  }
  out +=
      " -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
      std::to_string(points) + "\" NumberOfCells=\"" + std::to_string(cells) + "\">\n<Points>\n";
  vtu_array(out, "type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"", points,
            [&](std::size_t i) { return coordinates(point(i)); });
  return out + "</Points>\n";
}

constexpr const char* kEndOfVtu = "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

}  // namespace

std::string coloured_ply(const Surface& surface, const SurfaceReport& report) {
  std::string out =
      "ply\nformat ascii 1.0\ncomment delmesher: red self-intersections, orange open edges, violet "
      "not "
      "manifold, blue orientation, green without area or double\nelement vertex " +
      std::to_string(surface.vertices.size()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(surface.triangles.size()) +
      "\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nend_header\n";
  for (const auto& p : surface.vertices) out += coordinates(p) + "\n";
  const std::vector<std::optional<Kind>> kinds = kinds_at(surface, report, wrong_edges(surface));
  for (std::size_t t = 0; t < kinds.size(); ++t) {
    out += "3";
    for (const std::uint32_t v : surface.triangles[t]) out += " " + std::to_string(v);
    for (const int c : kinds[t] ? colour_of(*kinds[t]) : kGrey) out += " " + std::to_string(c);
    out += "\n";
  }
  return out;
}

std::string defects_vtu(const Surface& surface, const SurfaceReport& report) {
  std::vector<WrongEdge> edges = wrong_edges(surface);
  const std::vector<std::optional<Kind>> kinds = kinds_at(surface, report, edges);
  // No program draws edges whose vertices are not there.
  if (count_of(report, Kind::index_out_of_range) > 0) edges.clear();
  const std::size_t triangles = kinds.size(), cells = triangles + edges.size();
  std::string out = begin_vtu(
      report.defect_counts.size(),
      [](std::size_t kind) { return defect_name(static_cast<Kind>(kind)); },
      surface.vertices.size(), [&](std::size_t i) { return surface.vertices[i]; }, cells);
  out += "<Cells>\n";
  vtu_array(out, "type=\"Int64\" Name=\"connectivity\"", cells, [&](std::size_t i) {
    if (i < triangles) return numbers(surface.triangles[i]);
    return numbers(edges[i - triangles].vertices);
  });
  vtu_array(out, "type=\"Int64\" Name=\"offsets\"", cells, [&](std::size_t i) {
    const std::size_t lines = i < triangles ? 0 : i + 1 - triangles;
    return std::to_string(3 * (i + 1 - lines) + 2 * lines);
  });
  vtu_array(out, "type=\"UInt8\" Name=\"types\"", cells, [&](std::size_t i) {
    return std::string(i < triangles ? "5" : "3");  // VTK_TRIANGLE, VTK_LINE
  });
  out += "</Cells>\n<CellData Scalars=\"defect\">\n";
  vtu_array(out, "type=\"UInt8\" Name=\"defect\"", cells, [&](std::size_t i) {
    const std::optional<Kind> kind = i < triangles ? kinds[i] : edges[i - triangles].kind;
    return std::to_string(kind ? static_cast<int>(*kind) + 1 : 0);
  });
  if (surface.labels.size() == triangles) {
    vtu_array(out, "type=\"Int32\" Name=\"label\"", cells,
              [&](std::size_t i) { return std::to_string(i < triangles ? surface.labels[i] : 0); });
  }
  return out + kEndOfVtu;
}

std::string graph_defects_vtu(const PlanarGraph& graph, const GraphReport& report) {
  const std::size_t n = graph.segments.size();
  std::vector<int> kinds(n, 0);
  for (std::size_t kind = 0; kind < kGraphDefects; ++kind) {
    for (const auto& place : report.places[kind]) {
      if (static_cast<GraphDefect>(kind) == GraphDefect::equal_vertices) continue;
      for (const std::uint32_t s : place) kinds[s] = static_cast<int>(kind) + 1;
    }
  }
  std::string out = begin_vtu(
      kGraphDefects, [](std::size_t kind) { return defect_name(static_cast<GraphDefect>(kind)); },
      graph.vertices.size(),
      [&](std::size_t i) {
        return std::array<double, 3>{graph.vertices[i][0], graph.vertices[i][1], 0};
      },
      n);
  out += "<Cells>\n";
  vtu_array(out, "type=\"Int64\" Name=\"connectivity\"", n,
            [&](std::size_t i) { return numbers(graph.segments[i]); });
  vtu_array(out, "type=\"Int64\" Name=\"offsets\"", n,
            [](std::size_t i) { return std::to_string(2 * (i + 1)); });
  vtu_array(out, "type=\"UInt8\" Name=\"types\"", n,
            [](std::size_t) { return std::string("3"); });  // VTK_LINE
  out += "</Cells>\n<CellData Scalars=\"defect\">\n";
  vtu_array(out, "type=\"UInt8\" Name=\"defect\"", n,
            [&](std::size_t i) { return std::to_string(kinds[i]); });
  return out + kEndOfVtu;
}

DefectsFormat defects_format(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  return io::equal_ignoring_case(extension, ".ply")   ? DefectsFormat::ply
         : io::equal_ignoring_case(extension, ".vtu") ? DefectsFormat::vtu
                                                      : DefectsFormat::none;
}

}  // namespace delmesher::cli
