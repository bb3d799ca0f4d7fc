// The record and the file: same mesh, promises, sidecars, rounding, repairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "mesher/cli/test_option_values.h"
#include "mesher/delmesher/option_table.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/sidecar.h"
#include "oracles/improvement/local_operations.h"
#include "oracles/record/same_mesh.h"
#include "oracles/verdict/promise.h"
#include "oracles/verify.h"
#include "property_tests/oracle_units/helpers.h"
#include "property_tests/samples.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT

// The boundary that delmesher lists tiles the surface; faces of the hull do not belong to it.
TEST(SameMesh, FacesOfTheHullAreNoBoundary) {
  delmesher::ExactRecord record;
  record.points =
      explicit_points(std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  record.mesh_vertices = {0, 1, 2, 3};
  record.final = {{{0, 1, 2, 3}, true}};
  record.final_facets = {{1, 2, 3, 7}};
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  mesh.regions = {1};
  const auto violations = [&](const std::vector<Face>& boundary, Index facet = 7) {
    mesh.boundary = boundary;
    mesh.facets.assign(boundary.size(), facet);
    Promise promise;
    promise.region = delmesher::Region::hull;
    return check_same_mesh(mesh, record, promise, {}).violations;
  };
  EXPECT_EQ(violations({{1, 2, 3}}), 0U);
  EXPECT_EQ(violations({{3, 1, 2}}), 0U);
  EXPECT_EQ(violations({{2, 1, 3}}), 1U);
  EXPECT_EQ(violations({{1, 2, 3}}, 0), 1U);
  EXPECT_EQ(violations({}), 1U);
  for (const Face& face : {Face{0, 3, 2}, {0, 1, 3}, {0, 2, 1}}) {
    EXPECT_EQ(violations({{1, 2, 3}, face}), 1U);
  }
}

// A double pyramid in the record as three tetrahedra around its axis, in the file as two; another
// one beside it.
TEST(SameMesh, OnlyARepairOfItsOwnExcusesAChange) {
  delmesher::ExactRecord record;
  MeshFile mesh;
  std::vector<Position> places;
  const auto add = [&](double x, bool spoilt) {
    const auto at = static_cast<Index>(places.size());
    for (const Position& p : {Position{2, 0, 0}, {-1, 2, 0}, {-1, -2, 0}, {0, 0, 1}, {0, 0, -1}}) {
      places.push_back({p[0] + x, p[1], p[2]});
      mesh.vertices.push_back(places.back());
    }
    // As written the axis meets an edge of the base, so one of the three is flat.
    if (spoilt) mesh.vertices.back() = {1 + x, 2, -1};
    for (Index i = 0; i < 3; ++i) {
      record.refined.push_back({{at + i, at + (i + 1) % 3, at + 4, at + 3}, true});
    }
    mesh.tetrahedra.push_back({at, at + 1, at + 2, at + 3});
    mesh.tetrahedra.push_back({at, at + 2, at + 1, at + 4});
  };
  const auto violations = [&] {
    record.points = explicit_points(places);
    record.mesh_vertices.resize(places.size());
    std::iota(record.mesh_vertices.begin(), record.mesh_vertices.end(), 0U);
    mesh.regions.assign(mesh.tetrahedra.size(), 1);
    Promise promise;
    promise.approximate = true;
    return check_same_mesh(mesh, record, promise, {}).violations;
  };
  add(0, true);
  EXPECT_EQ(violations(), 0U);
  add(10, true);
  EXPECT_EQ(violations(), 0U);
  add(20, false);
  EXPECT_EQ(violations(), 5U);
}

// Formats without a region 0 have 2 for the outside; no other number is one, nor are both at once.
TEST(SameMesh, TheOutsideIsOneOfTwoRegions) {
  delmesher::ExactRecord record;
  record.points = explicit_points(
      std::vector<Position>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, -1}});
  record.mesh_vertices = {0, 1, 2, 3, 4, 5};
  record.final = {{{0, 1, 2, 3}, true}, {{1, 2, 3, 4}, false}, {{0, 2, 1, 5}, false}};
  MeshFile mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {0, 0, -1}};
  for (const auto& tet : record.final) mesh.tetrahedra.push_back(tet.vertices);
  Promise promise;
  promise.region = delmesher::Region::hull;
  const auto violations = [&](std::vector<std::int64_t> regions) {
    mesh.regions.assign(regions.begin(), regions.end());
    return check_same_mesh(mesh, record, promise, {}).violations;
  };
  EXPECT_EQ(violations({1, 0, 0}), 0U);
  EXPECT_EQ(violations({1, 2, 2}), 0U);
  EXPECT_EQ(violations({1, 0, 2}), 1U);
  EXPECT_EQ(violations({1, 3, 3}), 2U);
  EXPECT_EQ(violations({1, -1, -1}), 2U);
  EXPECT_EQ(violations({2, 2, 2}), 1U);
}

