// The same laws on real models: parts and scans that come with CGAL (Debian's libcgal-demo).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <ostream>
#include <string_view>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/files/surface_file.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::real_models_test {
namespace {

namespace fs = std::filesystem;
using oracles::VerifyReport;

constexpr bool kInstalled = std::string_view(REAL_MODELS) != "";

// Polygons that are not all triangles, acute corners, holes, handles, round shapes, scans; small
// enough for every run.
constexpr const char* kModels[] = {"3torus",
                                   "P",
                                   "blob-closed",
                                   "corner",
                                   "cross",
                                   "cross_quad",
                                   "double-torus-example",
                                   "geosphere",
                                   "hole",
                                   "itemb",
                                   "pipe",
                                   "quint_tris",
                                   "star",
                                   "torus_quad",
                                   "tripod",
                                   "u"};

std::vector<const char*> models() {
  if (!kInstalled) return {};
  return {std::begin(kModels), std::end(kModels)};
}

fs::path extracted(const std::string& model) {
  std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
  for (char& c : test) {
    if (c == '/') c = '_';
  }
  const fs::path folder = fs::path(TETPROOF_SCRATCH) / "real_models" / test;
  fs::create_directories(folder);
  const std::string member = "data/meshes/" + model + ".off";
  const std::string command =
      "tar -xzf " REAL_MODELS " -C '" + folder.string() + "' '" + member + "'";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return folder / member;
}

// Without the package the tests below are not there. So that this is noticed, this one is skipped
// then, and fails where all packages should be installed (ci/test).
TEST(Package, OfRealModelsIsInstalled) {
  if (kInstalled) return;
  const char* const missing = "no models: Debian's libcgal-demo (data.tar.gz) was not found";
  if (std::getenv("TETPROOF_ALL_PACKAGES") != nullptr) FAIL() << missing;
  GTEST_SKIP() << missing;
}

class RealModels : public testing::TestWithParam<const char*> {};

std::string test_name(const testing::TestParamInfo<const char*>& tested) {
  std::string name = tested.param;
  for (char& c : name) {
    if (c == '-') c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Cgal, RealModels, testing::ValuesIn(models()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealModels);

void expect_every_promise_kept(const oracles::Polyhedron& input, delmesher::Options options) {
  options.want_exact = true;
  const delmesher::Result result = delmesher::tetrahedralize(samples::to_surface(input), options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  VerifyReport report;
  const oracles::Promise promise = oracles::promise_of(options);
  ASSERT_EQ(oracles::verify(input, samples::to_mesh(result.mesh), &result.exact,
                            {.stage = oracles::Stage::both, .promised = promise}, report),
            "");
  EXPECT_TRUE(samples::as_promised(report)) << to_text(report);
  std::vector<const char*> oracles = {"conformity", "exact-conformity", "exact-volume",
                                      "exact-interior", "exact-constrained-delaunay"};
  if (result.statistics.ladder[delmesher::Rung::keep_surface] == 0) {
    for (const char* oracle :
         {"refined-delaunay", "refined-angles", "refined-segments", "refined-encroachment"}) {
      oracles.push_back(oracle);
    }
  }
  for (const char* oracle : oracles) {
    const oracles::OracleReport* said = report.find(oracle);
    ASSERT_NE(said, nullptr) << oracle;
    EXPECT_GT(said->checked, 10U) << oracle;
  }
}

TEST_P(RealModels, KeepEveryPromiseWithTheDefaults) {
  expect_every_promise_kept(oracles::read_surface(extracted(GetParam()).string()), {});
}

TEST_P(RealModels, KeepEveryPromiseWithTheirSurfaceSplit) {
  delmesher::Options options = samples::split_surface();
  expect_every_promise_kept(oracles::read_surface(extracted(GetParam()).string()), options);
}

TEST_P(RealModels, KeepEveryPromiseWithThePapersSettings) {
  expect_every_promise_kept(oracles::read_surface(extracted(GetParam()).string()),
                            delmesher::paper_options());
}

}  // namespace
}  // namespace tetproof::real_models_test
