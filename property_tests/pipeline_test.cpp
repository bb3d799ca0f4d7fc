// Laws of the whole mesher, on its public interface, decided by the oracles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <thread>

#include "mesher/delmesher.h"
#include "mesher/delmesher/option_table.h"
#include "mesher/output/statistics.h"
#include "oracles/verify.h"
#include "property_tests/samples.h"

namespace tetproof::pipeline_test {
namespace {

using delmesher::Options;
using delmesher::Result;
using delmesher::StatusCode;
using delmesher::Surface;
using oracles::VerifyOptions;
using oracles::VerifyReport;
using samples::NamedSurface;

constexpr std::uint64_t kSeed = 20261121;

// The paper's thresholds, empty balls and region.
Options paper_options() {
  Options options = samples::split_surface();
  options.acute = options.corner = 90;
  options.gabriel = true;
  options.region = delmesher::Region::hull;
  options.want_exact = true;
  return options;
}

// The same with everything else as the paper says.
Options all_as_paper() {
  Options options = delmesher::paper_options();
  options.want_exact = true;
  return options;
}

Options default_options() {
  Options options = samples::split_surface();
  options.want_exact = true;
  return options;
}

VerifyReport check(const Surface& surface, const Result& result, const VerifyOptions& options) {
  VerifyReport report;
  EXPECT_EQ(oracles::verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh),
                            &result.exact, options, report),
            "");
  return report;
}

