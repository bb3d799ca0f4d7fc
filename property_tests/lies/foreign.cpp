// Lies: records and files of other runs.
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "property_tests/lies/told.h"

namespace tetproof::lies {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Options;

double volume_of(const MeshFile& mesh, const Tet& t) {
  std::array<std::array<double, 3>, 3> e;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      e[i][k] = mesh.vertices[t[i + 1]][k] - mesh.vertices[t[0]][k];
    }
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
         e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

// The first two tetrahedra whose union has an edge through their common face are made three around
// that edge, which fill the same place.
void make_three_of_two(MeshFile& mesh) {
  std::map<Face, std::pair<std::size_t, int>> seen;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      const Face face = face_of(mesh.tetrahedra[t], i);
      Face sorted = face;
      std::ranges::sort(sorted);
      const auto [other, first] = seen.try_emplace(sorted, t, i);
      if (first) continue;
      const auto [u, j] = other->second;
      const double whole =
          volume_of(mesh, mesh.tetrahedra[t]) + volume_of(mesh, mesh.tetrahedra[u]);
      const Index apex = mesh.tetrahedra[t][static_cast<std::size_t>(i)],
                  below = mesh.tetrahedra[u][static_cast<std::size_t>(j)];
      std::array<Tet, 3> three;
      // All three turn the same way, as the corners of the face do.
      const bool turned = volume_of(mesh, {face[0], face[1], apex, below}) < 0;
      bool positive = true;
      for (std::size_t k = 0; k < 3; ++k) {
        three[k] = {face[k], face[(k + 1) % 3], apex, below};
        if (turned) std::swap(three[k][0], three[k][1]);
        positive = positive && volume_of(mesh, three[k]) > 1e-3 * whole;
      }
      if (!positive || mesh.regions[t] != mesh.regions[u]) continue;
      mesh.tetrahedra[t] = three[0];
      mesh.tetrahedra[u] = three[1];
      mesh.tetrahedra.push_back(three[2]);
      mesh.regions.push_back(mesh.regions[t]);
      return;
    }
  }
}

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
       // The ulp is that of the largest coordinate, 3. Only vertices that are not of the input may
       // be written elsewhere, up to 4 ulp away.
       for (std::size_t i = 0; i < t.record.mesh_vertices.size(); ++i) {
         if (t.record.mesh_vertices[i] < t.sample.input.vertices.size()) continue;
         t.sample.mesh.vertices[i][0] += 6 * 0x1p-51;
         return;
       }
     }},
    {"an input vertex an ulp off in the file", "rounding",
     [](Told& t) {
       for (std::size_t i = 0; i < t.record.mesh_vertices.size(); ++i) {
         if (t.record.mesh_vertices[i] >= t.sample.input.vertices.size()) continue;
         t.sample.mesh.vertices[i][0] += 0x1p-51;
         return;
       }
     },
     "passed"},
    {"one written vertex more in the record than in the file", "rounding",
     [](Told& t) { t.record.mesh_vertices.push_back(t.record.mesh_vertices.front()); }},
    {"a tetrahedron of the record with another corner", "same-mesh",
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
    {"a listed boundary triangle turned over", "boundary-list",
     [](Told& t) { std::swap(t.sample.mesh.boundary.back()[0], t.sample.mesh.boundary.back()[1]); },
     "not caught by it"},
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
    {"no facets of boundary triangles", "same-mesh", [](Told& t) { t.sample.mesh.facets.clear(); },
     "passed"},
    {"labels of boundary triangles of a surface without labels", "same-mesh",
     [](Told& t) { t.sample.mesh.labels.back() = 4; }, "passed"},
    {"a box of an entity that is not that of its elements", "same-mesh",
     [](Told& t) { t.sample.mesh.boxes_differ = true; }, "passed"},
    {"no sides in a file that should have them", "same-mesh",
     [](Told& t) { t.sample.mesh.regions.clear(); }, "passed"},
    {"sides of the file in words, which contradict its numbers", "same-mesh",
     [](Told& t) {
       t.sample.mesh.inside.assign(t.sample.mesh.tetrahedra.size(), 1);
       t.sample.mesh.inside.front() = 0;
     },
     "passed"},
    {"no labels of boundary triangles", "same-mesh",
     [](Told& t) {
       t.sample.input.labels.assign(t.sample.input.triangles.size(), 0);
       t.sample.mesh.labels.clear();
     },
     "passed"},
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
    {"a written vertex that is not a point of the record", "rounding",
     [](Told& t) { t.record.mesh_vertices.back() = 4294967295U; }},
    {"outside called by two numbers", "same-mesh",
     [](Told& t) {
       run_hull(t);
       *std::find(t.sample.mesh.regions.begin(), t.sample.mesh.regions.end(), 0) = 2;
     }},
    {"two tetrahedra of --approximate made three, none of which was flat", "same-mesh",
     [](Told& t) {
       run_approximate(t);
       make_three_of_two(t.sample.mesh);
     }},
    {"a mesh of --approximate with more tetrahedra than its budget", "promise",
     [](Told& t) {
       run_approximate(t);
       t.promise.budget = static_cast<double>(t.sample.mesh.tetrahedra.size()) - 1;
     }},
    {"a final mesh where --approximate was promised", "promise",
     [](Told& t) { t.promise.approximate = true; }},
    {"a mesh before repairs, none after, for --approximate", "promise",
     [](Told& t) {
       run_approximate(t);
       t.record.unrepaired = t.record.refined;
     },
     "passed"},
    {"nothing written of a refined mesh", "same-mesh",
     [](Told& t) {
       run_approximate(t);
       t.sample.mesh = MeshFile{};
       t.sample.mesh.names_sides = true;
       t.record.mesh_vertices.clear();
     }},
    {"vertices without tetrahedra, of a refined mesh", "complex",
     [](Told& t) {
       run_approximate(t, flat_wedge());
       t.sample.mesh.vertices.push_back({0, 0, 0});
       t.record.mesh_vertices.push_back(0);
     }},
    {"faces of a final mesh that is not there, for --approximate", "promise",
     [](Told& t) {
       run_approximate(t);
       t.record.final_facets = t.record.refined_facets;
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
