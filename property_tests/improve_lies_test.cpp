// Lies about what `delmesher improve` made of a mesh: each row spoils an honest file, or the
// promise, and names the oracle that is meant to catch it. Judged against its surface alone, as any
// mesh is, most of them would be true: nothing of another boundary, region, label or angle is wrong
// there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "mesher/delmesher_files.h"
#include "oracles/files/edge_nodes.h"
#include "oracles/improvement/improved.h"
#include "oracles/mesh/angles.h"
#include "property_tests/samples.h"

namespace tetproof::improve_lies_test {
namespace {

using namespace oracles;  // NOLINT
using delmesher::TetMesh;

// A mesh that was given, what was made of it, and what is said to have been asked for.
struct Told {
  MeshFile given, mesh;
  VerifyOptions options{.promised = {.task = Task::improve, .planar = 0}};
};

MeshFile to_file(const TetMesh& mesh) {
  MeshFile file = samples::to_mesh(mesh);
  file.regions.assign(mesh.regions.begin(), mesh.regions.end());
  return file;
}

Face sorted(Face face) {
  std::sort(face.begin(), face.end());
  return face;
}

// The tetrahedra at each face.
std::map<Face, std::vector<std::size_t>> tetrahedra_at(const MeshFile& mesh) {
  std::map<Face, std::vector<std::size_t>> at;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    for (int i = 0; i < 4; ++i) at[sorted(face_of(mesh.tetrahedra[t], i))].push_back(t);
  }
  return at;
}

std::vector<Face> inner_faces(const MeshFile& mesh, bool between_regions) {
  std::vector<Face> list;
  for (const auto& [face, tets] : tetrahedra_at(mesh)) {
    if (tets.size() != 2) continue;
    if ((mesh.regions[tets[0]] != mesh.regions[tets[1]]) == between_regions) list.push_back(face);
  }
  return list;
}

// Vertices of neither the hull nor a face between regions nor a listed triangle.
std::vector<Index> free_vertices(const MeshFile& mesh) {
  std::vector<std::uint8_t> kept(mesh.vertices.size());
  for (const auto& [face, tets] : tetrahedra_at(mesh)) {
    if (tets.size() == 2 && mesh.regions[tets[0]] == mesh.regions[tets[1]]) continue;
    for (const Index v : face) kept[v] = 1;
  }
  for (const Face& face : mesh.boundary) {
    for (const Index v : face) kept[v] = 1;
  }
  std::vector<Index> list;
  for (Index v = 0; v < kept.size(); ++v) {
    if (kept[v] == 0) list.push_back(v);
  }
  return list;
}

// A cube whose sides have labels, in two regions with a rough wall between them, part of which is
// listed, as is a face inside one of them. Improved before it is given, so that its angles are
// good.
TetMesh two_regions(double max_edge) {
  delmesher::Surface surface = samples::to_surface(samples::cube().input);
  surface.labels.clear();
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    surface.labels.push_back(static_cast<std::int32_t>(t / 2 + 1));
  }
  delmesher::Options options;
  options.max_edge = max_edge;
  options.improve = false;
  delmesher::Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  TetMesh mesh = std::move(result.mesh);
  for (const auto& t : mesh.tetrahedra) {
    double x = 0;
    for (const std::uint32_t v : t) x += mesh.vertices[v][0] / 4;
    mesh.regions.push_back(x < 0.5 ? -3 : 1000);
  }
  mesh.inside.assign(mesh.tetrahedra.size(), 1);
  const MeshFile file = to_file(mesh);
  std::vector<Face> listed = inner_faces(file, true);
  listed.resize(listed.size() / 2);
  listed.push_back(inner_faces(file, false).front());
  for (const Face& face : listed) {
    mesh.boundary.push_back(face);
    mesh.boundary_labels.push_back(99);
    mesh.boundary_facets.push_back(0);
  }
  delmesher::Result improved = delmesher::improve_mesh(mesh);
  EXPECT_TRUE(improved.status.ok()) << improved.status.message;
  return std::move(improved.mesh);
}

const TetMesh& given() {
  static const TetMesh mesh = two_regions(0.3);
  return mesh;
}

