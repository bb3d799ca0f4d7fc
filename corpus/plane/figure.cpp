// The paper's figure 2: a graph, chamfered, refined, the input of the last step, and the result.
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "corpus/plane/bench.h"
#include "mesher/io/write_plane.h"

namespace tetproof::plane_bench {
namespace {

namespace fs = std::filesystem;
using delmesher::PlaneMesh;
using delmesher::PlaneMeshStatistics;
using delmesher::PlaneResult;

struct Panel {
  std::string name, numbers;
  PlaneMesh mesh;
};

PlaneMesh lines(const PlanarGraph& graph) {
  PlaneMesh mesh;
  mesh.vertices = graph.vertices;
  mesh.edges = graph.segments;
  return mesh;
}

// Vertices as edges without length, which are drawn as dots.
PlaneMesh with_dots(PlaneMesh mesh) {
  mesh.triangles.clear();
  mesh.inside.clear();
  mesh.attributes.clear();
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::uint32_t v = 0; v < n; ++v) mesh.edges.push_back({v, v});
  return mesh;
}

std::string numbers(const PlaneMesh& mesh, const PlaneMeshStatistics* angles) {
  std::string text = std::to_string(mesh.edges.size()) + " | ";
  if (angles == nullptr) return text + "| |";
  char degrees[64];
  std::snprintf(degrees, sizeof degrees, " | %.2f | %.2f", angles->min_angle,
                angles->mean_min_angle);
  return text + std::to_string(mesh.triangles.size()) + degrees;
}

PlaneResult meshed(const PlanarGraph& graph, const delmesher::PlaneOptions& options) {
  PlaneResult result = delmesher::triangulate_polygon(graph, options);
  if (!result.status.ok()) throw std::runtime_error(result.status.message);
  return result;
}

std::string picture(const fs::path& path, PlaneMesh mesh, const PlanarGraph& frame) {
  // All pictures to one scale.
  mesh.vertices.insert(mesh.vertices.end(), frame.vertices.begin(), frame.vertices.end());
  mesh.edge_markers.resize(mesh.edges.size());
  mesh.edge_segments.resize(mesh.edges.size());
  delmesher::io::OutputSet outputs;
  auto status = delmesher::io::write_plane(outputs, path.string(), mesh);
  if (status.ok()) status = outputs.commit();
  if (!status.ok()) throw std::runtime_error(status.error);
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void save(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  if (!(file << text).flush()) throw std::runtime_error(path.string() + ": cannot write");
}

}  // namespace

void write_figure(const Input& input, const delmesher::PlaneOptions& options,
                  const std::string& folder) {
  fs::create_directories(folder);
  delmesher::PlaneOptions approximate = options;
  approximate.approximate = approximate.want_chamfered = true;
  const PlaneResult refined = meshed(input.graph, approximate);
  const PlaneResult final = meshed(input.graph, options);
  const Panel panels[] = {
      {"input", numbers(lines(input.graph), nullptr), lines(input.graph)},
      {"chamfered", numbers(lines(refined.chamfered), nullptr), lines(refined.chamfered)},
      {"refined", numbers(refined.mesh, &refined.statistics.final), refined.mesh},
      {"enriched", numbers(final.mesh, nullptr), with_dots(final.mesh)},
      {"final", numbers(final.mesh, &final.statistics.final), final.mesh}};
  std::string all = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 5000 1000\">\n";
  std::string table = "| " + input.name +
                      " | segments | triangles | smallest angle | mean smallest angle |\n"
                      "|---|---|---|---|---|\n";
  int place = 0;
  for (const Panel& panel : panels) {
    std::string own = picture(fs::path(folder) / (panel.name + ".svg"), panel.mesh, input.graph);
    const std::string inner =
        "<svg x=\"" + std::to_string(1000 * place++) + "\" width=\"1000\" height=\"1000\"";
    all += own.replace(0, 4, inner);
    table += "| " + panel.name + " | " + panel.numbers + " |\n";
  }
  save(fs::path(folder) / "figure.svg", all + "</svg>\n");
  save(fs::path(folder) / "figure.md", table);
  std::fputs(table.c_str(), stdout);
}

}  // namespace tetproof::plane_bench
