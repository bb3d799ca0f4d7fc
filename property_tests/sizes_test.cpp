// Laws of the edges' size on average (Options::size).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mesher/delmesher.h"
#include "oracles/base/vectors.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::sizes_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::Surface;

Surface box(const std::array<double, 3>& high) {
  Surface surface;
  samples::add_box(surface, {0, 0, 0}, high);
  return surface;
}

// Lengths of all edges, in units of `size`, sorted.
std::vector<double> edges(const delmesher::TetMesh& mesh, double size) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const auto& tet : mesh.tetrahedra) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) pairs.insert(std::minmax(tet[i], tet[j]));
    }
  }
  std::vector<double> lengths;
  for (const auto& [a, b] : pairs) {
    lengths.push_back(oracles::distance(mesh.vertices[a], mesh.vertices[b]) / size);
  }
  std::sort(lengths.begin(), lengths.end());
  return lengths;
}

double share_between(const std::vector<double>& sorted, double low, double high) {
  const auto from = std::lower_bound(sorted.begin(), sorted.end(), low),
             to = std::upper_bound(sorted.begin(), sorted.end(), high);
  return static_cast<double>(to - from) / static_cast<double>(sorted.size());
}

oracles::VerifyReport verified(const Surface& surface, const Result& result,
                               const Options& promised) {
  oracles::VerifyReport report;
  EXPECT_EQ(oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh),
                            &result.exact, {.promised = oracles::promise_of(promised)}, report),
            "");
  return report;
}

TEST(Sizes, EdgesHaveTheSizeOnAverage) {
  const std::pair<Surface, double> parts[] = {
      {box({1, 1, 1}), 0.125}, {box({10, 1, 1}), 0.4}, {box({3, 2, 1}), 0.2}};
  for (const auto& [surface, size] : parts) {
    Options options;
    options.size = size;
    options.want_exact = true;
    const Result result = delmesher::tetrahedralize(surface, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    const std::vector<double> lengths = edges(result.mesh, size);
    double sum = 0;
    for (const double length : lengths) sum += length;
    const double mean = sum / static_cast<double>(lengths.size());
    EXPECT_GE(mean, 0.9);
    EXPECT_LE(mean, 1.1);
    EXPECT_GE(share_between(lengths, 0.6, 1.4), 0.9);
    EXPECT_LE(lengths.back(), delmesher::kMostOfSize * (1 + 1e-9));
    const oracles::VerifyReport report = verified(surface, result, options);
    EXPECT_TRUE(report.all_passed()) << to_text(report);
    ASSERT_NE(report.find("edges"), nullptr);
    EXPECT_TRUE(report.find("edges")->passed());
    // Half of it was not promised to those who asked for this size.
    options.size = size / 2;
    EXPECT_FALSE(verified(surface, result, options).all_passed());
  }
}

// Corners that chamfering cut off come back unrefined. So the surface is split, and no edge of the
// written mesh is too long.
TEST(Sizes, BoundsHoldAtCornersThatComeBack) {
  for (const double height : {3.0, 12.0, 40.0}) {
    Surface spike;
    spike.vertices = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {0, 0, height}};
    spike.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    for (const bool field : {false, true}) {
      Options options;
      options.want_exact = true;
      if (field) {
        options.size_field = {{{0, 0, height}, 0.3}};
      } else {
        options.max_edge = 0.7;
      }
      const Result result = delmesher::tetrahedralize(spike, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.statistics.ladder[delmesher::Rung::keep_surface], 0U);
      const oracles::VerifyReport report = verified(spike, result, options);
      EXPECT_TRUE(report.all_passed() && report.unproven.empty()) << to_text(report);
      EXPECT_NE(report.find(field ? "sizes" : "edges"), nullptr);
    }
  }
}

// More tetrahedra than can be numbered: at once, however small.
TEST(Sizes, AreNotTooSmall) {
  for (const double size : {1e-4, 1e-9, 1e-300}) {
    for (const auto choice :
         {delmesher::SurfaceChoice::automatic, delmesher::SurfaceChoice::keep}) {
      Options options;
      options.size = size;
      options.surface = choice;
      const Result result = delmesher::tetrahedralize(box({1, 1, 1}), options);
      EXPECT_EQ(result.status.limit, delmesher::Limit::size) << size;
      EXPECT_NE(result.status.message.find("more than can be numbered"), std::string::npos);
    }
  }
}