Told told() {
  static const TetMesh improved = delmesher::improve_mesh(given()).mesh;
  return {to_file(given()), to_file(improved)};
}

VerifyReport verdict_on(const Told& t) {
  VerifyReport report;
  EXPECT_EQ(verify_improved(t.given, t.mesh, t.options, report), "");
  return report;
}

// By an ulp, away from zero.
void nudge(double& x) {
  x = std::nextafter(x, x < 0.25 ? 1 : 0);
}

void drop(MeshFile& mesh, std::size_t t) {
  mesh.tetrahedra.erase(mesh.tetrahedra.begin() + static_cast<std::ptrdiff_t>(t));
  mesh.regions.erase(mesh.regions.begin() + static_cast<std::ptrdiff_t>(t));
}

// The number of a tetrahedron's faces that another one has, too.
int inner_faces_of(const MeshFile& mesh, std::size_t t) {
  const auto at = tetrahedra_at(mesh);
  int count = 0;
  for (int i = 0; i < 4; ++i) {
    count += at.at(sorted(face_of(mesh.tetrahedra[t], i))).size() == 2 ? 1 : 0;
  }
  return count;
}

std::size_t tetrahedron_with(const MeshFile& mesh, int faces) {
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (inner_faces_of(mesh, t) == faces) return t;
  }
  ADD_FAILURE() << "no tetrahedron has " << faces << " neighbours";
  return 0;
}

// Gives two triangles of a side of the cube, with the two tetrahedra behind them, the other
// diagonal.
void retriangulate(MeshFile& mesh) {
  const auto at = tetrahedra_at(mesh);
  const auto on_side = [&](const Tet& tet) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const double side : {0.0, 1.0}) {
        if (std::all_of(tet.begin(), tet.begin() + 4,
                        [&](Index v) { return mesh.vertices[v][axis] == side; })) {
          return true;
        }
      }
    }
    return false;
  };
  for (const auto& [face, tets] : at) {
    if (tets.size() != 2 || mesh.regions[tets[0]] != mesh.regions[tets[1]]) continue;
    const auto opposite = [&, f = face](std::size_t t) {
      return *std::ranges::find_if(mesh.tetrahedra[t],
                                   [&](Index v) { return std::ranges::find(f, v) == f.end(); });
    };
    const Index c = opposite(tets[0]), d = opposite(tets[1]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index e = face[i], a = face[(i + 1) % 3], b = face[(i + 2) % 3];
      if (!on_side({a, b, c, d}) || at.at(sorted({a, b, c})).size() != 1 ||
          at.at(sorted({a, b, d})).size() != 1) {
        continue;
      }
      ExactPoints points;
      points.assign(mesh.vertices);
      Tet first = {a, d, c, e}, second = {d, b, c, e};
      const int sign = exact::orient3d(points, first[0], first[1], first[2], first[3]);
      if (sign == 0 ||
          sign != exact::orient3d(points, second[0], second[1], second[2], second[3])) {
        continue;  // not convex
      }
      if (sign < 0) {
        std::swap(first[2], first[3]);
        std::swap(second[2], second[3]);
      }
      mesh.tetrahedra[tets[0]] = first;
      mesh.tetrahedra[tets[1]] = second;
      for (Face& listed : mesh.boundary) {
        if (sorted(listed) == sorted({a, b, c})) {
          listed = {a, d, c};
        } else if (sorted(listed) == sorted({a, b, d})) {
          listed = {d, b, c};
        }
      }
      return;
    }
  }
  ADD_FAILURE() << "no diagonal of a side has two tetrahedra behind it";
}

// Moves a vertex that may be moved towards the face opposite to it in one of its tetrahedra, until
// that is nearly flat but all are positive.
void flatten(MeshFile& mesh, double share) {
  const Index v = free_vertices(mesh).at(0);
  const Tet tet = *std::ranges::find_if(
      mesh.tetrahedra, [&](const Tet& t) { return std::ranges::find(t, v) != t.end(); });
  Position middle = {};
  for (const Index w : tet) {
    if (w == v) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] += mesh.vertices[w][axis] / 3;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mesh.vertices[v][axis] += share * (middle[axis] - mesh.vertices[v][axis]);
  }
}