// The defaults are those of README's table of options.
TEST(Promises, AreReadFromCommandLines) {
  Promise p;
  EXPECT_EQ(parse_promise("", p), "");
  EXPECT_EQ(p.delta, 14.47);
  EXPECT_EQ(parse_promise("plane", p), "");
  EXPECT_EQ(p.delta, 20.7);
  for (const char* text : {"mesh --delta=3 --tau 0.5", "--delta 3 --tau=0.5"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_EQ(p.delta, 3) << text;
    EXPECT_EQ(p.tau, 0.5) << text;
    EXPECT_EQ(p.acute, 60) << text;
  }
  for (const char* text : {"--preset=paper --delta=3", "--delta 3 --preset paper"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_EQ(p.delta, 3) << text;
    EXPECT_EQ(p.acute, 90) << text;
    EXPECT_TRUE(p.gabriel) << text;
  }
  for (const char* text :
       {"--as-paper none", "--as-paper=order", "--as-paper steiner-point,order"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_EQ(p.acute, 60) << text;
    EXPECT_FALSE(p.link) << text;
  }
  for (const char* text : {"plane --preset paper", "plane --as-paper=steiner-point"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_FALSE(p.link) << text;
  }
  for (const char* text : {"--label-by-angle 30", "cdt --label-by-angle=30"}) {
    EXPECT_EQ(parse_promise(text, p), "") << text;
    EXPECT_EQ(p.label_by_angle, 30) << text;
  }
  EXPECT_EQ(parse_promise("cdt --order 2", p), "");
  EXPECT_TRUE(p.second_order);
  EXPECT_EQ(parse_promise("--order=1", p), "");
  EXPECT_FALSE(p.second_order);
  EXPECT_EQ(parse_promise("--regions core,block --max-edge=2,core=0.5", p), "");
  EXPECT_TRUE(p.all_regions && p.keep && !p.largest_region);
  EXPECT_EQ(p.region_names, std::vector<std::string>({"core", "block"}));
  EXPECT_EQ(p.max_edge, 2);
  EXPECT_EQ(p.region_sizes, (std::vector<std::pair<std::string, double>>{{"core", 0.5}}));
  EXPECT_EQ(parse_promise("--regions all --split-walls core|block,crack", p), "");
  EXPECT_EQ(p.split_wall_names, (std::vector<std::string>{"core|block", "crack"}));
  EXPECT_EQ(parse_promise("--regions all --split-walls all", p), "");
  EXPECT_TRUE(p.split_walls == Promise::Split::all && p.split_wall_names.empty());
  EXPECT_NE(parse_promise("--regions all --split-walls a,,b", p), "");
  EXPECT_EQ(parse_promise("--regions largest", p), "");
  EXPECT_TRUE(p.largest_region && p.region_names.empty());
  for (const char* text : {"--regions a,", "--regions a --max-edge 1,2", "--max-edge a=1",
                           "--regions all --max-edge a=0", "--regions all --max-edge =1"}) {
    EXPECT_NE(parse_promise(text, p), "") << text;
  }
  // The promises of a text are those of the same options.
  for (const std::string& name : delmesher::options::paper_choices<delmesher::Options>()) {
    delmesher::Options options;
    EXPECT_TRUE(delmesher::options::set(options, name, 1));
    const Promise q = promise_of(options);
    const std::string choice = delmesher::options::argument_name(name);
    EXPECT_EQ(parse_promise("--as-paper=" + choice, p), "") << choice;
    const auto choices = [](const Promise& x) {
      return std::tuple(x.link, x.bridges, x.kept_points, x.enrichment, x.filter_pairs,
                        x.filter_chamfered, x.no_guard);
    };
    EXPECT_EQ(choices(p), choices(q)) << choice;
    EXPECT_EQ(parse_promise("--preset paper", p), "");
    EXPECT_EQ(choices(p), choices(promise_of(delmesher::paper_options())));
    EXPECT_EQ(parse_promise("--preset paper --as-paper none", p), "");
    EXPECT_EQ(choices(p), choices(Promise{}));
  }
  for (const char* text : {"paper",
                           "--preset",
                           "mesh --preset",
                           "--preset=",
                           "--preset paperback",
                           "--delta",
                           "--delta=",
                           "--delta=3x",
                           "--nothing=3",
                           "--as-paper",
                           "--as-paper=",
                           "--as-paper order,",
                           "plane --as-paper order",
                           "plane --as-paper=bridges",
                           "--as-paper none,order",
                           "--as-paper all,order",
                           "--as-paper orders",
                           "--label-by-angle 0",
                           "--label-by-angle 90.1",
                           "improve --label-by-angle 30",
                           "--order 3",
                           "--order 1.5",
                           "plane --order 2"}) {
    EXPECT_NE(parse_promise(text, p), "") << text;
  }
}

// The mesher's table and the oracles' own: the same names in the same jobs, and the same promises.
struct JobOptions {
  std::string job;
  std::vector<delmesher::options::Value> values;
};
std::vector<JobOptions> jobs_with_promises() {
  using delmesher::options::values_of;
  return {{"mesh", values_of(delmesher::Options())},
          {"cdt", values_of(delmesher::CdtOptions())},
          {"plane", values_of(delmesher::PlaneOptions())},
          {"improve", values_of(delmesher::ImproveOptions())}};
}

auto members(const Promise& p) {
  return std::tuple(std::tuple(p.delta, p.tau, p.planar, p.acute, p.corner, p.gabriel,
                               p.approximate, p.improve, p.region, p.chamfer_radius, p.max_edge,
                               p.size_field.size(), p.size_growth, p.budget, p.max_vertices, p.keep,
                               p.may_keep, p.strict, p.tolerance, p.feature, p.split_walls),
                    std::tuple(p.link, p.bridges, p.steiner_point, p.kept_points, p.enrichment,
                               p.filter_pairs, p.filter_chamfered, p.no_guard));
}

std::string argument(const delmesher::options::Value& option, const std::string& sizes) {
  const std::string name = delmesher::options::argument_name(option.text.name);
  if (option.is_paper()) return " --as-paper " + name;
  if (option.kind == delmesher::options::Kind::sources) return " --" + name + " " + sizes;
  return " --" + name + " " + delmesher::cli::another_value(option).first;
}

TEST(Promises, KnowTheOptionsOfEveryJobAndWhatTheyPromise) {
  const std::string sizes = testing::TempDir() + "promised_sizes.txt";
  std::ofstream(sizes) << "0 0 0 1\n";
  for (const JobOptions& job : jobs_with_promises()) {
    Promise none, all;
    EXPECT_EQ(parse_promise(job.job, none), "");
    for (const delmesher::options::Value& option : job.values) {
      Promise one;
      const std::string text = job.job + argument(option, sizes);
      EXPECT_EQ(parse_promise(text, one), "") << text;
      EXPECT_EQ(members(one) != members(none), option.text.promised) << text;
    }
    for (const JobOptions& other : jobs_with_promises()) {
      for (const delmesher::options::Value& option : other.values) {
        const bool known = std::any_of(job.values.begin(), job.values.end(), [&](const auto& mine) {
          return mine.text.name == option.text.name;
        });
        const std::string text = job.job + argument(option, sizes);
        if (known) continue;
        EXPECT_NE(parse_promise(text, all), "") << text;
      }
    }
  }
}

// What delmesher would not take as its options, either; the message names the option.
TEST(Promises, AreRefusedByName) {
  struct Wrong {
    const char *text, *name;
  };
  for (const auto& [text, name] :
       std::initializer_list<Wrong>{{"--delta 14 --delta 1", "--delta"},
                                    {"--delta=14 --delta=14", "--delta"},
                                    {"--gabriel --gabriel", "--gabriel"},
                                    {"-q -q", "-q"},
                                    {"--preset paper --preset paper", "--preset"},
                                    {"--improve on --improve off", "--improve"},
                                    {"--gabriel=no", "--gabriel"},
                                    {"--delta 0", "--delta"},
                                    {"--delta 31", "--delta"},
                                    {"--delta 0x10", "--delta"},
                                    {"--delta inf", "--delta"},
                                    {"--delta nan", "--delta"},
                                    {"--delta --tau", "--delta"},
                                    {"--acute 91", "--acute"},
                                    {"--planar -1", "--planar"},
                                    {"--planar automatic", "--planar"},
                                    {"--max-edge 0", "--max-edge"},
                                    {"--max-edge -1", "--max-edge"},
                                    {"--tolerance 0", "--tolerance"},
                                    {"--tolerance -1", "--tolerance"},
                                    {"--tolerance 0d", "--tolerance"},
                                    {"--tolerance 0.11d", "--tolerance"},
                                    {"--tolerance d", "--tolerance"},
                                    {"--tolerance 1 --exact a", "--tolerance"},
                                    {"--tolerance 1 --regions all", "--tolerance"},
                                    {"cdt --tolerance 1", "--tolerance"},
                                    {"--feature 91", "--feature"},
                                    {"--size-growth 0", "--size-growth"},
                                    {"--size-growth 1.5", "--size-growth"},
                                    {"--size-field /nowhere/a.txt", "/nowhere/a.txt"},
                                    {"--size-field=", "--size-field"},
                                    {"cdt --size-field a", "--size-field"},
                                    {"--chamfer-radius 0", "--chamfer-radius"},
                                    {"--budget 0", "--budget"},
                                    {"--max-vertices 1e10", "--max-vertices"},
                                    {"--threads many", "--threads"},
                                    {"--time-limit 0", "--time-limit"},
                                    {"--slivers maybe", "--slivers"},
                                    {"--region inside", "--region"},
                                    {"-o", "-o"},
                                    {"--names=", "--names"},
                                    {"cdt --delta 14", "--delta"},
                                    {"cdt --gabriel", "--gabriel"},
                                    {"cdt --planar auto", "--planar"},
                                    {"plane --corner 20", "--corner"},
                                    {"plane --gabriel", "--gabriel"},
                                    {"plane --acute 59", "--acute"},
                                    {"plane --delta 35", "--delta"},
                                    {"plane --threads 2", "--threads"}}) {
    Promise p;
    EXPECT_TRUE(parse_promise(text, p).starts_with(name)) << text << ": " << parse_promise(text, p);
  }
  for (const char* text :
       {"-o a.mesh -o b.vtu -q --stats s --threads 0", "cdt --region interior --names n --jobs 2",
        "plane --delta 34 --acute 90 --save-chamfered c.poly", "--max-edge 1e-300 --budget 1"}) {
    Promise p;
    EXPECT_EQ(parse_promise(text, p), "") << text;
  }
}

TEST(Sidecars, OfNoVersionAreRefusedForThat) {
  for (const char* version : {"0", "99"}) {
    std::string said = "nothing";
    try {
      read_sidecar(written("version.exact", std::string("delmesher-exact ") + version + "\n"));
    } catch (const ReadError& error) {
      said = error.what();
    }
    EXPECT_NE(said.find(version == std::string("0") ? "unknown version 0" : "99"),
              std::string::npos)
        << said;
  }
}

// The distance of a written vertex from its place is measured, not only compared.
TEST(Rounding, TheLargestDistanceIsSaid) {
  const samples::ExactSample sample = samples::exact_sample();
  const ExactPoints points = [&] {
    ExactPoints result;
    EXPECT_EQ(result.assign(sample.exact.points), "");
    return result;
  }();
  MeshFile mesh = sample.sample.mesh;
  const auto largest = [&] {
    const OracleReport report =
        check_rounding(mesh, sample.exact, points, {.ulp = 0x1p-52, .allowed = 0.5});
    EXPECT_EQ(report.violations, 0U);
    EXPECT_EQ(report.checked, mesh.vertices.size());
    EXPECT_EQ(report.figures.at(0).first, "largest distance");
    return report.figures.at(0).second;
  };
  EXPECT_EQ(largest(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const double was = mesh.vertices[1][axis];
    mesh.vertices[1][axis] += 0.25;
    EXPECT_NEAR(largest(), 0.25, 1e-15) << axis;
    mesh.vertices[1][axis] = was;
  }
}

// Every vertex of the last mesh and every tetrahedron of that before repairs is looked at.
TEST(Repairs, AllIsCounted) {
  samples::ExactSample sample = samples::exact_sample();
  sample.exact.unrepaired = sample.exact.final;
  ExactPoints points;
  ASSERT_EQ(points.assign(sample.exact.points), "");
  const auto run = [&] { return check_repairs(sample.exact, points, Promise()); };
  OracleReport report = run();
  EXPECT_EQ(report.checked, 6U + 4U);
  EXPECT_EQ(report.violations, 0U);
  EXPECT_EQ(report.figure("tetrahedra changed"), 0);
  EXPECT_EQ(report.figure("not positive on doubles"), 0);
  // An inverted tetrahedron is not positive; the last mesh lacks it.
  std::swap(sample.exact.unrepaired[1].vertices[0], sample.exact.unrepaired[1].vertices[1]);
  sample.exact.final.erase(sample.exact.final.begin() + 1);
  report = run();
  EXPECT_EQ(report.checked, 6U + 4U);
  EXPECT_EQ(report.violations, 0U);
  EXPECT_EQ(report.figure("tetrahedra changed"), 1);
  EXPECT_EQ(report.figure("not positive on doubles"), 1);
  EXPECT_EQ(report.figure("edges from there"), 0);
  // A point that no tetrahedron had came with the repairs.
  sample.exact.final = sample.exact.unrepaired;
  sample.exact.unrepaired = {sample.exact.final[0]};
  EXPECT_GT(run().violations, 0U);
}

// Squares and volumes of lengths of 1e-165 and 1e120 are not doubles.
TEST(Units, TheVerdictIsTheSameInAll) {
  delmesher::Surface surface = samples::random_voxels(3);
  for (auto& p : surface.vertices) {
    p = {p[0] * 0.8 - p[1] * 0.6, p[0] * 0.6 + p[1] * 0.8, p[2] + 0.1 * p[0]};
  }
  double deviation = 0;
  for (const int power : {0, -548, 400}) {
    delmesher::Surface scaled = surface;
    for (auto& p : scaled.vertices) {
      for (double& x : p) x = std::ldexp(x, power);
    }
    delmesher::CdtOptions options;
    options.want_exact = true;
    options.region = delmesher::Region::interior;
    delmesher::Result result = delmesher::constrained_delaunay(scaled, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    VerifyOptions wanted;
    wanted.promised = promise_of(options);
    if (power != 0) wanted.sidecar = "is not read in other units";
    VerifyReport report;
    ASSERT_EQ(verify(samples::to_polyhedron(scaled), samples::to_mesh(result.mesh), &result.exact,
                     wanted, report),
              "");
    EXPECT_EQ(report.verdict, Verdict::rounded) << power << "\n" << to_text(report);
    EXPECT_GT(report.deviation, 0);
    if (power == 0) deviation = report.deviation;
    EXPECT_EQ(report.deviation, std::ldexp(deviation, power));
    if (const OracleReport* kernel = report.find("exact-second-kernel")) {
      EXPECT_EQ(
          std::ranges::count(kernel->notes, "the text of the points was not read a second time"),
          power == 0 ? 0 : 1);
    }
    for (const double damage : {1e-3, 2.0}) {
      delmesher::TetMesh moved = result.mesh;
      moved.vertices[0][0] += std::ldexp(damage, power);
      ASSERT_EQ(verify(samples::to_polyhedron(scaled), samples::to_mesh(moved), &result.exact,
                       wanted, report),
                "");
      EXPECT_EQ(report.verdict, Verdict::broken) << power;
    }
  }
}

// Lengths are promised in the input's units, whatever the oracles measure in.
TEST(Units, PromisedLengthsAreTheSameInAll) {
  for (const int power : {0, -548, 400}) {
    delmesher::Surface surface = samples::to_surface(samples::cube().input);
    for (auto& p : surface.vertices) {
      for (double& x : p) x = std::ldexp(x, power);
    }
    delmesher::Options options;
    options.want_exact = true;
    options.max_edge = std::ldexp(0.6, power);
    options.size_field = {{surface.vertices[0], std::ldexp(0.3, power)}};
    const delmesher::Result result = delmesher::tetrahedralize(surface, options);
    ASSERT_TRUE(result.status.ok()) << result.status.message;
    const auto verdict = [&](const Promise& promise) {
      VerifyReport report;
      EXPECT_EQ(verify(samples::to_polyhedron(surface), samples::to_mesh(result.mesh),
                       &result.exact, {.promised = promise}, report),
                "");
      return report;
    };
    const VerifyReport good = verdict(promise_of(options));
    EXPECT_TRUE(samples::as_promised(good)) << power << "\n" << to_text(good);
    Promise shorter = promise_of(options);
    shorter.max_edge /= 4;
    EXPECT_EQ(verdict(shorter).verdict, Verdict::broken) << power;
    Promise smaller = promise_of(options);
    smaller.size_field[0].size /= 8;
    EXPECT_EQ(verdict(smaller).verdict, Verdict::broken) << power;
    Promise elsewhere = promise_of(options);
    elsewhere.size_field[0].point = surface.vertices.back();
    EXPECT_EQ(verdict(elsewhere).verdict, Verdict::broken) << power;
  }
}

// What is given up during a verification is what no oracle needs any more, whatever the number of
// threads: the report is the same.
void expect_the_same_report(const delmesher::Surface& surface, delmesher::Options options) {
  options.want_exact = true;
  const delmesher::Result result = delmesher::tetrahedralize(surface, options);
  ASSERT_TRUE(result.status.ok()) << result.status.message;
  const Polyhedron input = samples::to_polyhedron(surface);
  VerifyOptions wanted;
  wanted.promised = promise_of(options);
  wanted.stage = options.approximate ? Stage::refined : Stage::both;
  VerifyReport kept;
  ASSERT_EQ(verify(input, samples::to_mesh(result.mesh), &result.exact, wanted, kept), "");
  for (const unsigned threads : {1U, 4U}) {
    wanted.threads = threads;
    MeshFile mesh = samples::to_mesh(result.mesh);
    delmesher::ExactRecord record = result.exact;
    VerifyReport discarded;
    ASSERT_EQ(verify(input, mesh, &record, wanted, discarded, {&mesh, &record}), "");
    EXPECT_EQ(to_text(discarded), to_text(kept));
    EXPECT_TRUE(mesh.tetrahedra.empty() && mesh.vertices.empty());
    EXPECT_TRUE(record.refined.empty() && record.refined_facets.empty());
    EXPECT_TRUE(record.segments.empty() && record.balls.empty());
    EXPECT_TRUE(record.final.empty() && record.final_facets.empty());
    EXPECT_TRUE(record.unrepaired.empty());
  }
}

// A surface that is made planar, with chamfers.
TEST(Discarded, TheReportIsTheSame) {
  delmesher::Surface turned = samples::to_surface(samples::l_shape().input);
  for (auto& p : turned.vertices) {
    p = {p[0] * 0.8 - p[1] * 0.6, p[0] * 0.6 + p[1] * 0.8, p[2] + 0.1 * p[0]};
  }
  delmesher::Options hull, unimproved, approximate, as_given;
  hull.region = delmesher::Region::hull;
  unimproved.improve = false;
  approximate.approximate = true;
  as_given.planar = 0;
  as_given.acute = as_given.corner = 90;
  for (const delmesher::Options& options :
       {delmesher::Options{}, hull, unimproved, approximate, as_given}) {
    expect_the_same_report(turned, options);
  }
}

}  // namespace
}  // namespace tetproof
