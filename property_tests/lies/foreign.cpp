// Lies: records and files of other runs.
#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Options;

const Lie kForeign[] = {
    {"file of another run, every written vertex point 0", "same-mesh",
     [](Told& t) {
       Options options = honest_options();
       t.sample.mesh = run_of(options, Task::cdt).sample.mesh;
       t.record.mesh_vertices.assign(t.sample.mesh.vertices.size(), 0);
     }},
    {"the same, seen by the rounding", "rounding",
     [](Told& t) {
       Options options = honest_options();
       t.sample.mesh = run_of(options, Task::cdt).sample.mesh;
       t.record.mesh_vertices.assign(t.sample.mesh.vertices.size(), 0);
     }},
    {"file of a plain tetrahedrization, its vertices right", "same-mesh",
     [](Told& t) {
       Options options = honest_options();
       const Told plain = run_of(options, Task::cdt);
       t.sample.mesh = plain.sample.mesh;
       t.record.mesh_vertices = plain.record.mesh_vertices;
     }},
    {"two written vertices exchanged in the record", "rounding",
     [](Told& t) { std::swap(t.record.mesh_vertices[0], t.record.mesh_vertices[5]); }},
    {"a written vertex 6 ulp off", "rounding",
     [](Told& t) {
       // The ulp is that of the largest coordinate, 3. Vertices that are not of the input may move
       // at all.
       for (std::size_t i = 0; i < t.record.mesh_vertices.size(); ++i) {
         if (t.record.mesh_vertices[i] < t.sample.input.vertices.size()) continue;
         t.sample.mesh.vertices[i][0] += 6 * 0x1p-51;
         return;
       }
     }},
    {"a tetrahedron of the record turned to another of the same four points", "same-mesh",
     [](Told& t) {
       for (auto& tet : t.record.final) {
         if (!tet.inside) continue;
         tet.vertices[0] = t.record.final.back().vertices[3];
         return;
       }
     }},
    {"a tetrahedron of the file called outside in the record", "same-mesh",
     [](Told& t) {
       std::find_if(t.record.final.begin(), t.record.final.end(), [](const auto& tet) {
         return tet.inside;
       })->inside = false;
     }},
    {"a listed boundary triangle with another label", "same-mesh",
     [](Told& t) {
       t.sample.input.labels.assign(t.sample.input.triangles.size(), 0);
       t.sample.mesh.labels.assign(t.sample.mesh.boundary.size(), 0);
       t.sample.mesh.labels.back() = 4;
     }},
    {"no boundary triangles in the file", "same-mesh",
     [](Told& t) {
       t.sample.mesh.boundary.clear();
       t.sample.mesh.labels.clear();
       t.sample.mesh.facets.clear();
     }},
    {"a boundary triangle in the file turned inwards", "same-mesh",
     [](Told& t) {
       auto& face = t.sample.mesh.boundary.front();
       std::swap(face[0], face[1]);
     }},
    {"facets of boundary triangles in the file exchanged", "same-mesh",
     [](Told& t) { std::swap(t.sample.mesh.facets.front(), t.sample.mesh.facets.back()); }},
    {"facets of boundary triangles cut short", "same-mesh",
     [](Told& t) { t.sample.mesh.facets.pop_back(); }},
    {"a face of the hull listed as boundary", "same-mesh",
     [](Told& t) {
       run_hull(t);
       std::set<std::set<Index>> seen;
       for (const Tet& tet : t.sample.mesh.tetrahedra) {
         for (int i = 0; i < 4; ++i) {
           const Face face = face_of(tet, i);
           const std::set<Index> corners(face.begin(), face.end());
           if (!seen.insert(corners).second) seen.erase(corners);
         }
       }
       for (const Face& face : t.sample.mesh.boundary) seen.erase({face.begin(), face.end()});
       const std::vector<Index> face(seen.begin()->begin(), seen.begin()->end());
       t.sample.mesh.boundary.push_back({face[0], face[1], face[2]});
       t.sample.mesh.labels.push_back(0);
       t.sample.mesh.facets.push_back(0);
     }},
    {"all tetrahedra of the file turned over, in a format without convention", "orientation",
     [](Told& t) {
       t.sample.mesh.either_orientation = true;
       for (Tet& tet : t.sample.mesh.tetrahedra) std::swap(tet[0], tet[1]);
     }},
    {"inside and outside exchanged in the file", "same-mesh",
     [](Told& t) {
       run_hull(t);
       for (auto& region : t.sample.mesh.regions) region = 1 - region;
     }},
    {"half of the inside renamed in the file", "same-mesh",
     [](Told& t) {
       auto& regions = t.sample.mesh.regions;
       std::fill_n(regions.begin(), regions.size() / 2, 7);
     }},
    {"sides left out of a file of the hull", "same-mesh",
     [](Told& t) {
       run_hull(t);
       t.sample.mesh.regions.clear();
     }},
    {"sides of a file cut short", "same-mesh",
     [](Told& t) {
       run_hull(t);
       t.sample.mesh.regions.resize(t.sample.mesh.regions.size() / 2);
     }},
    {"a face on a facet fewer in the record", "same-mesh",
     [](Told& t) { t.record.final_facets.pop_back(); }},
    {"a written vertex that is no point of the record", "rounding",
     [](Told& t) { t.record.mesh_vertices.back() = 4294967295U; }},
    {"outside called by two numbers", "same-mesh",
     [](Told& t) {
       run_hull(t);
       *std::find(t.sample.mesh.regions.begin(), t.sample.mesh.regions.end(), 0) = 2;
     }},
    {"a final mesh where --approximate was promised", "promise",
     [](Told& t) { t.promise.approximate = true; }},
    {"a mesh before repairs, none after, for --approximate", "promise",
     [](Told& t) {
       Options options = honest_options();
       options.approximate = true;
       t = run_of(options);
       t.record.unrepaired = t.record.refined;
     },
     "passed"},
    {"a plain tetrahedrization where a mesh was promised", "promise",
     [](Told& t) {
       run_cdt(t);
       t.promise.task = Task::mesh;
     }},
};

}  // namespace

std::span<const Lie> foreign() {
  return kForeign;
}

}  // namespace tetproof::lies