// Splits a tetrahedron at a point with these barycentric coordinates.
void split(MeshFile& mesh, std::size_t n, const std::array<double, 4>& weights) {
  const Tet tet = mesh.tetrahedra[n];
  Position x{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      x[axis] += weights[i] * mesh.vertices[tet[i]][axis];
    }
  }
  const auto fresh = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.push_back(x);
  for (std::size_t i = 0; i < 4; ++i) {
    Tet part = tet;
    part[i] = fresh;
    if (i == 0) {
      mesh.tetrahedra[n] = part;
    } else {
      mesh.tetrahedra.push_back(part);
      mesh.regions.push_back(mesh.regions[n]);
    }
  }
}

constexpr std::array<double, 4> kMiddle = {0.25, 0.25, 0.25, 0.25},
                                kNearFace = {0.334, 0.333, 0.332, 0.001};

// One of the tetrahedra is bad; what was made of the mesh has so many bad ones.
void make_worse(Told& t, std::size_t count) {
  t.mesh = t.given;
  for (std::size_t n = 0; n < count; ++n) {
    split(t.given, n, n == 0 ? kNearFace : kMiddle);
    split(t.mesh, n, kNearFace);
  }
}

struct Lie {
  const char* name;
  const char* oracle;
  std::function<void(Told&)> tell;
};

std::vector<Lie> number_lies() {
  return {
      {"one bad tetrahedron becomes two", "improvement", [](Told& t) { make_worse(t, 2); }},
      {"one bad tetrahedron becomes many", "improvement", [](Told& t) { make_worse(t, 40); }},
      {"there are several times as many tetrahedra", "improvement",
       [](Told& t) {
         t.mesh = t.given;
         const std::size_t count = t.mesh.tetrahedra.size();
         for (std::size_t n = 0; n < count; ++n) split(t.mesh, n, kMiddle);
       }},
  };
}

