// Laws of improve_mesh(), which improves meshes of any origin: ours without improvement, TetGen's
// and Gmsh's. Nothing of the mesher's code judges them: volumes are rationals, angles doubles; ours
// are verified by the oracles, too.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "mesher/delmesher.h"
#include "oracles/files/mesh_file.h"
#include "oracles/improvement/local_operations.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::improve_mesh_test {
namespace {

using delmesher::ImproveOptions;
using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::TetMesh;
using samples::NamedSurface;
using Point = std::array<double, 3>;

constexpr std::uint64_t kSeed = 5;
constexpr double kDihedral = oracles::kImprovedDihedral,
                 kDelta = 14.47;    // tetrahedra as good as this may become worse
constexpr double kRounding = 1e-6;  // of angles

// Six times the volume.
mpq_class volume(const TetMesh& mesh, const std::array<std::uint32_t, 4>& t) {
  mpq_class e[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      e[i][k] = mpq_class(mesh.vertices[t[i + 1]][k]) - mpq_class(mesh.vertices[t[0]][k]);
    }
  }
  return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
         e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
         e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
}

struct Angles {
  double dihedral = 180, face = 180;  // the smallest; large dihedral angles count as 180 less them
};

Angles angles(const TetMesh& mesh) {
  Angles result;
  const auto between = [](const Point& u, const Point& v) {
    const Point c = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                     u[0] * v[1] - u[1] * v[0]};
    return std::atan2(std::hypot(c[0], c[1], c[2]), u[0] * v[0] + u[1] * v[1] + u[2] * v[2]) * 180 /
           3.14159265358979323846;
  };
  for (const auto& t : mesh.tetrahedra) {
    const auto edge = [&](int i, int j) {
      const Point &a = mesh.vertices[t[i]], &b = mesh.vertices[t[j]];
      return Point{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    };
    const auto normal = [&](int i, int j, int k) {
      const Point u = edge(i, j), v = edge(i, k);
      return Point{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    };
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        if (i == j) continue;
        std::vector<int> rest;
        for (int k = 0; k < 4; ++k) {
          if (k != i && k != j) rest.push_back(k);
        }
        const double d = between(normal(i, j, rest[0]), normal(i, j, rest[1]));
        result.dihedral = std::min({result.dihedral, d, 180 - d});
        for (const int k : rest)
          result.face = std::min(result.face, between(edge(i, j), edge(i, k)));
      }
    }
  }
  return result;
}

// Region of a tetrahedron, with its side.
std::pair<int, int> region(const TetMesh& mesh, std::size_t t) {
  return {mesh.inside.empty() ? 1 : mesh.inside[t], mesh.regions.empty() ? 0 : mesh.regions[t]};
}

using Triangle = std::array<Point, 3>;
Triangle triangle(const TetMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  Triangle corners = {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  std::sort(corners.begin(), corners.end());
  return corners;
}

// All faces that must be kept, by the coordinates of their vertices.
std::set<Triangle> kept_faces(const TetMesh& mesh) {
  std::map<Triangle, std::set<std::pair<int, int>>> sides;
  std::map<Triangle, int> count;
  std::set<Triangle> kept;
  for (std::size_t n = 0; n < mesh.tetrahedra.size(); ++n) {
    const auto& t = mesh.tetrahedra[n];
    for (int i = 0; i < 4; ++i) {
      const Triangle face = triangle(mesh, t[(i + 1) % 4], t[(i + 2) % 4], t[(i + 3) % 4]);
      sides[face].insert(region(mesh, n));
      ++count[face];
    }
  }
  for (const auto& [face, regions] : sides) {
    if (count[face] == 1 || regions.size() > 1) kept.insert(face);
  }
  for (const auto& [a, b, c] : mesh.boundary) kept.insert(triangle(mesh, a, b, c));
  return kept;
}

struct Law {
  Result result;
  TetMesh before;

  explicit Law(TetMesh mesh, const ImproveOptions& options = {})
      : result(delmesher::improve_mesh(mesh, options)), before(std::move(mesh)) {
    EXPECT_TRUE(result.status.ok()) << result.status.message;
    if (!result.status.ok()) return;
    keeps_the_boundary();
    is_positive_and_fills_the_same();
    is_not_worse();
  }

  void keeps_the_boundary() const {
    const TetMesh& after = result.mesh;
    ASSERT_EQ(after.boundary.size(), before.boundary.size());
    for (std::size_t n = 0; n < before.boundary.size(); ++n) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(after.vertices[after.boundary[n][k]], before.vertices[before.boundary[n][k]]);
      }
    }
    EXPECT_EQ(after.boundary_labels, before.boundary_labels);
    EXPECT_EQ(after.boundary_facets, before.boundary_facets);
    EXPECT_EQ(kept_faces(after), kept_faces(before));
    EXPECT_EQ(after.inside.size(), after.tetrahedra.size());
    EXPECT_EQ(after.regions.empty(), before.regions.empty());
  }

  void is_positive_and_fills_the_same() const {
    std::map<std::pair<int, int>, mpq_class> volumes[2];
    std::uint64_t flat = 0;
    for (const TetMesh* mesh : {&before, &result.mesh}) {
      for (std::size_t n = 0; n < mesh->tetrahedra.size(); ++n) {
        const mpq_class v = volume(*mesh, mesh->tetrahedra[n]);
        volumes[mesh == &before ? 0 : 1][region(*mesh, n)] += abs(v);
        if (mesh == &before) continue;
        EXPECT_GE(v, 0);
        flat += v == 0 ? 1 : 0;
      }
    }
    EXPECT_EQ(volumes[0], volumes[1]);
    EXPECT_EQ(flat, result.statistics.rounding_flat);
    EXPECT_EQ(result.statistics.rounding_inverted, 0U);
  }

  void is_not_worse() const {
    const Angles old = angles(before), now = angles(result.mesh);
    EXPECT_GE(now.dihedral, std::min(old.dihedral, kDihedral) - kRounding);
    EXPECT_GE(now.face, std::min(old.face, kDelta) - kRounding);
    const auto &s = result.statistics.refined, &t = result.statistics.final;
    EXPECT_EQ(s.tetrahedra, before.tetrahedra.size());
    EXPECT_EQ(t.tetrahedra, result.mesh.tetrahedra.size());
    EXPECT_NEAR(std::min(t.min_dihedral, 180 - t.max_dihedral), now.dihedral, 1e-4);
    EXPECT_NEAR(s.min_face_angle, old.face, 1e-4);
  }
};