// Both certificates: the final mesh conforms exactly on exact coordinates and is valid as written;
// the refined mesh is Delaunay with every angle above the bound.
void expect_right(const NamedSurface& model, const Options& options) {
  SCOPED_TRACE(model.name);
  const Result result = delmesher::tetrahedralize(model.surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  VerifyOptions verify_options;
  verify_options.promised = oracles::promise_of(options);
  const VerifyReport final_report = check(model.surface, result, verify_options);
  EXPECT_TRUE(samples::exact_or_rounded(final_report)) << to_text(final_report);
  EXPECT_NE(final_report.find("exact-conformity"), nullptr);
  verify_options.stage = oracles::Stage::refined;
  const VerifyReport refined_report = check(model.surface, result, verify_options);
  EXPECT_TRUE(samples::exact_or_rounded(refined_report)) << to_text(refined_report);
  EXPECT_NE(refined_report.find("refined-delaunay"), nullptr);
}

// In the statistics every face counts once. The pipeline tells repeated faces by the neighbours of
// the tetrahedra; here they are found by comparing faces.
void expect_faces_counted_once(const NamedSurface& model, const Options& options) {
  SCOPED_TRACE(model.name);
  const Result result = delmesher::tetrahedralize(model.surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  delmesher::base::Control control(options);
  const delmesher::MeshStatistics compared = delmesher::output::mesh_statistics(
      result.mesh.vertices, result.mesh.tetrahedra, {}, result.mesh.vertices.size(), 0, control);
  const delmesher::MeshStatistics& told = result.statistics.final;
  EXPECT_EQ(told.face_angle_histogram, compared.face_angle_histogram);
  EXPECT_EQ(told.dihedral_histogram, compared.dihedral_histogram);
  EXPECT_NEAR(told.mean_min_face_angle, compared.mean_min_face_angle, 1e-9);
}

// The mesher's statistics of angles and shapes are those that the oracle finds in the file.
void expect_quality_told(const NamedSurface& model, const Options& options) {
  SCOPED_TRACE(model.name);
  const Result result = delmesher::tetrahedralize(model.surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const delmesher::MeshStatistics& s = result.statistics.final;
  VerifyReport report;
  ASSERT_EQ(oracles::verify(samples::to_polyhedron(model.surface), samples::to_mesh(result.mesh),
                            nullptr, {}, report),
            "");
  const oracles::OracleReport* angles = report.find("angles");
  ASSERT_NE(angles, nullptr);
  const std::map<std::string, double> figures(angles->figures.begin(), angles->figures.end());
  EXPECT_NEAR(s.min_dihedral, figures.at("smallest dihedral angle"), 1e-6);
  EXPECT_NEAR(s.min_gamma, figures.at("smallest gamma"), 1e-6);
  EXPECT_NEAR(s.mean_gamma, figures.at("mean gamma"), 1e-6);
  EXPECT_NEAR(s.gamma_1_percent, figures.at("1 % quantile of gamma"), 1e-6);
  EXPECT_NEAR(s.dihedral_1_percent, figures.at("1 % quantile of smallest dihedral angles"), 1e-6);
  EXPECT_NEAR(s.min_sicn, figures.at("smallest SICN"), 1e-6);
  EXPECT_NEAR(s.mean_sicn, figures.at("mean SICN"), 1e-6);
  EXPECT_EQ(static_cast<double>(s.below_5), figures.at("tetrahedra below 5 degrees"));
  EXPECT_EQ(static_cast<double>(s.below_10), figures.at("tetrahedra below 10 degrees"));
}

class Models : public testing::TestWithParam<NamedSurface> {};

std::string model_name(const testing::TestParamInfo<NamedSurface>& info) {
  return info.param.name;
}

TEST_P(Models, AreMeshedExactlyWithTheDefaults) {
  expect_right(GetParam(), default_options());
}

TEST_P(Models, CountEveryFaceOnce) {
  expect_faces_counted_once(GetParam(), default_options());
  expect_faces_counted_once(GetParam(), paper_options());
}

TEST_P(Models, HaveTheQualityThatTheMesherTells) {
  expect_quality_told(GetParam(), default_options());
}

TEST_P(Models, AreMeshedExactlyWithThePapersSettings) {
  expect_right(GetParam(), paper_options());
}

TEST_P(Models, AreMeshedExactlyAsThePaperSays) {
  Options options = all_as_paper();
  // Bridges of narrow triangles are short: 120 000 tetrahedra here, too many for every oracle.
  if (GetParam().name == "needle") options.as_paper.bridges = false;
  expect_right(GetParam(), options);
}

// Every choice alone, with a filter that has something to drop.
TEST(AsPaper, EveryChoiceKeepsItsPromises) {
  const std::vector<NamedSurface> models = samples::surfaces(kSeed);
  for (const std::string& choice : delmesher::options::paper_choices<Options>()) {
    SCOPED_TRACE(choice);
    for (std::size_t n = 0; n < models.size(); n += 7) {
      Options options = default_options();
      options.improve = false;
      options.tau = 0x1p-6;
      options.gabriel = true;  // what the guard does is tried elsewhere
      options.acute = options.corner = 90;
      EXPECT_TRUE(delmesher::options::set(options, choice, 1));
      expect_right(models[n], options);
    }
    Options options = default_options();
    options.tau = 0x1p-9;  // the slab goes
    EXPECT_TRUE(delmesher::options::set(options, choice, 1));
    if (options.as_paper.no_guard) continue;  // might run for ever
    expect_right({"wedge and slab", samples::wedge_and_slab()}, options);
  }
}

TEST_P(Models, HaveAConstrainedDelaunayTetrahedrization) {
  delmesher::CdtOptions options;
  options.want_exact = true;
  const Result result = delmesher::constrained_delaunay(GetParam().surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const VerifyReport report =
      check(GetParam().surface, result, {.promised = oracles::promise_of(options)});
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
}

// A regular tetrahedron, and two tetrahedra with a common face: they meet the bound as they are, so
// nothing is added.
TEST(Solids, ThatMeetTheBoundAreLeftAsTheyAre) {
  const NamedSurface models[] = {
      {"regular",
       {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
        {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
        {}}},
      {"bipyramid",
       {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
        {{0, 3, 2}, {0, 1, 3}, {0, 2, 1}, {1, 4, 3}, {1, 2, 4}, {2, 3, 4}},
        {}}}};
  for (const NamedSurface& model : models) {
    expect_right(model, default_options());
    const Result result = delmesher::tetrahedralize(model.surface, samples::split_surface());
    EXPECT_EQ(result.mesh.tetrahedra.size(), model.surface.triangles.size() / 3) << model.name;
    EXPECT_FALSE(result.statistics.enriched);
    // But they are refined where other sizes or the surroundings are asked for.
    Options options = samples::split_surface();
    options.max_edge = 0.25;
    EXPECT_GT(delmesher::tetrahedralize(model.surface, options).mesh.tetrahedra.size(), 50U);
    options.max_edge = 0;
    options.size_field = {{model.surface.vertices[0], 0.1}};
    EXPECT_GT(delmesher::tetrahedralize(model.surface, options).mesh.tetrahedra.size(), 50U);
    options.size_field.clear();
    options.region = delmesher::Region::hull;
    EXPECT_TRUE(delmesher::tetrahedralize(model.surface, options).statistics.enriched);
  }
  // A corner below the bound needs the points of the refinement.
  const Surface sharp = {{{0, 0, 0}, {1, 0, 0}, {1, 0.2, 0}, {0, 0, 1}},
                         {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}},
                         {}};
  EXPECT_TRUE(delmesher::tetrahedralize(sharp).statistics.enriched);
}

TEST_P(Models, GiveTheSameMeshTwice) {
  const Result first = delmesher::tetrahedralize(GetParam().surface);
  const Result second = delmesher::tetrahedralize(GetParam().surface);
  ASSERT_TRUE(first.status.ok()) << first.status.message;
  EXPECT_GT(first.mesh.tetrahedra.size(), 0U);
  EXPECT_EQ(first.mesh.vertices, second.mesh.vertices);
  EXPECT_EQ(first.mesh.tetrahedra, second.mesh.tetrahedra);
}

TEST_P(Models, ScaledByAPowerOfTwoGiveTheScaledMesh) {
  const Result plain = delmesher::tetrahedralize(GetParam().surface);
  ASSERT_TRUE(plain.status.ok()) << plain.status.message;
  for (const double scale : {0x1p-10, 0x1p20}) {
    Surface surface = GetParam().surface;
    for (auto& p : surface.vertices) {
      for (double& x : p) x *= scale;
    }
    Result scaled = delmesher::tetrahedralize(surface);
    ASSERT_TRUE(scaled.status.ok()) << scaled.status.message;
    for (auto& p : scaled.mesh.vertices) {
      for (double& x : p) x /= scale;
    }
    EXPECT_EQ(plain.mesh.tetrahedra, scaled.mesh.tetrahedra) << scale;
    EXPECT_EQ(plain.mesh.vertices, scaled.mesh.vertices) << scale;
  }
}

TEST_P(Models, PermutedGiveACorrectMesh) {
  NamedSurface model = GetParam();
  std::mt19937_64 random(kSeed);
  const auto shuffle = [&](auto& list) {  // std::shuffle differs between libraries
    for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[random() % i]);
  };
  std::vector<std::uint32_t> order(model.surface.vertices.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  shuffle(order);
  Surface permuted;
  permuted.vertices.resize(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    permuted.vertices[order[i]] = model.surface.vertices[i];
  }
  for (auto triangle : model.surface.triangles) {
    for (auto& v : triangle) v = order[v];
    std::rotate(triangle.begin(), triangle.begin() + random() % 3, triangle.end());
    permuted.triangles.push_back(triangle);
  }
  shuffle(permuted.triangles);
  expect_right({model.name, permuted}, default_options());
}

TEST_P(Models, WithAxesExchangedGiveACorrectMesh) {
  NamedSurface model = GetParam();
  for (auto& p : model.surface.vertices) p = {p[1], -p[2], -p[0]};  // a rotation
  expect_right(model, default_options());
}

TEST_P(Models, TurnedInsideOutAreFlippedAndReported) {
  NamedSurface model = GetParam();
  for (auto& triangle : model.surface.triangles) std::swap(triangle[0], triangle[1]);
  const Result result = delmesher::tetrahedralize(model.surface, default_options());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_FALSE(result.warnings.empty());
  EXPECT_TRUE(samples::exact_or_rounded(check(model.surface, result, {})));
}

INSTANTIATE_TEST_SUITE_P(Made, Models, testing::ValuesIn(samples::surfaces(kSeed)), model_name);

TEST(Labels, AreKeptAndMakeConstraints) {
  Surface surface = samples::to_surface(samples::cube().input);
  surface.labels.assign(surface.triangles.size(), 1);
  surface.labels[0] = 2;  // one half of a face
  const Result result = delmesher::tetrahedralize(surface, default_options());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const VerifyReport report = check(surface, result, {});
  EXPECT_TRUE(samples::exact_or_rounded(report)) << to_text(report);
  const auto& labels = result.mesh.boundary_labels;
  EXPECT_GT(std::count(labels.begin(), labels.end(), 2), 0);
  EXPECT_GT(std::count(labels.begin(), labels.end(), 1), 0);
}

// As in figure 8 two parallel faces are at a distance h, here those of a cube that is flattened.
// Thinner plates take more tetrahedra, and no more than the order of 1/h^2.
TEST(Refinement, EndsOnThinPlatesWithMoreTetrahedraTheThinnerTheyAre) {
  std::size_t last = 0;
  for (const double h : {0.2, 0.1, 0.05}) {
    Surface surface = samples::to_surface(samples::cube().input);
    for (auto& p : surface.vertices) p[2] *= h;
    const Result result = delmesher::tetrahedralize(surface, default_options());
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    EXPECT_GT(result.mesh.tetrahedra.size(), last) << h;
    EXPECT_LT(result.mesh.tetrahedra.size(), 400 / (h * h)) << h;
    last = result.mesh.tetrahedra.size();
  }
}

TEST(Threads, TwoMeshesInTwoThreadsAreThoseOfOneThread) {
  const std::vector<NamedSurface> models = samples::surfaces(kSeed);
  std::vector<Result> alone, together(models.size());
  for (const NamedSurface& model : models) {
    alone.push_back(delmesher::tetrahedralize(model.surface));
    ASSERT_TRUE(alone.back().status.ok()) << model.name;
  }
  std::vector<std::thread> threads;
  for (std::size_t part = 0; part < 2; ++part) {
    threads.emplace_back([&, part] {
      for (std::size_t i = part; i < models.size(); i += 2) {
        together[i] = delmesher::tetrahedralize(models[i].surface);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < models.size(); ++i) {
    EXPECT_EQ(alone[i].mesh.tetrahedra, together[i].mesh.tetrahedra) << models[i].name;
    EXPECT_EQ(alone[i].mesh.vertices, together[i].mesh.vertices) << models[i].name;
  }
}

TEST(Threads, AnyNumberInOneRunGivesTheSameMeshStatisticsAndPredicateCalls) {
  for (const NamedSurface& model : samples::surfaces(kSeed)) {
    for (Options options : {default_options(), paper_options()}) {
      options.tau = 0.03;
      const Result alone = delmesher::tetrahedralize(model.surface, options);
      ASSERT_TRUE(alone.status.ok()) << model.name;
      for (const unsigned threads : {2U, 3U, 8U}) {
        SCOPED_TRACE(model.name + ", " + std::to_string(threads) + " threads");
        options.threads = threads;
        const Result shared = delmesher::tetrahedralize(model.surface, options);
        EXPECT_EQ(alone.mesh.vertices, shared.mesh.vertices);
        EXPECT_EQ(alone.mesh.tetrahedra, shared.mesh.tetrahedra);
        EXPECT_EQ(alone.mesh.inside, shared.mesh.inside);
        EXPECT_EQ(alone.statistics.refined.mean_min_dihedral,
                  shared.statistics.refined.mean_min_dihedral);
        EXPECT_EQ(alone.statistics.predicate_filter, shared.statistics.predicate_filter);
        EXPECT_EQ(alone.statistics.predicate_fixed, shared.statistics.predicate_fixed);
        EXPECT_EQ(alone.statistics.predicate_exact, shared.statistics.predicate_exact);
      }
    }
  }
}

// A correct result, and findings in a wrong one.
TEST(Threads, AnyNumberGivesTheSameReport) {
  for (const NamedSurface& model : samples::surfaces(kSeed)) {
    Result result = delmesher::tetrahedralize(model.surface, default_options());
    ASSERT_TRUE(result.status.ok()) << model.name;
    for (const bool wrong : {false, true}) {
      if (wrong) {
        for (std::size_t t = 0; t < result.exact.refined.size(); t += 3) {
          std::swap(result.exact.refined[t].vertices[0], result.exact.refined[t].vertices[1]);
        }
        result.mesh.vertices.back()[0] += 0.5;
      }
      VerifyOptions options;
      options.stage = oracles::Stage::both;
      const VerifyReport alone = check(model.surface, result, options);
      EXPECT_EQ(samples::exact_or_rounded(alone), !wrong) << to_text(alone);
      for (const unsigned threads : {2U, 3U, 8U}) {
        options.threads = threads;
        EXPECT_EQ(to_json(check(model.surface, result, options)), to_json(alone)) << model.name;
      }
    }
  }
}

TEST(Limits, AreErrorsAsValues) {
  const Surface surface = samples::to_surface(samples::skewed(samples::l_shape()).input);
  Options options = samples::split_surface();
  options.max_vertices = 20;
  const delmesher::Status limit = delmesher::tetrahedralize(surface, options).status;
  EXPECT_EQ(limit.code, StatusCode::limit_reached);
  EXPECT_EQ(limit.limit, delmesher::Limit::size);
  const auto expect_refused = [&](const Options& wrong, const std::string& message) {
    const delmesher::Status status = delmesher::tetrahedralize(surface, wrong).status;
    EXPECT_EQ(status.code, StatusCode::invalid_options);
    EXPECT_EQ(status.message, message);
  };
  options = {};
  options.delta = 95;
  expect_refused(options, "delta must be above 0 and at most 30 degrees");
  options = {};
  options.tau = std::nan("");
  expect_refused(options, "tau must be between 0 and 1");
  options = {};
  options.max_edge = -1;
  expect_refused(options, "max_edge must be at least 0");
  options = {};
  options.size_growth = 0;
  expect_refused(options, "size_growth must be above 0 and at most 1");
  for (const delmesher::SizeSource& wrong :
       {delmesher::SizeSource{{0, 0, 0}, 0}, delmesher::SizeSource{{0, 0, 0}, HUGE_VAL},
        delmesher::SizeSource{{0, std::nan(""), 0}, 1}}) {
    options = {};
    options.size_field = {{{0, 0, 0}, 1}, wrong};
    expect_refused(options, "source 1 of the size field has no finite point or no size above 0");
  }
  options = {};
  options.threads = 1025;
  expect_refused(options, "threads must be between 0 and 1024");
  options = {};
  options.planar = 0.5;
  expect_refused(options, "planar must be between 0 and 0.01");
  options = {};
  std::uint64_t calls = 0;
  options.progress = [&](const delmesher::Progress&) { return ++calls < 3; };
  const Result result = delmesher::tetrahedralize(surface, options);
  EXPECT_EQ(result.status.code, StatusCode::interrupted);
  EXPECT_TRUE(result.mesh.tetrahedra.empty());
  EXPECT_EQ(calls, 3U);
}

// Two tetrahedra whose edges cross at a distance.
Surface crossing_edges(double gap) {
  const auto solid = [](std::initializer_list<std::array<double, 3>> corners) {
    Surface s;
    s.vertices = corners;
    s.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return s;
  };
  Surface s = solid({{0.61, 0, 0}, {-0.37, 0, 0}, {0.1, 0.3, -1}, {0.1, -0.4, -1}});
  const Surface upper =
      solid({{0.03, -0.53, gap}, {-0.11, 0.71, gap}, {0.6, 0.1, 1}, {-0.6, 0.1, 1}});
  for (auto t : upper.triangles) s.triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
  s.vertices.insert(s.vertices.end(), upper.vertices.begin(), upper.vertices.end());
  return s;
}

TEST(Precision, EndsWithALimitThatNamesTheEdge) {
  for (const double gap : {1e-6, 1e-16, 1e-20}) {
    expect_right({"gap " + std::to_string(gap), crossing_edges(gap)}, default_options());
  }
  Options unfiltered = default_options();
  unfiltered.tau = 0;
  expect_right({"gap 1e-40", crossing_edges(1e-40)}, unfiltered);
  for (const double gap : {1e-60, 1e-100, 1e-323}) {
    for (const double tau : {1e-4, 0.0}) {
      Options options = samples::split_surface();
      options.tau = tau;
      const Surface surface = crossing_edges(gap);
      EXPECT_TRUE(delmesher::check_surface(surface).status.ok());
      const Result result = delmesher::tetrahedralize(surface, options);
      EXPECT_EQ(result.status.code, StatusCode::limit_reached) << gap;
      EXPECT_EQ(result.status.limit, delmesher::Limit::precision) << gap;
      const bool first = result.status.message.find("edge 0-1: ") == 0;
      const bool second = result.status.message.find("edge 4-5: ") == 0;
      EXPECT_TRUE(first || second) << result.status.message;
    }
  }
}

// From 1e-55 on, a refinement did not end.
TEST(Precision, SizesBelowDoublesAreALimit) {
  const auto meshed = [](const std::array<double, 3>& place, double size) {
    Options options;
    options.size_field = {{{0.5, 0.5, 0.5}, 1}, {place, size}};
    Surface cube;
    samples::add_box(cube, {0, 0, 0}, {1, 1, 1});
    return delmesher::tetrahedralize(cube, options).status;
  };
  for (const double size : {1e-51, 1e-60, 1e-70, 1e-300}) {
    const delmesher::Status status = meshed({0, 0, 0}, size);
    EXPECT_EQ(status.code, StatusCode::limit_reached) << size;
    EXPECT_EQ(status.limit, delmesher::Limit::precision) << size;
    EXPECT_EQ(status.message.find("source 1 of the size field"), 0U) << status.message;
  }
  EXPECT_TRUE(meshed({0, 0, 0}, 1e-20).ok());
  EXPECT_TRUE(meshed({3, 0, 0}, 1e-60).ok());  // the field has grown where the body is
}

// An input of the fuzz target `complexity`: a quarter of the tetrahedra are not positive when they
// are rounded. Repairing them one by one took five million signs before points went.
TEST(Precision, RepairsOfManyTetrahedraWaitUntilPointsAreTakenOut) {
  Surface surface;
  surface.vertices = {{2.7583538983246254, 2.7583538983246254, 2.7583538983246254},
                      {0, 0, 0},
                      {0, 0.5184950247249993, 0.9999999997671694},
                      {0, 1, -0.6000012078456979},
                      {2.758353898324626, 2.758353898324626, 2.7583538983246254},
                      {4, 0, 0.5},
                      {4.999999998835847, 2.0000000009313226, 0},
                      {4, 1, 3},
                      {0.8751004381522676, 1.2345876337602637, 0.6594076865824072},
                      {3.9016149979956527, 1.216127238445714, 2.8793085564510537},
                      {4, 0.9999995754248624, 2.9999989385621557},
                      {3.547003387984915, 1.0820445984533769, 1.3645440954925696},
                      {1.6704774755893403, 2.0301875724198672, 3.049620428686529},
                      {2.9121235772647145, -0.7281663259047587, 0.7912665303619035}};
  surface.triangles = {{1, 2, 3},    {0, 3, 2},    {0, 8, 3},   {0, 2, 1},   {5, 6, 10},
                       {4, 9, 6},    {11, 12, 13}, {4, 6, 5},   {1, 8, 0},   {3, 8, 1},
                       {7, 9, 4},    {6, 9, 7},    {7, 10, 6},  {4, 10, 7},  {10, 4, 12},
                       {10, 12, 11}, {4, 5, 13},   {4, 13, 12}, {5, 10, 11}, {5, 11, 13}};
  const Result result = delmesher::tetrahedralize(surface, samples::split_surface());
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  EXPECT_EQ(result.statistics.rounding_inverted + result.statistics.rounding_flat, 0U);
  EXPECT_LT(result.statistics.rounding_signs, 100000U);
}

TEST(InvalidSurfaces, AreRefusedWithTheDefectNamed) {
  const Surface good = samples::to_surface(samples::cube().input);
  const auto refused = [](const Surface& surface) {
    const Result result = delmesher::tetrahedralize(surface);
    EXPECT_EQ(result.status.code, StatusCode::invalid_surface);
    EXPECT_FALSE(result.status.message.empty());
    EXPECT_EQ(result.status.message.find('\n'), std::string::npos);
  };
  Surface bad = good;
  bad.triangles.pop_back();
  refused(bad);
  bad = good;
  std::swap(bad.triangles[3][0], bad.triangles[3][1]);
  refused(bad);
  bad = good;
  bad.triangles[2][1] = 77;
  refused(bad);
  bad = good;
  bad.vertices[0][1] = std::nan("");
  refused(bad);
  bad = good;
  bad.vertices[7] = {-3, 0.5, 0.5};  // pulls a corner through the opposite side
  refused(bad);
  refused(Surface{});
}

// They do not fit into ordinary units, and lengths overflow in their own. That is a limit.
TEST(ExtremeSizes, AreALimitWhereNumbersDoNotFit) {
  std::size_t limits = 0;
  for (const NamedSurface& named :
       {NamedSurface{"cube", samples::to_surface(samples::cube().input)},
        NamedSurface{"prism", samples::triangular_prism({{{0, 0}, {4, 0}, {4, 1}}}, 0, 2)}}) {
    for (const int power : {-300, 300, 1000}) {
      Surface surface = named.surface;
      for (auto& p : surface.vertices) {
        for (double& x : p) x = std::ldexp(x, power);
      }
      for (double& x : surface.vertices.front()) {
        if (x == 0) x = 0x1p-1074;
      }
      const Result result = delmesher::tetrahedralize(surface, default_options());
      EXPECT_NE(result.status.code, StatusCode::internal_error) << result.status.message;
      limits += result.status.limit == delmesher::Limit::precision ? 1 : 0;
    }
  }
  EXPECT_GT(limits, 0U);
}

// Where doubles have all vertices, in other units it is the same mesh.
TEST(ExtremeSizes, AreMeshedAlike) {
  const Surface cube = samples::to_surface(samples::cube().input);
  std::vector<Options> choices(4);
  choices[0] = default_options();
  choices[1].surface = delmesher::SurfaceChoice::keep;
  choices[2].regions = delmesher::Regions::all;
  choices[3].tolerance = 0.01;
  for (std::size_t n = 0; n < choices.size(); ++n) {
    SCOPED_TRACE(n);
    const Result expected = delmesher::tetrahedralize(cube, choices[n]);
    ASSERT_TRUE(expected.status.ok()) << expected.status.message;
    for (const int power : {-970, -865, -701, -300, 300, 865, 1000}) {
      SCOPED_TRACE(power);
      const auto scaled = [&](std::vector<std::array<double, 3>> points) {
        for (auto& p : points) {
          for (double& x : p) x = std::ldexp(x, power);
        }
        return points;
      };
      Surface surface = cube;
      surface.vertices = scaled(cube.vertices);
      Options options = choices[n];
      options.tolerance = std::ldexp(options.tolerance, power);
      const Result result = delmesher::tetrahedralize(surface, options);
      ASSERT_TRUE(result.status.ok()) << result.status.message;
      EXPECT_EQ(result.mesh.vertices, scaled(expected.mesh.vertices));
      EXPECT_EQ(result.mesh.tetrahedra, expected.mesh.tetrahedra);
    }
  }
}

}  // namespace
}  // namespace tetproof::pipeline_test