std::vector<Lie> boundary_lies() {
  return {
      {"a vertex of the hull is an ulp off", "kept-faces",
       [](Told& t) {
         auto& p = *std::ranges::find_if(t.mesh.vertices, [](const Position& q) {
           return q[2] == 1 && q[0] > 0.1 && q[0] < 0.9;
         });
         nudge(p[0]);
       }},
      {"a vertex between the regions is an ulp off", "kept-faces",
       [](Told& t) { nudge(t.mesh.vertices[inner_faces(t.mesh, true).front()[0]][1]); }},
      {"a vertex of a listed face inside a region is an ulp off", "kept-faces",
       [](Told& t) { nudge(t.mesh.vertices[t.mesh.boundary.back()[0]][1]); }},
      {"everything is an ulp farther", "kept-faces",
       [](Told& t) {
         for (Position& p : t.mesh.vertices) p[0] = std::nextafter(p[0], 2);
       }},
      {"a tetrahedron of the hull is missing", "kept-faces",
       [](Told& t) { drop(t.mesh, tetrahedron_with(t.mesh, 3)); }},
      {"a tetrahedron inside is missing", "complex",
       [](Told& t) { drop(t.mesh, tetrahedron_with(t.mesh, 4)); }},
      {"a region is missing", "kept-faces",
       [](Told& t) {
         for (std::size_t n = t.mesh.tetrahedra.size(); n-- > 0;) {
           if (t.mesh.regions[n] == -3) drop(t.mesh, n);
         }
         std::vector<Index> number(t.mesh.vertices.size(), kNone);
         std::vector<Position> used;
         for (Tet& tet : t.mesh.tetrahedra) {
           for (Index& v : tet) {
             if (number[v] == kNone) {
               number[v] = static_cast<Index>(used.size());
               used.push_back(t.mesh.vertices[v]);
             }
             v = number[v];
           }
         }
         t.mesh.vertices = used;
         t.mesh.boundary.clear();
         t.mesh.labels.clear();
         t.mesh.facets.clear();
       }},
      {"a side of the cube has another triangulation", "kept-faces",
       [](Told& t) { retriangulate(t.mesh); }},
      {"it is another mesh of the same cube", "kept-faces",
       [](Told& t) { t.mesh = to_file(two_regions(0.4)); }},
      {"a tetrahedron is in the other region", "kept-faces",
       [](Told& t) { t.mesh.regions[0] = t.mesh.regions[0] == -3 ? 1000 : -3; }},
      {"the regions are exchanged", "kept-faces",
       [](Told& t) {
         for (auto& region : t.mesh.regions) region = region == -3 ? 1000 : -3;
       }},
      {"the regions have other numbers", "kept-faces",
       [](Told& t) {
         for (auto& region : t.mesh.regions) ++region;
       }},
      {"the regions are one", "kept-faces",
       [](Told& t) { std::ranges::fill(t.mesh.regions, 1000); }},
      {"the regions are missing", "kept-faces", [](Told& t) { t.mesh.regions.clear(); }},
      {"there are regions and none were given", "kept-faces",
       [](Told& t) { t.given.regions.clear(); }},
      {"one region is called outside", "kept-faces",
       [](Told& t) {
         t.given.inside.assign(t.given.tetrahedra.size(), 1);
         for (const std::int64_t region : t.mesh.regions) t.mesh.inside.push_back(region == -3);
       }},
      {"the labels of two triangles are exchanged", "boundary-list",
       [](Told& t) {
         std::swap(t.mesh.labels.front(), *std::ranges::find_if(t.mesh.labels, [&](auto l) {
                     return l != t.mesh.labels[0];
                   }));
       }},
      {"a label is lost", "boundary-list", [](Told& t) { t.mesh.labels.back() = 0; }},
      {"all labels are lost", "boundary-list", [](Told& t) { t.mesh.labels.clear(); }},
      {"the facet of a triangle is another one", "boundary-list",
       [](Told& t) { ++t.mesh.facets.front(); }},
      {"a group of triangles is not listed", "boundary-list",
       [](Told& t) {
         for (std::size_t n = t.mesh.boundary.size(); n-- > 0;) {
           if (t.mesh.labels[n] != 99) continue;
           const auto at = static_cast<std::ptrdiff_t>(n);
           t.mesh.boundary.erase(t.mesh.boundary.begin() + at);
           t.mesh.labels.erase(t.mesh.labels.begin() + at);
           t.mesh.facets.erase(t.mesh.facets.begin() + at);
         }
       }},
      {"no triangle is listed", "boundary-list",
       [](Told& t) {
         t.mesh.boundary.clear();
         t.mesh.labels.clear();
         t.mesh.facets.clear();
       }},
      {"a listed triangle is turned", "boundary-list",
       [](Told& t) { std::swap(t.mesh.boundary[0][0], t.mesh.boundary[0][1]); }},
      {"a triangle is listed twice", "boundary-list",
       [](Told& t) {
         t.mesh.boundary.push_back(t.mesh.boundary[0]);
         t.mesh.labels.push_back(t.mesh.labels[0]);
         t.mesh.facets.push_back(t.mesh.facets[0]);
       }},
      {"a triangle is listed that was not", "boundary-list",
       [](Told& t) {
         t.mesh.boundary.push_back(inner_faces(t.mesh, false).back());
         t.mesh.labels.push_back(99);
         t.mesh.facets.push_back(0);
       }},
      {"a listed triangle has a corner out of range", "boundary-list",
       [](Told& t) { t.mesh.boundary[0][1] = static_cast<Index>(t.mesh.vertices.size()); }},
      {"names of labels say something else", "boundary-list",
       [](Told& t) { t.mesh.labels_contradict = true; }},
      {"a set has the name of another one", "boundary-list",
       [](Told& t) {
         t.given.has_names = t.mesh.has_names = true;
         t.given.names[{2, t.given.labels[0]}] = "inlet";
         t.mesh.names[{2, t.given.labels[0]}] = "outlet";
       }},
      {"a region has lost its name", "boundary-list",
       [](Told& t) {
         t.given.has_names = t.mesh.has_names = true;
         t.given.names[{3, t.given.regions[0]}] = "steel";
       }},
      {"elements are in no group", "boundary-list",
       [](Told& t) { t.given.has_names = t.mesh.groups_differ = true; }},
  };
}