TetMesh unimproved(const delmesher::Surface& surface, delmesher::Region region) {
  Options options;
  options.improve = false;
  options.slivers = false;
  options.region = region;
  Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  return std::move(result.mesh);
}

class OurModels : public testing::TestWithParam<NamedSurface> {};

TEST_P(OurModels, OfOursAreKeptAndNotWorse) {
  for (const auto region : {delmesher::Region::interior, delmesher::Region::hull}) {
    const TetMesh mesh = unimproved(GetParam().surface, region);
    const Law law(mesh);
    oracles::VerifyReport report;
    ASSERT_EQ(oracles::verify(samples::to_polyhedron(GetParam().surface),
                              samples::to_mesh(law.result.mesh), nullptr, {}, report),
              "");
    EXPECT_FALSE(oracles::failed(report, {})) << oracles::to_text(report);
  }
}

// Parts of a solid as if they were different materials, told apart by their middles.
TEST_P(OurModels, KeepTheirRegions) {
  TetMesh mesh = unimproved(GetParam().surface, delmesher::Region::interior);
  double mean = 0;
  for (const Point& p : mesh.vertices) mean += p[0] / static_cast<double>(mesh.vertices.size());
  for (const auto& t : mesh.tetrahedra) {
    double x = 0;
    for (const std::uint32_t v : t) x += mesh.vertices[v][0] / 4;
    mesh.regions.push_back(x < mean ? -3 : 1000);
  }
  mesh.inside.clear();
  const Law law(mesh);
  EXPECT_EQ(std::count(law.result.mesh.inside.begin(), law.result.mesh.inside.end(), 1),
            static_cast<std::ptrdiff_t>(law.result.mesh.tetrahedra.size()));
}

INSTANTIATE_TEST_SUITE_P(ImproveMesh, OurModels, testing::ValuesIn(samples::surfaces(kSeed)),
                         [](const auto& model) { return model.param.name; });

const TetMesh& cube() {
  static const TetMesh mesh = [] {
    Options options;
    options.max_edge = 0.3;
    options.improve = false;
    return delmesher::tetrahedralize(samples::surfaces(kSeed)[0].surface, options).mesh;
  }();
  return mesh;
}

TEST(ImproveMesh, MakesACubeBetter) {
  const Law law(cube());
  EXPECT_GT(law.result.statistics.final.min_dihedral, law.result.statistics.refined.min_dihedral);
  EXPECT_LT(law.result.mesh.tetrahedra.size(), cube().tetrahedra.size());
  EXPECT_TRUE(law.result.warnings.empty());
}

TEST(ImproveMesh, IsTheSameAgain) {
  const Result first = delmesher::improve_mesh(cube()), again = delmesher::improve_mesh(cube());
  EXPECT_EQ(first.mesh.vertices, again.mesh.vertices);
  EXPECT_EQ(first.mesh.tetrahedra, again.mesh.tetrahedra);
}

