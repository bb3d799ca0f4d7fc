// Damage to files, by kind: each is caught by the oracle meant for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "property_tests/mutations/damages.h"
#include "property_tests/score_table.h"

namespace tetproof {
namespace {

using namespace mutations;  // NOLINT
using namespace oracles;    // NOLINT
using samples::Sample;

struct FileDamage {
  const char* name;
  const char* oracle;  // the one meant to catch it
  void (*apply)(Sample&);
};

Index vertex_at(const Sample& sample, const Position& p) {
  for (Index v = 0; v < sample.mesh.vertices.size(); ++v) {
    if (sample.mesh.vertices[v] == p) return v;
  }
  ADD_FAILURE() << "no such vertex";
  return 0;
}

// On the refined unit cube, as a file.
const FileDamage kFileDamages[] = {
    {"index out of range", "complex", [](Sample& s) { s.mesh.tetrahedra[5][2] = 100000; }},
    {"repeated corner", "complex",
     [](Sample& s) { s.mesh.tetrahedra[5][2] = s.mesh.tetrahedra[5][1]; }},
    {"duplicated tetrahedron", "complex",
     [](Sample& s) {
       s.mesh.tetrahedra.push_back(s.mesh.tetrahedra[7]);
       s.mesh.regions.push_back(1);
     }},
    {"orphan vertex", "complex",
     [](Sample& s) {
       s.mesh.vertices.push_back({0.5, 0.5, 0.4});
     }},
    {"tetrahedron hung on at a vertex", "complex",
     [](Sample& s) {
       const Index v = vertex_at(s, {1, 1, 1}), n = static_cast<Index>(s.mesh.vertices.size());
       s.mesh.vertices.insert(s.mesh.vertices.end(), {{2, 1, 1}, {1, 2, 1}, {1, 1, 2}});
       s.mesh.tetrahedra.push_back({v, n, n + 1, n + 2});
       s.mesh.regions.push_back(0);
     }},
    {"input that crosses itself", "input",
     [](Sample& s) {
       const auto n = static_cast<Index>(s.input.vertices.size());
       s.input.vertices.insert(s.input.vertices.end(),
                               {{0.5, 0.5, 0.5}, {2, 0.5, 0.5}, {0.5, 2, 0.5}, {0.5, 0.5, 2}});
       s.input.triangles.insert(
           s.input.triangles.end(),
           {{n, n + 2, n + 1}, {n, n + 1, n + 3}, {n, n + 3, n + 2}, {n + 1, n + 2, n + 3}});
     }},
    {"two corners swapped", "orientation",
     [](Sample& s) { std::swap(s.mesh.tetrahedra[9][0], s.mesh.tetrahedra[9][1]); }},
    {"two corners swapped, seen by the faces", "complex",
     [](Sample& s) { std::swap(s.mesh.tetrahedra[9][0], s.mesh.tetrahedra[9][1]); }},
    {"torn along a face", "conformity",
     [](Sample& s) {  // an inner vertex doubled for one tetrahedron
       const Index v = vertex_at(s, {0.5, 0.5, 0.5});
       for (Tet& tet : s.mesh.tetrahedra) {
         const auto at = std::find(tet.begin(), tet.end(), v);
         if (at == tet.end()) continue;
         *at = static_cast<Index>(s.mesh.vertices.size());
         break;
       }
       s.mesh.vertices.push_back({0.5, 0.5, 0.5});
     }},
    {"tetrahedron dropped inside", "conformity",
     [](Sample& s) {
       const Index v = vertex_at(s, {0.5, 0.5, 0.5});
       for (std::size_t t = 0; t < s.mesh.tetrahedra.size(); ++t) {
         const Tet tet = s.mesh.tetrahedra[t];
         if (std::find(tet.begin(), tet.end(), v) == tet.end()) continue;
         s.mesh.tetrahedra.erase(s.mesh.tetrahedra.begin() + static_cast<std::ptrdiff_t>(t));
         break;
       }
       s.mesh.regions.clear();
     }},
    {"tetrahedron dropped, seen by the volume", "volume",
     [](Sample& s) {
       s.mesh.tetrahedra.erase(s.mesh.tetrahedra.begin() + 20);
       s.mesh.regions.clear();
     }},
    {"tetrahedron dropped at the boundary", "conformity",
     [](Sample& s) {
       s.mesh.tetrahedra.pop_back();
       s.mesh.regions.clear();
     }},
    {"vertex moved through its star", "orientation",
     [](Sample& s) {
       s.mesh.vertices[vertex_at(s, {0.5, 0.5, 0.5})] = {0.9, 0.9, 0.9};
     }},
    {"tetrahedron flattened", "orientation",
     [](Sample& s) {
       s.mesh.vertices[vertex_at(s, {0.5, 0.5, 0.5})] = {0.5, 0.5, 0.75};
     }},
    {"input corner lost", "conformity",
     [](Sample& s) {
       s.mesh.vertices[vertex_at(s, {1, 1, 0})] = {0.9, 0.9, 0.1};
     }},
    {"vertex pulled off its edge", "conformity",
     [](Sample& s) {
       s.mesh.vertices[vertex_at(s, {0.5, 0, 0})] = {0.5, 0.1, 0.1};
     }},
    {"boundary vertex pushed in, seen by the volume", "volume",
     [](Sample& s) {
       s.mesh.vertices[vertex_at(s, {0.5, 0, 0})] = {0.5, 0.01, 0.01};
     }},
    {"edge flipped on an input edge", "conformity",
     [](Sample& s) {  // cuts the ridge between (0,0,0) and (0.5,0,0) off
       const Index v = vertex_at(s, {0.25, 0, 0});
       std::erase_if(s.mesh.tetrahedra, [&](const Tet& tet) {
         return std::find(tet.begin(), tet.end(), v) != tet.end();
       });
       s.mesh.regions.clear();
     }},
    {"listed boundary face missing", "boundary-list",
     [](Sample& s) { s.mesh.boundary.pop_back(); }},
    {"listed boundary face twice", "boundary-list",
     [](Sample& s) { s.mesh.boundary.push_back(s.mesh.boundary[0]); }},
    {"inner face listed as boundary", "boundary-list",
     [](Sample& s) {
       const Index v = vertex_at(s, {0.5, 0.5, 0.5});
       for (const Tet& tet : s.mesh.tetrahedra) {
         if (tet[3] == v) s.mesh.boundary[0] = face_of(tet, 0);
       }
     }},
    {"wrong label", "boundary-list",
     [](Sample& s) {
       s.input.labels.assign(s.input.triangles.size(), 3);
       s.mesh.labels.assign(s.mesh.boundary.size(), 3);
       s.mesh.labels[4] = 2;
     }},
    {"input has a facet that the mesh has not", "conformity",
     [](Sample& s) {  // one triangle gets its own label: its diagonal becomes a constraint
       s.input.labels.assign(s.input.triangles.size(), 0);
       s.input.labels[0] = 1;
       const auto& t = s.input.triangles[0];
       // the mesh keeps the grid's diagonals; swap the input's to the other one
       for (std::size_t n = 1; n < s.input.triangles.size(); ++n) {
         auto& other = s.input.triangles[n];
         std::vector<Index> common, rest;
         for (const Index v : other) {
           (std::find(t.begin(), t.end(), v) != t.end() ? common : rest).push_back(v);
         }
         if (common.size() != 2) continue;
         const auto& p = s.input.vertices;
         const Index mine = t[0] + t[1] + t[2] - common[0] - common[1];
         const bool square =
             std::fabs(std::hypot(p[mine][0] - p[rest[0]][0], p[mine][1] - p[rest[0]][1],
                                  p[mine][2] - p[rest[0]][2]) -
                       std::sqrt(2)) < 1e-9;
         if (!square) continue;
         std::array<Index, 3> first = t;
         for (Index& v : first) {
           if (v == common[1]) v = rest[0];
         }
         for (Index& v : other) {
           if (v == common[0]) v = mine;
         }
         s.input.triangles[0] = first;
         return;
       }
     }},
};

void PrintTo(const FileDamage& damage, std::ostream* stream) {
  *stream << damage.name;
}

class FileDamages : public testing::TestWithParam<FileDamage> {};

TEST_P(FileDamages, AreCaughtByTheOracleMeantForThem) {
  Sample sample = samples::cube();
  ASSERT_EQ(run(sample).verdict, Verdict::exact);
  GetParam().apply(sample);
  judge("refined cube", GetParam().name, GetParam().oracle, run(sample));
}

INSTANTIATE_TEST_SUITE_P(All, FileDamages, testing::ValuesIn(kFileDamages), test_name<FileDamage>);

TEST(RegionDamage, IsCaught) {
  Sample sample = samples::cube_in_hull();
  ASSERT_EQ(run(sample).verdict, Verdict::exact);
  sample.mesh.regions[100] = 1 - sample.mesh.regions[100];
  judge("cube in its hull", "region of one tetrahedron swapped", "regions", run(sample));
}

TEST(HullDamage, IsCaught) {
  Sample sample = samples::cube_in_hull();
  ASSERT_TRUE(run(sample).find("hull")->passed());
  // The last cell is at a corner of the hull.
  sample.mesh.tetrahedra.pop_back();
  sample.mesh.regions.pop_back();
  judge("cube in its hull", "tetrahedron missing in the hull", "hull", run(sample));
}

}  // namespace
}  // namespace tetproof