std::vector<Lie> inner_lies() {
  return {
      {"a tetrahedron is there twice", "complex",
       [](Told& t) {
         t.mesh.tetrahedra.push_back(t.mesh.tetrahedra[0]);
         t.mesh.regions.push_back(t.mesh.regions[0]);
       }},
      {"a vertex is used by nothing", "complex",
       [](Told& t) {
         t.mesh.vertices.push_back({0.5, 0.5, 0.5});
       }},
      {"a coordinate is not a number", "complex",
       [](Told& t) { t.mesh.vertices[0][0] = std::numeric_limits<double>::quiet_NaN(); }},
      {"a corner is out of range", "complex",
       [](Told& t) { t.mesh.tetrahedra[0][0] = static_cast<Index>(t.mesh.vertices.size()); }},
      {"there are no tetrahedra", "complex",
       [](Told& t) {
         t.mesh = {};
         t.mesh.lists_boundary = true;
       }},
      {"all tetrahedra are turned", "orientation",
       [](Told& t) {
         for (Tet& tet : t.mesh.tetrahedra) std::swap(tet[0], tet[1]);
       }},
      {"a vertex inside was moved through a face", "orientation",
       [](Told& t) { flatten(t.mesh, 1.5); }},
      {"a tetrahedron is flat", "orientation",
       [](Told& t) {
         // Its fourth corner is where the first one is.
         const Index v = free_vertices(t.mesh).at(0);
         Tet& tet = *std::ranges::find_if(
             t.mesh.tetrahedra, [&](const Tet& x) { return std::ranges::find(x, v) != x.end(); });
         const Index w = tet[0] == v ? tet[1] : tet[0];
         t.mesh.vertices[v] = t.mesh.vertices[w];
       }},
      {"a vertex inside was moved until angles are small", "improvement",
       [](Told& t) { flatten(t.mesh, 0.95); }},
      {"edges are longer than promised", "improvement",
       [](Told& t) { t.options.promised.max_edge = 0.1; }},
      {"a vertex more than promised", "promise",
       [](Told& t) {
         t.options.promised.max_vertices = static_cast<double>(t.mesh.vertices.size()) - 1;
       }},
      {"elements of second order were promised", "edge-nodes",
       [](Told& t) { t.options.promised.second_order = true; }},
      {"the node of an edge is off its middle", "edge-nodes",
       [](Told& t) {
         const auto& [a, b, c, d] = t.mesh.tetrahedra[0];
         Position middle;
         for (std::size_t axis = 0; axis < 3; ++axis) {
           middle[axis] = (t.mesh.vertices[a][axis] + t.mesh.vertices[b][axis]) / 2;
         }
         middle[0] += 1e-9;
         t.mesh.edge_nodes.push_back({{a, b}, middle});
       }},
  };
}

TEST(ImproveLies, AnHonestMeshPasses) {
  const Told t = told();
  ASSERT_GT(inner_faces(t.mesh, true).size(), 10U);
  ASSERT_FALSE(free_vertices(t.mesh).empty());
  const VerifyReport report = verdict_on(t);
  EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
  for (const char* oracle :
       {"complex", "orientation", "kept-faces", "boundary-list", "improvement"}) {
    ASSERT_NE(report.find(oracle), nullptr) << oracle;
    EXPECT_TRUE(report.find(oracle)->passed()) << to_text(report);
  }
}

TEST(ImproveLies, AsManyVerticesAsPromisedPass) {
  Told t = told();
  t.options.promised.max_vertices = static_cast<double>(t.mesh.vertices.size());
  const VerifyReport report = verdict_on(t);
  EXPECT_NE(report.find("promise"), nullptr);
  EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
}

TEST(ImproveLies, AFormatWithoutTrianglesIsSaidFirst) {
  Told t = told();
  t.mesh.lists_boundary = t.mesh.has_second_order = false;
  t.mesh.boundary.clear();
  t.mesh.labels.clear();
  t.options.promised.second_order = t.options.promised.names = true;
  const VerifyReport report = verdict_on(t);
  EXPECT_EQ(report.verdict, Verdict::exact) << to_text(report);
  EXPECT_EQ(report.unproven,
            (std::vector<std::string>{"triangles and labels of the mesh given (the file has none)",
                                      "--names", kLinearOnly}));
}