// Powers of two change nothing, however large.
TEST(ImproveMesh, ScalesExactly) {
  const Result first = delmesher::improve_mesh(cube());
  for (const int exponent : {-300, 40, 500}) {
    TetMesh scaled = cube();
    for (Point& p : scaled.vertices) {
      for (double& x : p) x = std::ldexp(x, exponent);
    }
    Result result = delmesher::improve_mesh(scaled);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_EQ(result.mesh.tetrahedra, first.mesh.tetrahedra) << exponent;
    for (Point& p : result.mesh.vertices) {
      for (double& x : p) x = std::ldexp(x, -exponent);
    }
    EXPECT_EQ(result.mesh.vertices, first.mesh.vertices) << exponent;
  }
}

TEST(ImproveMesh, TurnsTheOtherConventionAndDropsUnusedVertices) {
  TetMesh mesh = cube();
  for (auto& t : mesh.tetrahedra) std::swap(t[1], t[3]);
  mesh.vertices.push_back({7, 7, 7});
  const Result result = delmesher::improve_mesh(mesh);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.warnings,
            (std::vector<std::string>{"all tetrahedra were negative and have been turned",
                                      "1 vertex of no tetrahedron is dropped"}));
  for (const auto& t : result.mesh.tetrahedra) EXPECT_GT(volume(result.mesh, t), 0);
  EXPECT_EQ(std::count(result.mesh.vertices.begin(), result.mesh.vertices.end(), Point{7, 7, 7}),
            0);
}

// A flat tetrahedron in the middle of an octahedron's four: two of its faces below, two above.
TEST(ImproveMesh, RemovesFlatTetrahedra) {
  TetMesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 3, 4}, {1, 0, 3, 5}, {2, 1, 3, 5}, {0, 1, 3, 2}};
  const Result result = delmesher::improve_mesh(mesh);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.statistics.rounding_flat, 0U);
  for (const auto& t : result.mesh.tetrahedra) EXPECT_GT(volume(result.mesh, t), 0);
  EXPECT_EQ(kept_faces(result.mesh), kept_faces(mesh));
}

TEST(ImproveMesh, MakesNoEdgeThatIsTooLong) {
  const auto longest = [](const TetMesh& mesh) {
    double length = 0;
    for (const auto& t : mesh.tetrahedra) {
      for (int i = 0; i < 4; ++i) {
        const Point &a = mesh.vertices[t[i]], &b = mesh.vertices[t[(i + 1) % 4]];
        length = std::max(length, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
      }
    }
    return length;
  };
  ImproveOptions options;
  options.max_edge = longest(cube());
  const Law law(cube(), options);
  EXPECT_LE(longest(law.result.mesh), options.max_edge);
  EXPECT_GT(longest(delmesher::improve_mesh(cube()).mesh), options.max_edge);
}

// Near one corner, where the mesh must be fine; far from there it becomes coarser.
TEST(ImproveMesh, MakesNoEdgeAboveTheSizeField) {
  const Point corner = cube().vertices[cube().tetrahedra[0][0]];
  ImproveOptions options;
  options.size_growth = 0.5;
  // The edges that exceed what they may be, among those of all tetrahedra.
  const auto too_long = [&](const TetMesh& mesh, double size) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& t : mesh.tetrahedra) {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
          const Point &a = mesh.vertices[t[i]], &b = mesh.vertices[t[j]];
          const auto from = [&](const Point& p) {
            return std::hypot(p[0] - corner[0], p[1] - corner[1], p[2] - corner[2]);
          };
          const double length = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
          // The ends alone: a weaker law than that of the whole edge.
          if (length > size + 0.5 * std::min(from(a), from(b)) + 1e-12) {
            edges.insert(std::minmax(t[i], t[j]));
          }
        }
      }
    }
    return edges.size();
  };
  double size = 0.01;
  while (too_long(cube(), size) > 0) size *= 1.1;
  // With the law of the whole edge: enough that nothing is too long before.
  options.size_field = {{corner, size}};
  const Law law(cube(), options);
  EXPECT_EQ(too_long(law.result.mesh, size), 0U);
  EXPECT_GT(too_long(delmesher::improve_mesh(cube()).mesh, size), 0U);
  EXPECT_LT(law.result.mesh.tetrahedra.size(), cube().tetrahedra.size());
}

