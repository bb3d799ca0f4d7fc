// Other programs' answers: CGAL and OpenMesh on the validity of surfaces, CGAL's and TetGen's
// meshes before our oracles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <random>

#include "mesher/delmesher.h"
#include "oracles/cgal/kernel_opinion.h"
#include "oracles/cgal/surface_opinion.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/surface_file.h"
#include "oracles/mesh/delaunay.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::second_opinion_test {
namespace {

using namespace oracles;  // NOLINT
using delmesher::Surface;

constexpr std::uint64_t kSeed = 20261123;

// ------------------------------------------------------------------------------- valid surfaces

// The mesher, CGAL and, as far as it can tell, OpenMesh agree.
bool agreed_validity(const std::string& name, const Surface& surface) {
  const delmesher::SurfaceReport ours = delmesher::check_surface(surface);
  const bool valid = ours.status.ok();
  const Polyhedron polyhedron = samples::to_polyhedron(surface);
  const SurfaceOpinion cgal = cgal_surface_opinion(polyhedron);
  EXPECT_EQ(cgal.valid(), valid) << name << ": CGAL: " << cgal.reason
                                 << ", ours: " << ours.status.message;
  const SurfaceOpinion openmesh = openmesh_surface_opinion(polyhedron);
  if (valid || !openmesh.valid()) {
    EXPECT_EQ(openmesh.valid(), valid)
        << name << ": OpenMesh: " << openmesh.reason << ", ours: " << ours.status.message;
  }
  EXPECT_EQ(openmesh.valid(), cgal.manifold && cgal.closed) << name;
  return valid;
}

TEST(SurfaceValidity, ThreeProgramsCallTheSamplesValid) {
  std::size_t valid = 0;
  for (const samples::NamedSurface& model : samples::surfaces(kSeed)) {
    valid += agreed_validity(model.name, model.surface);
  }
  EXPECT_EQ(valid, samples::surfaces(kSeed).size());
}

struct Twin {
  const char* name;
  std::function<void(Surface&, std::mt19937_64&)> spoil;
};

const Twin kTwins[] = {
    {"a triangle missing",
     [](Surface& s, auto& r) {
       s.triangles.erase(s.triangles.begin() +
                         static_cast<std::ptrdiff_t>(r() % s.triangles.size()));
     }},
    {"a triangle turned over",
     [](Surface& s, auto& r) {
       auto& t = s.triangles[r() % s.triangles.size()];
       std::swap(t[0], t[1]);
     }},
    {"a triangle twice",
     [](Surface& s, auto& r) { s.triangles.push_back(s.triangles[r() % s.triangles.size()]); }},
    {"an edge of four triangles",
     [](Surface& s, auto&) {
       const auto n = static_cast<std::uint32_t>(s.vertices.size());
       const auto t = s.triangles[0];
       s.vertices.push_back({40, 41, 42});
       s.vertices.push_back({41, 40, 43});
       s.triangles.insert(
           s.triangles.end(),
           {{t[0], t[1], n}, {t[1], t[0], n + 1}, {t[0], n, n + 1}, {t[1], n + 1, n}});
     }},
    {"a vertex of two fans",
     [](Surface& s, auto&) {
       const auto n = static_cast<std::uint32_t>(s.vertices.size());
       const std::uint32_t v = s.triangles[0][0];
       for (const auto& p : {std::array{40.0, 0.0, 0.0}, {40.0, 1.0, 0.0}, {40.0, 0.0, 1.0}}) {
         s.vertices.push_back(p);
       }
       s.triangles.insert(s.triangles.end(),
                          {{v, n + 1, n}, {v, n, n + 2}, {v, n + 2, n + 1}, {n, n + 1, n + 2}});
     }},
    {"a vertex pushed through the other side",
     [](Surface& s, auto& r) {
       // Through a side, not through the middle: that may give a valid surface inside out.
       double centre = 0;
       for (const auto& p : s.vertices) centre += p[0] / static_cast<double>(s.vertices.size());
       auto& p = s.vertices[s.triangles[r() % s.triangles.size()][0]];
       p[0] = centre + 4 * (centre - p[0]);
     }},
    {"two components that cross",
     [](Surface& s, auto&) {
       const Surface other = s;
       const auto offset = static_cast<std::uint32_t>(s.vertices.size());
       for (const auto& p : other.vertices) {
         s.vertices.push_back({p[0] + 0.03, p[1] + 0.05, p[2] + 0.07});
       }
       for (const auto& [a, b, c] : other.triangles) {
         s.triangles.push_back({a + offset, b + offset, c + offset});
       }
     }},
    {"two components that share a point",
     [](Surface& s, auto&) {
       // A tetrahedron whose corner is (another vertex at) the place of the lowest vertex.
       const auto low = *std::min_element(s.vertices.begin(), s.vertices.end());
       const auto n = static_cast<std::uint32_t>(s.vertices.size());
       for (const auto& d :
            {std::array{0.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {-1.0, 1.0, 0.0}, {-1.0, 0.0, 1.0}}) {
         s.vertices.push_back({low[0] + d[0], low[1] + d[1], low[2] + d[2]});
       }
       s.triangles.insert(
           s.triangles.end(),
           {{n, n + 1, n + 2}, {n, n + 3, n + 1}, {n, n + 2, n + 3}, {n + 1, n + 3, n + 2}});
     }},
    {"a triangle with collinear corners",
     [](Surface& s, auto&) {
       // Splits an edge, and fills the slit between the edge and its halves with a flat triangle.
       const auto t = s.triangles[0];
       const auto n = static_cast<std::uint32_t>(s.vertices.size());
       const auto &p = s.vertices[t[0]], &q = s.vertices[t[1]];
       s.vertices.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
       s.triangles[0] = {t[0], n, t[2]};
       s.triangles.push_back({n, t[1], t[2]});
       s.triangles.push_back({t[0], t[1], n});
     }},
    {"a coordinate that is not a number",
     [](Surface& s, auto&) {
       s.vertices[s.triangles[0][0]][1] = std::numeric_limits<double>::quiet_NaN();
     }},
};

TEST(SurfaceValidity, ThreeProgramsCallTheInvalidTwinsInvalid) {
  std::mt19937_64 random(kSeed);
  std::size_t invalid = 0, asked = 0;
  Surface bases[] = {samples::surfaces(kSeed)[0].surface, samples::surfaces(kSeed)[8].surface};
  for (Surface& base : bases) {  // so that midpoints of edges are exact
    for (auto& p : base.vertices) {
      for (double& x : p) x = std::nearbyint(x * 0x1p20) * 0x1p-20;
    }
  }
  for (const Twin& twin : kTwins) {
    for (const Surface& base : bases) {
      for (int n = 0; n < samples::iterations(1); ++n) {
        Surface surface = base;
        twin.spoil(surface, random);
        ++asked;
        if (std::string(twin.name).find("not a number") != std::string::npos) {
          EXPECT_FALSE(delmesher::check_surface(surface).status.ok());
          EXPECT_FALSE(cgal_surface_opinion(samples::to_polyhedron(surface)).valid());
          ++invalid;
          continue;
        }
        const bool valid = agreed_validity(twin.name, surface);
        EXPECT_FALSE(valid) << twin.name;
        invalid += !valid;
      }
    }
  }
  EXPECT_EQ(invalid, asked);
}

// Random moves of vertices: sometimes valid, sometimes not; the three have to agree on which.
TEST(SurfaceValidity, ThreeProgramsAgreeOnSurfacesThatMayOrMayNotCrossThemselves) {
  std::mt19937_64 random(kSeed);
  std::size_t valid = 0, asked = 0;
  for (int n = 0; n < samples::iterations(40); ++n) {
    Surface surface =
        n % 2 == 0 ? samples::quantized_star(random()) : samples::random_voxels(random());
    for (int moves = 0; moves < 5; ++moves) {
      auto& p = surface.vertices[random() % surface.vertices.size()];
      p[random() % 3] += (static_cast<double>(random() % 9) - 4) / 8;
    }
    ++asked;
    valid += agreed_validity("moved " + std::to_string(n), surface);
  }
  EXPECT_GT(valid, asked / 8);
  EXPECT_LT(valid, asked - asked / 8);
}

#ifdef CGAL_DATA
// Models that come with CGAL, valid or not. Files that are not surfaces are left out.
TEST(SurfaceValidity, ThreeProgramsAgreeOnCgalsModels) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(TETPROOF_SCRATCH) / "cgals_models";
  fs::remove_all(folder);
  fs::create_directories(folder);
  const std::string command =
      "tar -xzf " CGAL_DATA " -C '" + folder.string() + "' --wildcards 'data/meshes/*.off'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder / "data" / "meshes")) {
    constexpr std::uintmax_t kLargest = 200000;
    if (entry.path().extension() == ".off" && entry.file_size() < kLargest) {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  std::size_t valid = 0, asked = 0;
  for (const fs::path& file : files) {
    Polyhedron polyhedron;
    try {
      polyhedron = read_surface(file.string());
    } catch (const std::exception&) {
      continue;
    }
    ++asked;
    valid += agreed_validity(file.filename().string(), samples::to_surface(polyhedron));
  }
  fs::remove_all(folder);
  EXPECT_GT(valid, 15U);
  EXPECT_GT(asked, valid + 5);
}
#endif

// ---------------------------------------------------------------------------- meshes by others

// CGAL's Delaunay tetrahedrization as a mesh of the convex hull, whose surface is the input.
samples::Sample hull_sample(const std::vector<Position>& points) {
  samples::Sample sample;
  const auto tetrahedra = cgal_delaunay(points);
  sample.mesh.vertices = points;
  sample.mesh.tetrahedra = tetrahedra;
  ExactPoints exact_points;
  exact_points.assign(points);
  TetComplex complex{&exact_points, tetrahedra, {}, 0, static_cast<Index>(points.size())};
  Neighbours neighbours;
  check_complex(complex, neighbours);
  sample.input.vertices = points;
  for (Index i = 0; i < neighbours.across.size(); ++i) {
    if (neighbours.across[i] != kNone) continue;
    sample.input.triangles.push_back(face_of(tetrahedra[i / 4], static_cast<int>(i % 4)));
  }
  return sample;
}

void expect_good(const std::string& name, const std::vector<Position>& points) {
  const samples::Sample sample = hull_sample(points);
  VerifyReport report;
  ASSERT_EQ(verify(sample.input, sample.mesh, nullptr, {}, report), "") << name;
  EXPECT_EQ(report.verdict, Verdict::exact) << name << "\n" << to_text(report);
  ExactPoints exact_points;
  exact_points.assign(points);
  TetComplex complex{
      &exact_points, sample.mesh.tetrahedra, {}, 0, static_cast<Index>(points.size())};
  Neighbours neighbours;
  ASSERT_TRUE(check_complex(complex, neighbours).passed()) << name;
  const OracleReport delaunay = check_delaunay(complex, neighbours);
  EXPECT_TRUE(delaunay.passed()) << name << delaunay.findings[0];
  EXPECT_GT(delaunay.checked, points.size());
}

TEST(MeshesByCgal, OfRandomPointsPass) {
  std::mt19937_64 random(kSeed);
  for (int n = 0; n < samples::iterations(2); ++n) {
    std::vector<Position> points(400);
    for (Position& p : points) {
      for (double& x : p) x = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
    }
    expect_good("random points", points);
  }
}

TEST(MeshesByCgal, OfCosphericalPointsPass) {
  std::vector<Position> points;  // all on x^2 + y^2 + z^2 = 81 * 50
  for (int x = -63; x <= 63; ++x) {
    for (int y = -63; y <= 63; ++y) {
      const int rest = 4050 - x * x - y * y;
      const int z = rest >= 0 ? static_cast<int>(std::lround(std::sqrt(rest))) : -1;
      if (z < 0 || z * z != rest) continue;
      points.push_back({x / 8.0, y / 8.0, z / 8.0});
      if (z > 0) points.push_back({x / 8.0, y / 8.0, -z / 8.0});
    }
  }
  ASSERT_GT(points.size(), 100U);
  expect_good("points on a sphere", points);
  points.clear();
  for (int i = 0; i < 216; ++i) {
    points.push_back({i % 6 * 0.25, i / 6 % 6 * 0.25, i / 36 * 0.25});
  }
  expect_good("a grid", points);
}

#ifdef TETGEN_PATH
namespace fs = std::filesystem;

// TetGen places its points on the surface in doubles, and declares this fraction of the diagonal
// (corpus/peers/meshers.cpp). Up to that its meshes may be "deviating"; which ones are is reported.
constexpr double kTetgensDeviation = 1e-8;

TEST(MeshesByTetgen, OfValidSurfacesPass) {
  const fs::path folder = fs::path(TETPROOF_SCRATCH) / "by_tetgen";
  std::size_t delivered = 0;
  std::string deviating;
  for (const samples::NamedSurface& model : samples::surfaces(kSeed)) {
    fs::create_directories(folder);
    const fs::path in = folder / "in.off", out = folder / "out.mesh";
    {
      std::ofstream file(in);
      file.precision(17);
      file << "OFF\n"
           << model.surface.vertices.size() << " " << model.surface.triangles.size() << " 0\n";
      for (const auto& p : model.surface.vertices) {
        file << p[0] << " " << p[1] << " " << p[2] << "\n";
      }
      for (const auto& t : model.surface.triangles) {
        file << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
      }
    }
    // It does not end on all of them.
    const std::string command = "timeout 5 " + std::string(TETGEN_PATH) + " zpcqT0 " + in.string() +
                                " " + out.string() + " " + (folder / "stats.json").string() +
                                " > " + (folder / "log").string() + " 2>&1";
    if (std::system(command.c_str()) == 0 && fs::exists(out)) {
      ++delivered;
      VerifyReport report;
      const Polyhedron input = samples::to_polyhedron(model.surface);
      ASSERT_EQ(verify(input, read_mesh(out.string()), nullptr, {}, report), "");
      EXPECT_FALSE(failed(report, {.declared_deviation = kTetgensDeviation})) << model.name << "\n"
                                                                              << to_text(report);
      if (!samples::exact_or_rounded(report))
        deviating += (deviating.empty() ? "" : ", ") + model.name;
    }
    fs::remove_all(folder);
  }
  EXPECT_GT(delivered, 6U) << "TetGen meshes simple models";
  std::cout << "TetGen delivered " << delivered << " of " << samples::surfaces(kSeed).size()
            << " models, farther than 4 ulp from the surface: "
            << (deviating.empty() ? "none" : deviating) << "\n";
}
#endif

}  // namespace
}  // namespace tetproof::second_opinion_test