TEST(ImproveLies, AreCaught) {
  std::size_t caught = 0;
  std::vector<Lie> lies = boundary_lies();
  std::ranges::move(number_lies(), std::back_inserter(lies));
  for (Lie& lie : inner_lies()) lies.push_back(std::move(lie));
  for (const Lie& lie : lies) {
    Told t = told();
    lie.tell(t);
    const VerifyReport report = verdict_on(t);
    const OracleReport* oracle = report.find(lie.oracle);
    const bool by_it = oracle != nullptr && !oracle->passed();
    EXPECT_TRUE(by_it) << lie.name << "\n" << to_text(report);
    EXPECT_EQ(report.verdict, Verdict::broken) << lie.name;
    caught += by_it ? 1 : 0;
  }
  EXPECT_EQ(caught, lies.size());
  std::printf("%zu of %zu lies about improved meshes caught\n", caught, lies.size());
}

// Vertices that nothing uses are dropped, and what is all turned is taken the other way round.
TEST(ImproveLies, AGivenMeshMayHaveUnusedVerticesAndBeTurned) {
  Told t = told();
  t.given.vertices.push_back({7, 7, 7});
  for (Tet& tet : t.given.tetrahedra) std::swap(tet[0], tet[1]);
  EXPECT_EQ(verdict_on(t).verdict, Verdict::exact) << to_text(verdict_on(t));
}

// As in .tet, which names regions only where there are several.
TEST(ImproveLies, OneRegionNeedsNoName) {
  Told t = told();
  const TetMesh improved = [] {
    TetMesh one = given();
    one.regions.assign(one.tetrahedra.size(), 7);
    return delmesher::improve_mesh(one).mesh;
  }();
  t.mesh = to_file(improved);
  t.given.regions.assign(t.given.tetrahedra.size(), 7);
  EXPECT_EQ(verdict_on(t).verdict, Verdict::exact) << to_text(verdict_on(t));
  t.mesh.regions.clear();
  EXPECT_EQ(verdict_on(t).verdict, Verdict::exact) << to_text(verdict_on(t));
}

// Sides are words in one format, 1 and 0 in others, 1 and 2 in the rest; numbers of regions that
// are not tags are names of groups in .msh. Files of each format are improved into each.
class Formats {
 public:
  using Spoil = std::function<void(TetMesh&)>;
  struct Named {
    const char* name;
    Spoil spoil;
  };

  Formats(const char* name, std::vector<std::string> extensions, std::vector<Named> lies)
      : folder_(std::filesystem::path(TETPROOF_SCRATCH) / "improve_lies" / name),
        extensions_(std::move(extensions)),
        lies_(std::move(lies)) {
    std::filesystem::create_directories(folder_);
  }

  // A facet has one label, or readers number the facets again.
  void judge(TetMesh mesh) const {
    mesh.boundary_facets.assign(mesh.boundary_labels.begin(), mesh.boundary_labels.end());
    for (const std::string& extension : extensions_) {
      SCOPED_TRACE("given as " + extension);
      const MeshFile given = written(mesh, "given." + extension);
      const delmesher::io::MeshReadResult taken =
          delmesher::io::read_mesh((folder_ / ("given." + extension)).string());
      ASSERT_TRUE(taken.ok()) << taken.error;
      const delmesher::Result improved = delmesher::improve_mesh(taken.mesh);
      ASSERT_TRUE(improved.status.ok()) << improved.status.message;
      for (const std::string& to : extensions_) {
        // It has words for sides and none for regions, as which .mesh and .node have the sides.
        if (to == "tet" && !improved.mesh.regions.empty()) continue;
        SCOPED_TRACE("improved as " + to);
        const VerifyReport honest = verdict_on({given, written(improved.mesh, "mesh." + to)});
        EXPECT_NE(honest.verdict, Verdict::broken) << to_text(honest);
        ASSERT_NE(honest.find("kept-faces"), nullptr);
        EXPECT_GT(honest.find("kept-faces")->checked, 0U);
        for (const Named& lie : lies_) {
          TetMesh spoilt = improved.mesh;
          lie.spoil(spoilt);
          const VerifyReport report = verdict_on({given, written(spoilt, "lie." + to)});
          ASSERT_NE(report.find("kept-faces"), nullptr);
          EXPECT_FALSE(report.find("kept-faces")->passed()) << lie.name;
        }
      }
    }
  }