TEST(Sizes, TheSmallerBoundCounts) {
  const Surface surface = box({3, 2, 1});
  const auto mesh = [&](double size, double max_edge) {
    Options options;
    options.size = size;
    options.max_edge = max_edge;
    return delmesher::tetrahedralize(surface, options).mesh;
  };
  const delmesher::TetMesh alone = mesh(0, 0.5);
  EXPECT_EQ(mesh(0.4, 0.5).tetrahedra, alone.tetrahedra);
  EXPECT_EQ(mesh(0.5 / delmesher::kMostOfSize, 0).tetrahedra, alone.tetrahedra);
  EXPECT_EQ(mesh(0.5 / delmesher::kMostOfSize, 0.6).tetrahedra, alone.tetrahedra);
}

// Edges may be halved without being asked where they exceed the size that may have been chosen: of
// a cube a tenth of the diagonal, of a bar a twentieth, of a slab its thickness, less what facets
// that are planar but for roundings may take.
TEST(Sizes, UnaskedAreAsTheDefaultMayBe) {
  const auto of = [](const std::string& options, double diagonal, double volume, double area) {
    oracles::Promise promise;
    EXPECT_EQ(oracles::parse_promise(options, promise), "");
    promise.allow_sizes(diagonal, volume, area, 0.25);
    return promise.longest_unasked / delmesher::kMostOfSize;
  };
  EXPECT_NEAR(of("mesh", std::sqrt(3), 1, 6), std::sqrt(3) / 10, 1e-12);
  EXPECT_NEAR(of("mesh --size auto", std::sqrt(102), 10, 42), std::sqrt(102) / 20, 1e-12);
  EXPECT_NEAR(of("mesh", std::sqrt(8.04), 0.8, 9.6),
              0.999 * 2 * 0.8 / 9.6 - 0x2p-12 * std::sqrt(8.04), 1e-12);
  // With a budget, those that are longer than nearly all are now.
  EXPECT_NEAR(of("mesh --budget 100 --max-edge 1", std::sqrt(3), 1, 6),
              0.999 * 0.25 / delmesher::kMostOfSize, 1e-12);
  for (const char* options : {"mesh --budget 100 --size none", "mesh --budget 100 --region hull",
                              "mesh --budget 100 --surface keep"}) {
    EXPECT_EQ(of(options, std::sqrt(3), 1, 6), 0) << options;
  }
  for (const char* options : {"mesh --size none", "mesh --size 1", "mesh --max-edge 1", "cdt",
                              "mesh --surface keep", "mesh --planar 0", "mesh --preset paper"}) {
    EXPECT_EQ(of(options, std::sqrt(3), 1, 6), 0) << options;
  }
}

TEST(Sizes, ASizeThatIsNoneIsRejected) {
  for (const double size : {-2.0, std::nan("")}) {
    Options options;
    options.size = size;
    const Result result = delmesher::tetrahedralize(box({1, 1, 1}), options);
    EXPECT_EQ(result.status.code, delmesher::StatusCode::invalid_options);
  }
}

TEST(Sizes, AnotherSurfaceHasNoLongerEdges) {
  delmesher::RemeshOptions options;
  options.tolerance = 0.01;
  options.size = 0.25;
  const delmesher::RemeshResult result = delmesher::remesh_surface(box({3, 2, 1}), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Surface& surface = result.surface;
  for (const auto& t : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(oracles::distance(surface.vertices[t[i]], surface.vertices[t[(i + 1) % 3]]),
                options.size * delmesher::kMostOfSize * (1 + 1e-9));
    }
  }
}

TEST(Sizes, PromisesAreRead) {
  oracles::Promise promise;
  EXPECT_EQ(oracles::parse_promise("mesh --size 2", promise), "");
  EXPECT_DOUBLE_EQ(promise.max_edge, 2.9);
  EXPECT_STREQ(promise.bound_on_edges(), "--size");
  EXPECT_EQ(oracles::parse_promise("mesh --size 2 --max-edge 2", promise), "");
  EXPECT_EQ(promise.max_edge, 2);
  EXPECT_STREQ(promise.bound_on_edges(), "--max-edge");
  EXPECT_NE(oracles::parse_promise("mesh --size 0", promise), "");
  EXPECT_NE(oracles::parse_promise("improve --size 1", promise), "");
}

}  // namespace
}  // namespace tetproof::sizes_test
