// The generated families: our check agrees with their certificate, and twins are rejected for the
// right reason. TETPROOF_ITERATIONS widens the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "corpus/generators/certify.h"
#include "corpus/generators/edits.h"
#include "corpus/generators/generate.h"
#include "corpus/generators/shrink.h"
#include "corpus/generators/twins.h"
#include "fuzz/properties.h"
#include "mesher/delmesher.h"
#include "mesher/io/parse_surface.h"

namespace tetproof {
namespace {

using delmesher::Surface;

std::uint64_t members() {
  const char* text = std::getenv("TETPROOF_ITERATIONS");
  return text != nullptr ? static_cast<std::uint64_t>(std::atoi(text)) : 3;
}

class Families : public testing::TestWithParam<const char*> {};

TEST_P(Families, AreValidAndTheSameEveryTime) {
  const Family* family = find_family(GetParam());
  ASSERT_NE(family, nullptr);
  for (std::uint64_t i = 0; i < members(); ++i) {
    const auto surface = generate(*family, 11, i);
    ASSERT_TRUE(surface) << i;
    const auto report = delmesher::check_surface(*surface);
    EXPECT_TRUE(report.status.ok()) << i << ": " << report.status.message;
    const auto again = generate(*family, 11, i);
    EXPECT_EQ(surface->vertices, again->vertices);
    EXPECT_EQ(surface->triangles, again->triangles);
  }
}

TEST_P(Families, TwinsAreRefusedForTheRightReason) {
  const Family* family = find_family(GetParam());
  for (std::uint64_t i = 0; i < members(); ++i) {
    const auto surface = generate(*family, 12, i);
    ASSERT_TRUE(surface);
    Random random(i);
    const auto twins = make_twins(*surface, random);
    EXPECT_EQ(twins.size(), 4U) << i;
    for (const Twin& twin : twins) {
      const auto report = delmesher::check_surface(twin.surface);
      EXPECT_EQ(report.status.code, delmesher::StatusCode::invalid_surface) << i << twin.name;
      EXPECT_GT(report.defect_counts[static_cast<std::size_t>(twin.reason)], 0U) << i << twin.name;
      EXPECT_STREQ(reason_text(twin.reason), delmesher::defect_name(twin.reason));
    }
  }
}

TEST_P(Families, KeepTheirSurface) {
  const Family* family = find_family(GetParam());
  for (std::uint64_t i = 0; i < members(); ++i) {
    const auto surface = generate(*family, 13, i);
    ASSERT_TRUE(surface);
    EXPECT_EQ(fuzz::keep_holds(*surface), "") << i;
  }
}

std::vector<const char*> family_names() {
  std::vector<const char*> names;
  for (const Family& family : families()) names.push_back(family.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(All, Families, testing::ValuesIn(family_names()),
                         [](const auto& name) { return std::string(name.param); });

// The statistics of a member that passes all oracles, to see the effect of rounding.
delmesher::Statistics expect_written_positive(const char* family, std::uint64_t member) {
  const auto surface = generate(*find_family(family), 1, member);
  EXPECT_TRUE(surface);
  if (!surface) return {};
  delmesher::Options options;
  options.surface = delmesher::SurfaceChoice::split;
  const auto result = delmesher::tetrahedralize(*surface, options);
  EXPECT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(fuzz::default_pipeline_holds(*surface), "") << family << member;
  return result.statistics;
}

// Vertices and edges are a fraction of an ulp from others. Rounding tangles the tetrahedra around
// them, and no single move untangles them; or only the record tells on which of two edges a written
// point lies.
TEST(Members, BelowAnUlpAreWrittenPositive) {
  const std::pair<const char*, std::uint64_t> members[] = {
      {"damaged", 29}, {"edited", 22}, {"edited", 23}, {"edited", 45}};
  for (const auto& [family, member] : members) {
    // Otherwise the member would show nothing.
    const auto surface = generate(*find_family(family), 1, member);
    delmesher::CheckOptions as_given;
    as_given.planar = 0;
    EXPECT_LT(delmesher::check_surface(*surface, as_given).smallest_local_feature_size, 0x1p-53);
    EXPECT_GT(expect_written_positive(family, member).rounding_repaired, 0U) << family << member;
  }
}

// Where no vertex can move to a double that fits, the last step takes fewer points.
TEST(Members, AreThinnedWhereDoublesAreTooCoarse) {
  for (const std::uint64_t member : {12U, 52U}) {
    EXPECT_GT(expect_written_positive("damaged", member).rounding_thinned, 0U) << member;
  }
}

// Walls of nearly parallel edges: points on one side and the other that do not face each other
// would be each other's reference, all along the wall.
TEST(Members, ThinWallsTakeFewPoints) {
  const std::pair<const char*, std::uint64_t> members[] = {
      {"spiral", 37}, {"spiral", 66}, {"scale", 79}};
  for (const auto& [family, member] : members) {
    const auto surface = generate(*find_family(family), 1, member);
    ASSERT_TRUE(surface);
    delmesher::CdtOptions options;
    options.region = delmesher::Region::interior;
    options.max_vertices = 5000;  // of at most 128; there were tens of millions
    EXPECT_TRUE(delmesher::constrained_delaunay(*surface, options).status.ok()) << family << member;
    EXPECT_EQ(fuzz::cdt_holds(*surface), "") << family << member;
  }
}

// Far from the origin the oracles must not measure roundings of the coordinates.
TEST(Members, FarFromTheOriginPass) {
  expect_written_positive("offset", 30);
}

// A certificate means nothing unless it objects to defects.
TEST(Certificate, NamesDefects) {
  using Kind = delmesher::Defect::Kind;
  Surface tet = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                 {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
                 {}};
  EXPECT_FALSE(first_defect(tet));
  Surface open = tet;
  open.triangles.pop_back();
  EXPECT_EQ(first_defect(open), Kind::open_edge);
  Surface turned = tet;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(first_defect(turned), Kind::inconsistent_orientation);
  Surface twice = tet;
  for (const auto& p : tet.vertices) twice.vertices.push_back({p[0] / 2, p[1] / 2, p[2] / 2});
  for (const auto& t : tet.triangles) twice.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  EXPECT_EQ(first_defect(twice), Kind::self_intersection);
}

TEST(Edits, KeepSurfacesValidAndChangeThem) {
  Surface surface = *generate(*find_family("star"), 1, 1);
  Random random(5);
  int changes = 0;
  for (int i = 0; i < 60; ++i) {
    const Surface before = surface;
    const bool changed = edit(surface, random, 40);
    changes += changed ? 1 : 0;
    EXPECT_EQ(changed,
              before.vertices != surface.vertices || before.triangles != surface.triangles);
    ASSERT_TRUE(certified_valid(surface)) << i;
  }
  EXPECT_GT(changes, 5);
}

// "Fails" on every surface that reaches as far as the given one: one spike of many is left.
TEST(Shrink, KeepsWhatMatters) {
  const Surface surface = *generate(*find_family("star"), 1, 1);
  const auto reach = [](const Surface& s) {
    double largest = s.vertices[0][0];
    for (const auto& p : s.vertices) largest = std::max(largest, p[0]);
    return largest;
  };
  const double enough = 0.9 * reach(surface);
  ShrinkProgress progress;
  const Surface small = shrink(
      surface,
      [&](const std::vector<Surface>& candidates) -> std::optional<std::size_t> {
        for (std::size_t i = 0; i < candidates.size(); ++i) {
          if (reach(candidates[i]) > enough) return i;
        }
        return std::nullopt;
      },
      {2000, 20}, progress);
  EXPECT_TRUE(certified_valid(small));
  EXPECT_GT(reach(small), enough);
  EXPECT_LE(small.triangles.size(), 8U);
  EXPECT_GT(progress.runs, 0U);
}

// "tetgen/needle_segfault" and so on.
std::vector<std::string> peer_failures() {
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  for (const auto& file : fs::recursive_directory_iterator(TETPROOF_FAILURES)) {
    if (file.path().extension() != ".off") continue;
    names.push_back(fs::relative(file.path(), TETPROOF_FAILURES).replace_extension().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// Small surfaces on which other meshers fail (corpus/models/failures/README.md).
class PeerFailures : public testing::TestWithParam<std::string> {};

TEST_P(PeerFailures, AreMeshed) {
  const std::string path = TETPROOF_FAILURES "/" + GetParam() + ".off";
  std::ifstream in(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  const auto read = delmesher::io::parse_surface(text, path);
  ASSERT_TRUE(read.ok()) << read.error;
  EXPECT_TRUE(certified_valid(read.surface));
  EXPECT_LE(read.surface.triangles.size(), 60U);
  EXPECT_EQ(fuzz::default_pipeline_holds(read.surface), "");
}
INSTANTIATE_TEST_SUITE_P(
    All, PeerFailures, testing::ValuesIn(peer_failures()), [](const auto& name) {
      std::string word = name.param;
      std::replace_if(
          word.begin(), word.end(),
          [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
      return word;
    });

// Boxes inside each other with walls of 1e-12 and 1e-7. Edges that run along each other at such a
// distance were split at different places, and each split asked for one more on the other edge.
TEST(Regressions, ThinWallsEnd) {
  for (const std::uint64_t member : {103, 107}) {
    const Surface surface = *generate(*find_family("cavities"), 1, member);
    delmesher::Options options;
    options.surface = delmesher::SurfaceChoice::split;
    options.size = 0;
    options.max_vertices = 10000;
    const auto result = delmesher::tetrahedralize(surface, options);
    EXPECT_TRUE(result.status.ok()) << member << ": " << result.status.message;
  }
}

// Lengths whose fourth powers are not doubles.
TEST(Scale, ExtremeSizesGiveTheSameMesh) {
  const Surface surface = *generate(*find_family("boolean_boxes"), 1, 0);
  delmesher::Options split;
  split.surface = delmesher::SurfaceChoice::split;
  const auto plain = delmesher::tetrahedralize(surface, split);
  ASSERT_TRUE(plain.status.ok()) << plain.status.message;
  for (const int exponent : {-400, -268, 268}) {
    Surface scaled = surface;
    for (auto& p : scaled.vertices) {
      for (double& x : p) x = std::ldexp(x, exponent);
    }
    const auto result = delmesher::tetrahedralize(scaled, split);
    ASSERT_TRUE(result.status.ok()) << exponent << ": " << result.status.message;
    EXPECT_EQ(result.mesh.tetrahedra, plain.mesh.tetrahedra) << exponent;
    ASSERT_EQ(result.mesh.vertices.size(), plain.mesh.vertices.size()) << exponent;
    for (std::size_t v = 0; v < plain.mesh.vertices.size(); ++v) {
      for (std::size_t i = 0; i < 3; ++i) {
        ASSERT_EQ(result.mesh.vertices[v][i], std::ldexp(plain.mesh.vertices[v][i], exponent));
      }
    }
    EXPECT_EQ(result.statistics.bbox_diagonal,
              std::ldexp(plain.statistics.bbox_diagonal, exponent));
  }
}

}  // namespace
}  // namespace tetproof