 private:
  MeshFile written(const TetMesh& mesh, const std::string& name) const {
    const std::string path = (folder_ / name).string();
    const delmesher::io::WriteStatus status = delmesher::io::write_mesh(path, mesh);
    EXPECT_TRUE(status.ok()) << status.error;
    return read_mesh(path);
  }

  std::filesystem::path folder_;
  std::vector<std::string> extensions_;
  std::vector<Named> lies_;
};

// What was read from a format without words for sides has them as regions 1 and 2.
void exchange_side(TetMesh& mesh, std::size_t t) {
  if (mesh.regions.empty()) {
    mesh.inside[t] = mesh.inside[t] == 0 ? 1 : 0;
  } else {
    mesh.regions[t] = 3 - mesh.regions[t];
  }
}

TEST(ImproveLies, SidesAreTheSameInEveryFormat) {
  TetMesh mesh = given();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    mesh.inside[t] = mesh.regions[t] == -3 ? 0 : 1;
  }
  mesh.regions.clear();
  Formats("sides", {"mesh", "msh", "vtu", "node", "tet"},
          {{"the sides are exchanged",
            [](TetMesh& m) {
              for (std::size_t t = 0; t < m.tetrahedra.size(); ++t) exchange_side(m, t);
            }},
           {"the sides are one",
            [](TetMesh& m) {
              m.regions.clear();
              m.inside.assign(m.tetrahedra.size(), 1);
            }},
           {"a tetrahedron is on the other side", [](TetMesh& m) { exchange_side(m, 0); }}})
      .judge(mesh);
}

TEST(ImproveLies, RegionsAreTheSameInEveryFormat) {
  Formats("regions", {"mesh", "msh", "vtu", "node"},
          {{"the regions are exchanged",
            [](TetMesh& mesh) {
              for (auto& region : mesh.regions) region = region == -3 ? 1000 : -3;
            }},
           {"the regions are one", [](TetMesh& mesh) { std::ranges::fill(mesh.regions, 1000); }},
           {"a tetrahedron is in the other region",
            [](TetMesh& mesh) { mesh.regions[0] = mesh.regions[0] == -3 ? 1000 : -3; }}})
      .judge(given());
}

TEST(ImproveLies, AGivenMeshThatCannotBeImprovedIsRefused) {
  VerifyReport report;
  Told t = told();
  std::swap(t.given.tetrahedra[0][0], t.given.tetrahedra[0][1]);
  EXPECT_NE(verify_improved(t.given, t.mesh, t.options, report), "");
  EXPECT_TRUE(report.oracles.empty());
  t = told();
  t.given.tetrahedra.push_back(t.given.tetrahedra[0]);
  t.given.regions.push_back(t.given.regions[0]);
  EXPECT_NE(verify_improved(t.given, t.mesh, t.options, report), "");
  EXPECT_NE(verify_improved({}, t.mesh, t.options, report), "");
}

// Powers of two change nothing, however large.
TEST(ImproveLies, ScalesDoNotMatter) {
  for (const int exponent : {-300, 300}) {
    Told t = told();
    for (MeshFile* file : {&t.given, &t.mesh}) {
      for (Position& p : file->vertices) {
        for (double& x : p) x = std::ldexp(x, exponent);
      }
    }
    EXPECT_EQ(verdict_on(t).verdict, Verdict::exact) << to_text(verdict_on(t));
    flatten(t.mesh, 0.95);
    EXPECT_EQ(verdict_on(t).verdict, Verdict::broken);
  }
}

}  // namespace
}  // namespace tetproof::improve_lies_test