TEST(ImproveMesh, RefusesWithItsOwnStatus) {
  TetMesh mesh = cube();
  std::swap(mesh.tetrahedra[3][0], mesh.tetrahedra[3][1]);
  Result result = delmesher::improve_mesh(mesh);
  EXPECT_EQ(result.status.code, StatusCode::invalid_mesh);
  EXPECT_EQ(result.status.message,
            "tetrahedra 0 and 3 are of opposite orientation: one of them is inverted");
  EXPECT_TRUE(result.mesh.tetrahedra.empty());
  mesh = cube();
  mesh.regions = {1, 2};
  result = delmesher::improve_mesh(mesh);
  EXPECT_EQ(result.status.code, StatusCode::invalid_mesh);
  EXPECT_EQ(result.status.message.find("2 regions for "), 0U) << result.status.message;
  EXPECT_EQ(delmesher::improve_mesh({}).status.message, "there are no tetrahedra");
  ImproveOptions options;
  options.delta = 31;
  EXPECT_EQ(delmesher::improve_mesh(cube(), options).status.code, StatusCode::invalid_options);
  options = {};
  options.progress = [](const delmesher::Progress&) { return false; };
  EXPECT_EQ(delmesher::improve_mesh(cube(), options).status.code, StatusCode::interrupted);
  options = {};
  options.max_vertices = 5;
  EXPECT_EQ(delmesher::improve_mesh(cube(), options).status.code, StatusCode::limit_reached);
}

// --- meshes of others

namespace fs = std::filesystem;

TetMesh from(const oracles::MeshFile& file) {
  TetMesh mesh;
  mesh.vertices = file.vertices;
  mesh.tetrahedra = file.tetrahedra;
  for (const std::int64_t r : file.regions) mesh.regions.push_back(static_cast<std::int32_t>(r));
  mesh.boundary = file.boundary;
  mesh.boundary_labels = file.labels;
  mesh.boundary_labels.resize(mesh.boundary.size());
  mesh.boundary_facets.resize(mesh.boundary.size());
  return mesh;
}

#ifdef TETGEN_PATH
TEST(ImproveMesh, OfTetgenAreKeptAndNotWorse) {
  const fs::path folder = fs::path(TETPROOF_SCRATCH) / "improve_tetgen";
  fs::create_directories(folder);
  int delivered = 0;
  for (const NamedSurface& model : samples::surfaces(kSeed)) {
    const fs::path in = folder / "in.off", out = folder / "out.mesh";
    fs::remove(out);
    std::ofstream file(in);
    file.precision(17);
    file << "OFF\n"
         << model.surface.vertices.size() << " " << model.surface.triangles.size() << " 0\n";
    for (const auto& p : model.surface.vertices) file << p[0] << " " << p[1] << " " << p[2] << "\n";
    for (const auto& t : model.surface.triangles) {
      file << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
    }
    file.close();
    // It does not end on all of them.
    const std::string command = "timeout 5 " + std::string(TETGEN_PATH) + " zpcqT0 " + in.string() +
                                " " + out.string() + " " + (folder / "stats.json").string() +
                                " > " + (folder / "log").string() + " 2>&1";
    if (std::system(command.c_str()) != 0 || !fs::exists(out)) continue;
    ++delivered;
    SCOPED_TRACE(model.name);
    const Law law(from(oracles::read_mesh(out.string())));
  }
  fs::remove_all(folder);
  EXPECT_GT(delivered, 6);
}
#endif

#ifdef GMSH_PATH
// Two boxes of different materials side by side, and labels on some of their sides.
TEST(ImproveMesh, OfGmshAreKeptAndNotWorse) {
  const fs::path folder = fs::path(TETPROOF_SCRATCH) / "improve_gmsh";
  fs::create_directories(folder);
  const fs::path in = folder / "in.geo", out = folder / "out.msh";
  std::ofstream(in) << "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n"
                       "Box(2) = {1, 0, 0, 1, 1, 1};\n"
                       "BooleanFragments{Volume{1}; Delete;}{Volume{2}; Delete;}\n"
                       "Physical Volume(7) = {1};\nPhysical Volume(9) = {2};\n"
                       "Physical Surface(3) = {1, 2, 3};\nMesh.MeshSizeMax = 0.4;\n"
                       "Mesh.Optimize = 0;\n";
  const std::string command = std::string(GMSH_PATH) + " " + in.string() +
                              " -3 -format msh41 -nt 1 -o " + out.string() + " > " +
                              (folder / "log").string() + " 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const TetMesh mesh = from(oracles::read_mesh(out.string()));
  fs::remove_all(folder);
  ASSERT_GT(mesh.tetrahedra.size(), 100U);
  ASSERT_GT(mesh.boundary.size(), 20U);
  const Law law(mesh);
  EXPECT_EQ(std::set<std::int32_t>(law.result.mesh.regions.begin(), law.result.mesh.regions.end()),
            (std::set<std::int32_t>(mesh.regions.begin(), mesh.regions.end())));
  EXPECT_GT(law.result.statistics.final.min_dihedral, law.result.statistics.refined.min_dihedral);
}
#endif

}  // namespace
}  // namespace tetproof::improve_mesh_test
