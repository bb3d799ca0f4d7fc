// Lies in the plane: records and files of other runs.
#include <algorithm>
#include <cmath>
#include <utility>

#include "property_tests/plane_lies/told.h"

namespace tetproof::plane_lies {
namespace {

using delmesher::PlanarGraph;
using delmesher::PlaneOptions;

// The first written vertex that is not of the input, but within it.
std::size_t inner(const Told& told) {
  for (std::size_t i = 0; i < told.record.mesh_vertices.size(); ++i) {
    const auto& p = told.file.vertices[i];
    if (told.record.mesh_vertices[i] < told.graph.vertices.size()) continue;
    if (std::min(p[0], p[1]) > 0 && std::max(p[0], p[1]) < 4) return i;
  }
  return 0;
}

const Lie kForeign[] = {
    {"file of another run", "same-mesh",
     [](Told& t) {
       PlaneOptions options = honest_options();
       options.max_edge = 0.5;
       t.file = run_of(options).file;
     }},
    {"the same, every written vertex point 0", "rounding",
     [](Told& t) {
       PlaneOptions options = honest_options();
       options.max_edge = 0.5;
       t.file = run_of(options).file;
       t.record.mesh_vertices.assign(t.file.vertices.size(), 0);
     }},
    {"file of another run, its vertices right", "same-mesh",
     [](Told& t) {
       PlaneOptions options = honest_options();
       options.max_edge = 0.5;
       const Told other = run_of(options);
       t.file = other.file;
       t.record.points = other.record.points;
       t.record.mesh_vertices = other.record.mesh_vertices;
     }},
    {"record of another input", "sidecar",
     [](Told& t) {
       PlanarGraph graph = honest_graph();
       graph.vertices[3] = {2.25, 1.125};
       t.record = run_of(honest_options(), graph).record;
     }},
    {"two written vertices exchanged in the record", "rounding",
     [](Told& t) { std::swap(t.record.mesh_vertices[0], t.record.mesh_vertices[5]); }},
    {"a written vertex 6 ulp off", "rounding",
     [](Told& t) { t.file.vertices[steiner(t)][0] += 6 * 0x1p-50; }},  // of the largest, 4.5
    {"the same, beside a corner of the outer box at 2^60", "rounding",
     [](Told& t) {
       PlaneOptions options = honest_options();
       options.region = delmesher::Region::hull;
       t = run_of(options);
       for (std::size_t i = 0; i < t.file.vertices.size(); ++i) {
         if (t.file.vertices[i][0] < 5 || t.file.vertices[i][1] < 5) continue;
         t.file.vertices[i] = {0x1p60, 0x1p60};
         auto& corner = t.record.points[t.record.mesh_vertices[i]];
         corner.x = corner.y = 0x1p60;
       }
       t.file.vertices[inner(t)][0] += 6 * 0x1p-50;
     },
     "not caught by it"},
    {"an input vertex an ulp off", "rounding", [](Told& t) { t.file.vertices[0][0] = 0x1p-60; }},
    {"a written vertex that is infinite", "complex",
     [](Told& t) { t.file.vertices[steiner(t)][0] = HUGE_VAL; }},
    {"an input vertex that is infinite", "complex",
     [](Told& t) { t.file.vertices[0][0] = HUGE_VAL; }},
    {"a triangle of the file twice, another missing", "same-mesh",
     [](Told& t) { t.file.triangles[1] = t.file.triangles[0]; }},
    {"the corners of two triangles of the file exchanged", "same-mesh",
     [](Told& t) { std::swap(t.file.triangles[0][0], t.file.triangles[7][1]); }},
    {"one triangle of the file two thousand times", "complex",
     [](Told& t) {
       t.file.triangles.resize(t.file.triangles.size() + 2000, t.file.triangles[0]);
       t.file.inside.resize(t.file.triangles.size(), t.file.inside[0]);
     }},
    {"one refined triangle two thousand times", "refined-complex",
     [](Told& t) { t.record.refined.resize(t.record.refined.size() + 2000, t.record.refined[0]); }},
    {"one final triangle two thousand times", "exact-complex",
     [](Told& t) { t.record.final.resize(t.record.final.size() + 2000, t.record.final[0]); }},
    {"a triangle of the file missing", "same-mesh",
     [](Told& t) {
       t.file.triangles.pop_back();
       t.file.inside.pop_back();
     }},
    {"a triangle of the file turned over", "orientation",
     [](Told& t) { std::swap(t.file.triangles[0][0], t.file.triangles[0][1]); }},
    {"a triangle of the file with a corner twice", "complex",
     [](Told& t) { t.file.triangles[0][0] = t.file.triangles[0][1]; }},
    {"a triangle of the file of no vertices", "complex",
     [](Told& t) { t.file.triangles[0][0] = 0xfffffff0U; }},
    {"a triangle of the file called outside", "same-mesh", [](Told& t) { t.file.inside[0] = 0; }},
    {"a listed edge with another marker", "same-mesh", [](Told& t) { t.file.markers[2] = 77; }},
    {"no markers of the listed edges", "same-mesh", [](Told& t) { t.file.markers.clear(); }},
    {"no segments of the listed edges", "same-mesh", [](Told& t) { t.file.segments.clear(); }},
    {"a listed edge that begins at no vertex", "complex",
     [](Told& t) { t.file.edges[1][0] = static_cast<std::uint32_t>(t.file.vertices.size()); }},
    {"a listed edge that ends at no vertex", "complex",
     [](Told& t) { t.file.edges[1][1] = static_cast<std::uint32_t>(t.file.vertices.size()); }},
    {"a listed edge fewer", "same-mesh",
     [](Told& t) {
       t.file.edges.pop_back();
       t.file.markers.pop_back();
       t.file.segments.pop_back();
     }},
    {"a listed edge twice", "edge-list",
     [](Told& t) {
       t.file.edges.push_back(t.file.edges.front());
       t.file.markers.push_back(t.file.markers.front());
       t.file.segments.push_back(t.file.segments.front());
     }},
};

}  // namespace

std::span<const Lie> foreign() {
  return kForeign;
}

}  // namespace tetproof::plane_lies
