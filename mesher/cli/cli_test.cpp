#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mesher/cli/arguments.h"
#include "mesher/cli/progress.h"
#include "mesher/cli/reports.h"
#include "mesher/cli/run.h"
#include "mesher/cli/signals.h"

namespace delmesher::cli {
namespace {

namespace fs = std::filesystem;

Parsed parse(std::vector<std::string> arguments) {
  return parse_arguments(std::move(arguments));
}

void expect_usage_error(std::vector<std::string> arguments, const std::string& text = "") {
  const Parsed parsed = parse(std::move(arguments));
  EXPECT_FALSE(parsed.run) << text;
  EXPECT_EQ(parsed.exit_code, kUsage) << text;
  EXPECT_TRUE(parsed.error.starts_with("delmesher: ")) << parsed.error;
  EXPECT_EQ(std::count(parsed.error.begin(), parsed.error.end(), '\n'), 1) << parsed.error;
  EXPECT_NE(parsed.error.find(text), std::string::npos) << parsed.error;
}

TEST(Arguments, DefaultsAreTheLibrarys) {
  const Parsed parsed = parse({"in.off", "-o", "out.mesh"});
  ASSERT_TRUE(parsed.run) << parsed.error;
  const Options defaults;
  EXPECT_EQ(parsed.command.job, Job::mesh);
  EXPECT_EQ(parsed.command.input, "in.off");
  EXPECT_EQ(parsed.command.outputs, std::vector<std::string>({"out.mesh"}));
  EXPECT_EQ(parsed.command.options.delta, defaults.delta);
  EXPECT_EQ(parsed.command.options.tau, defaults.tau);
  EXPECT_EQ(parsed.command.options.acute, defaults.acute);
  EXPECT_EQ(parsed.command.options.region, Region::interior);
  EXPECT_TRUE(parsed.command.options.improve);
  EXPECT_FALSE(parsed.command.options.slivers);
  EXPECT_TRUE(parsed.command.options.simplify_bridges);
  EXPECT_FALSE(parsed.command.options.want_exact);
}

TEST(Arguments, AllOptions) {
  const Parsed parsed = parse({"mesh",
                               "in.off",
                               "-o",
                               "a.mesh",
                               "-o",
                               "b.vtu",
                               "--delta",
                               "12.5",
                               "--tau",
                               "0",
                               "--acute",
                               "45",
                               "--slivers",
                               "off",
                               "--approximate",
                               "--chamfer-radius",
                               "0.25",
                               "--max-edge",
                               "3",
                               "--region",
                               "hull",
                               "--max-vertices",
                               "1000",
                               "--time-limit",
                               "2.5",
                               "--threads",
                               "3",
                               "--stats",
                               "s.json",
                               "--save-chamfered",
                               "c.off",
                               "--exact",
                               "e.txt",
                               "--no-bridge-simplification",
                               "-v"});
  ASSERT_TRUE(parsed.run) << parsed.error;
  const Options& o = parsed.command.options;
  EXPECT_EQ(parsed.command.outputs, std::vector<std::string>({"a.mesh", "b.vtu"}));
  EXPECT_EQ(o.delta, 12.5);
  EXPECT_EQ(o.tau, 0);
  EXPECT_EQ(o.acute, 45);
  EXPECT_FALSE(o.slivers);
  EXPECT_TRUE(o.approximate);
  EXPECT_EQ(o.chamfer_radius, 0.25);
  EXPECT_EQ(o.max_edge, 3);
  EXPECT_EQ(o.region, Region::hull);
  EXPECT_EQ(o.max_vertices, 1000U);
  EXPECT_EQ(o.time_limit_seconds, 2.5);
  EXPECT_EQ(o.threads, 3U);
  EXPECT_FALSE(o.simplify_bridges);
  EXPECT_TRUE(o.want_exact && o.want_chamfered);
  EXPECT_TRUE(parsed.command.verbose);
}

TEST(Arguments, ExplicitOptionsOverrideThePresetInAnyOrder) {
  const Options paper = parse({"i.off", "-o", "o.mesh", "--preset", "paper"}).command.options;
  EXPECT_EQ(paper.threads, 1U);
  EXPECT_EQ(paper.acute, 90);
  EXPECT_EQ(paper.tau, 1e-4);
  EXPECT_EQ(paper.delta, 14.47);
  EXPECT_EQ(paper.region, Region::hull);
  const Options mixed = parse({"i.off", "-o", "o.mesh", "--tau", "0", "--region", "interior",
                               "--preset", "paper", "--acute", "70"})
                            .command.options;
  EXPECT_EQ(mixed.acute, 70);
  EXPECT_EQ(mixed.tau, 0);
  EXPECT_EQ(mixed.delta, 14.47);
  EXPECT_EQ(mixed.region, Region::interior);
}

TEST(Arguments, WhatIsDoneAsThePaperSays) {
  const auto choices = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"i.off", "-o", "o.mesh"});
    return parse(more).command.options.as_paper;
  };
  AsPaper all;
  for (const NamedChoice& choice : kPaperChoices) {
    AsPaper alone;
    alone.*choice.member = all.*choice.member = true;
    EXPECT_EQ(choices({"--as-paper", choice.name}), alone) << choice.name;
  }
  EXPECT_EQ(choices({}), AsPaper{});
  EXPECT_EQ(choices({"--as-paper", "steiner-point,order"}),
            (AsPaper{.order = true, .steiner_point = true}));
  EXPECT_EQ(choices({"--as-paper", "all"}), all);
  EXPECT_EQ(choices({"--preset", "paper"}), all);
  EXPECT_EQ(choices({"--as-paper", "steiner-point", "--preset", "paper"}),
            AsPaper{.steiner_point = true});
  EXPECT_EQ(choices({"--preset", "paper", "--as-paper", "none"}), AsPaper{});
  for (const char* wrong : {"", "order,", "none,order", "all,order", "Order"}) {
    expect_usage_error({"i.off", "-o", "o.mesh", std::string("--as-paper=") + wrong});
  }
}

TEST(Reports, LimitsThatStruckHaveALineEach) {
  EXPECT_TRUE(limits_texts({}).empty());
  Statistics s;
  s.guard_stops = 2;
  s.fallback_corners = 5;
  s.guaranteed_acute = 60;
  s.refinement_capped = true;
  s.cdt_restarts = 1;
  s.rounding_thinned = 7;
  const std::vector<std::string> texts = limits_texts(s);
  ASSERT_EQ(texts.size(), 4U);
  EXPECT_NE(texts[0].find("2 times"), std::string::npos);
  EXPECT_NE(texts[0].find("5 corners"), std::string::npos);
  EXPECT_NE(texts[3].find("7 points"), std::string::npos);
  s.guaranteed_acute = 90;
  EXPECT_NE(limits_texts(s)[0].find("all corners"), std::string::npos);
}

TEST(Arguments, OtherJobs) {
  const Parsed cdt = parse({"cdt", "in.off", "-o", "out.tet"});
  EXPECT_TRUE(cdt.run);
  EXPECT_EQ(cdt.command.job, Job::cdt);
  EXPECT_EQ(cdt.command.options.region, Region::hull);
  EXPECT_EQ(parse({"cdt", "i.off", "-o", "o.tet", "--region", "interior"}).command.options.region,
            Region::interior);
  const Parsed check = parse({"check", "in.off", "--json", "--acute", "90"});
  EXPECT_TRUE(check.run);
  EXPECT_TRUE(check.command.json);
  EXPECT_EQ(check.command.options.acute, 90);
  const Parsed plane = parse({"plane", "in.poly", "-o", "out.svg", "--preset", "paper"});
  EXPECT_TRUE(plane.run);
  EXPECT_EQ(plane.command.job, Job::plane);
  EXPECT_EQ(plane.command.options.delta, plane_options().delta);
  EXPECT_EQ(plane.command.options.acute, 90);
  EXPECT_EQ(plane.command.options.region, Region::hull);
  EXPECT_EQ(parse({"plane", "i.off", "-o", "o.node"}).command.options.acute, 60);
  expect_usage_error({"plane", "in.poly", "-o", "out.mesh"},
                     "out.mesh: unknown mesh format (.node, .vtu, .off, .msh or .svg)");
  expect_usage_error({"plane", "in.poly", "-o", "out.svg", "--acute", "30"}, "out of range");
  expect_usage_error({"plane", "in.poly", "-o", "in.node"}, "same as the input");
  expect_usage_error({"plane"}, "required");
}

TEST(Arguments, OfImprove) {
  const Parsed parsed = parse({"improve", "in.msh", "-o", "a.mesh", "-o", "b.vtu", "--delta", "10",
                               "--max-edge", "2", "--max-vertices", "9", "--time-limit", "3"});
  ASSERT_TRUE(parsed.run) << parsed.error;
  EXPECT_EQ(parsed.command.job, Job::improve);
  EXPECT_EQ(parsed.command.outputs, std::vector<std::string>({"a.mesh", "b.vtu"}));
  EXPECT_EQ(parsed.command.options.delta, 10);
  EXPECT_EQ(parsed.command.options.max_edge, 2);
  EXPECT_EQ(parsed.command.options.max_vertices, 9U);
  EXPECT_TRUE(parse({"improve", "in.node", "-o", "a.node"}).run);
  expect_usage_error({"improve", "in.mesh"}, "--output");
  expect_usage_error({"improve", "in.mesh", "-o", "in.mesh"}, "same as the input");
  for (const char* input : {"in.node", "in.ele"}) {
    expect_usage_error({"improve", input, "-o", "in.node"}, "same as the input");
  }
  for (const char* other : {"--tau=1", "--exact=e", "--region=hull", "--acute=60"}) {
    expect_usage_error({"improve", "in.mesh", "-o", "a.mesh", other}, other);
  }
}

TEST(Arguments, HelpAndVersion) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"-h"}, {"mesh", "--help"}, {"--version"}}) {
    const Parsed parsed = parse(arguments);
    EXPECT_FALSE(parsed.run);
    EXPECT_EQ(parsed.exit_code, kDone);
    EXPECT_FALSE(parsed.out.empty());
    EXPECT_TRUE(parsed.error.empty());
  }
  EXPECT_NE(parse({"mesh", "--help"}).out.find("--chamfer-radius"), std::string::npos);
  EXPECT_EQ(parse({"--version"}).out, std::string("delmesher ") + version() + "\n");
}

TEST(Arguments, WhatIsMistypedIsNamedWithWhatMayBeMeant) {
  expect_usage_error({"--frobnicate", "cube.off"}, "'--frobnicate': no such option of mesh\n");
  expect_usage_error({"--detla", "3", "cube.off"},
                     "'--detla': no such option of mesh: did you mean --delta?");
  expect_usage_error({"in.off", "-o", "a.mesh", "--max-egde=2"}, "did you mean --max-edge?");
  expect_usage_error({"in.off", "-o", "a.mesh", "-x"}, "'-x': no such option of mesh");
  expect_usage_error({"improve", "a.msh", "--tau", "1"}, "'--tau': no such option of improve");
  expect_usage_error({"meshh", "cube.off"}, "no command or file 'meshh': did you mean mesh?");
  expect_usage_error({"chekc", "cube.off"}, "did you mean check?");
  // What stands where a value is expected is no option, and a file may be called like a command.
  expect_usage_error({"in.off", "-o", "a.mesh", "--delta", "-1"}, "out of range: -1");
  EXPECT_EQ(parse({"mesh", "meshes", "-o", "a.mesh"}).command.input, "meshes");
  expect_usage_error({"in.off", "-o", "a.mesh", "--tau", "2"},
                     "out of range: 2 (at least 0, at most 1)");
  expect_usage_error({"in.off", "-o", "a.mesh", "--max-edge", "0"}, "out of range: 0 (above 0)");
}

TEST(Arguments, HelpFitsAScreen) {
  const std::string help = parse({"--help"}).out;
  EXPECT_LE(std::count(help.begin(), help.end(), '\n'), 24) << help;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  EXPECT_NE(help.find("delmesher part.stl -o part.msh"), std::string::npos);
  for (const char* command : {"", "mesh", "cdt", "plane", "check", "improve"}) {
    std::vector<std::string> arguments = {"--help"};
    if (*command != '\0') arguments.insert(arguments.begin(), command);
    EXPECT_NE(parse(arguments).out.find("Exit codes: 0 done;"), std::string::npos) << command;
  }
}

TEST(Arguments, SeveralInputs) {
  const Parsed parsed =
      parse({"mesh", "in/a.stl", "in/b.c.stl", "-o", "out/{name}.msh", "-o", "{name}.vtu",
             "--stats", "{name}.json", "--names", "n.txt", "--jobs", "3"});
  ASSERT_TRUE(parsed.run) << parsed.error;
  EXPECT_EQ(parsed.jobs, 3U);
  ASSERT_EQ(parsed.batch.size(), 2U);
  EXPECT_EQ(parsed.batch[0].input, "in/a.stl");
  EXPECT_EQ(parsed.batch[0].outputs, (std::vector<std::string>{"out/a.msh", "a.vtu"}));
  EXPECT_EQ(parsed.batch[1].outputs, (std::vector<std::string>{"out/b.c.msh", "b.c.vtu"}));
  EXPECT_EQ(parsed.batch[1].stats_file, "b.c.json");
  EXPECT_TRUE(parse({"a.stl", "-o", "{name}.msh"}).batch.empty());
  EXPECT_EQ(parse({"a.stl", "-o", "{name}.msh"}).command.outputs[0], "a.msh");
  EXPECT_EQ(parse({"check", "a.stl", "b.stl"}).batch.size(), 2U);
  expect_usage_error({"a.stl", "b.stl", "-o", "one.msh"}, "one.msh: named twice");
  expect_usage_error({"a.stl", "x/a.obj", "-o", "{name}.msh"}, "a.msh: named twice");
  expect_usage_error({"a.stl", "b.stl", "-o", "-.msh"}, "standard output");
}

TEST(Arguments, StandardStreams) {
  const Parsed parsed = parse({"-", "-o", "-.vtu", "--stats", "s.json"});
  ASSERT_TRUE(parsed.run) << parsed.error;
  EXPECT_EQ(parsed.command.input, "-");
  EXPECT_EQ(parsed.command.outputs[0], "-.vtu");
  expect_usage_error({"a.off", "-o", "-"}, "unknown mesh format");
  expect_usage_error({"a.off", "-o", "-.vtu", "--stats", "-"}, "standard output can take one file");
  expect_usage_error({"a.off", "-o", "-.node"}, "standard output can take one file");
}

TEST(Arguments, MistakesAreTwo) {
  expect_usage_error({});
  expect_usage_error({"in.off"}, "--output");
  expect_usage_error({"-o", "out.mesh"}, "input");
  expect_usage_error({"in.off", "-o", "out.xyz"},
                     "out.xyz: unknown mesh format (.mesh, .msh, .vtu, .vtk, .xdmf");
  EXPECT_EQ(parse({"in.off", "-o", "a.inp", "--names", "n.txt"}).command.names_file, "n.txt");
  expect_usage_error({"in.off", "-o", "a.stl", "--names", "a.stl"}, "named twice");
  for (const char* none : {"--max-vertices", "--budget", "--time-limit", "--max-edge"}) {
    expect_usage_error({"in.off", "-o", "a.mesh", none, "0"}, "out of range: 0");
  }
  expect_usage_error({"in.off", "-o", "a.mesh", "--threads", "1025"}, "out of range: 1025");
  expect_usage_error({"in.off", "-o", "out"}, "unknown mesh format");
  expect_usage_error({"in.off", "-o", "a.mesh", "-o", "./a.mesh"}, "named twice");
  expect_usage_error({"in.off", "-o", "a.node", "--stats", "a.ele"}, "named twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "--save-chamfered", "in.off"}, "named twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "--bogus"}, "--bogus");
  expect_usage_error({"in.off", "other.off", "-o", "a.mesh"}, "named twice");
  expect_usage_error({"check"});
  expect_usage_error({"check", "in.off", "-o", "a.mesh"});
  for (const char* bad : {"nan", "inf", "-1", "x", "1e400", "", "61", "0"}) {
    expect_usage_error({"in.off", "-o", "a.mesh", std::string("--delta=") + bad});
  }
  for (const char* bad : {"-0.1", "1.5", "nan"}) {
    expect_usage_error({"in.off", "-o", "a.mesh", std::string("--tau=") + bad});
  }
  expect_usage_error({"in.off", "-o", "a.mesh", "--acute=91"});
  expect_usage_error({"in.off", "-o", "a.mesh", "--slivers=maybe"});
  expect_usage_error({"in.off", "-o", "a.mesh", "--region=all"});
  expect_usage_error({"in.off", "-o", "a.mesh", "--preset=mine"});
  expect_usage_error({"in.off", "-o", "a.mesh", "--max-vertices=0"});
  expect_usage_error({"in.off", "-o", "a.mesh", "--time-limit=0"});
  for (const char* bad : {"-1", "2000", "many"}) {
    expect_usage_error({"in.off", "-o", "a.mesh", std::string("--threads=") + bad});
  }
  expect_usage_error({"in.off", "-o", "a.mesh", "-q", "-v"});
}

// A folder with an input, and a library that answers what the test wants.
class Run : public testing::Test {
 protected:
  Run() {
    folder_ = fs::temp_directory_path() /
              ("delmesher_cli_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(path("in.off"))
        << "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
    answer_.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    answer_.mesh.tetrahedra = {{0, 1, 2, 3}};
    answer_.mesh.inside = {1};
    library_.tetrahedralize = [this](const Surface&, const Options& options) {
      ++calls_;
      if (options.progress) options.progress({Phase::refine, 0.5, 10});
      return answer_;
    };
    library_.constrained_delaunay = library_.tetrahedralize;
    library_.check_surface = [this](const Surface&, const Options&) { return report_; };
    streams_.out = [this](const std::string& text) { out_ += text; };
    streams_.error = [this](const std::string& text) { error_ += text; };
  }
  ~Run() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  int go(std::vector<std::string> arguments) {
    out_.clear();
    error_.clear();
    const Parsed parsed = parse(std::move(arguments));
    EXPECT_TRUE(parsed.run) << parsed.error;
    return run(parsed.command, library_, streams_);
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  bool one_error_line() const {
    return error_.starts_with("delmesher: ") && std::count(error_.begin(), error_.end(), '\n') == 1;
  }

  fs::path folder_;
  Result answer_;
  SurfaceReport report_;
  Library library_;
  Streams streams_;
  std::string out_, error_;
  int calls_ = 0;
};

TEST_F(Run, WritesEveryOutputAndIsSilent) {
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-o", path("a.node"), "--stats",
                path("s.json"), "--exact", path("e.txt"), "--save-chamfered", path("c.off")}),
            kDone);
  EXPECT_EQ(out_ + error_, "");
  EXPECT_EQ(files(), 8U);
  EXPECT_EQ(go({path("in.off"), "-v", "-o", path("b.tet")}), kDone);
  EXPECT_NE(error_.find("refine "), std::string::npos);
  EXPECT_NE(error_.find("b.tet: 4 vertices, 1 tetrahedra"), std::string::npos);
}

TEST_F(Run, EndsWithALineOfQualityUnlessQuiet) {
  MeshStatistics& s = answer_.statistics.final;
  s.tetrahedra = 1;
  s.min_dihedral = 54.736;
  s.max_dihedral = 90;
  s.min_face_angle = 45;
  s.gamma_1_percent = s.mean_gamma = 0.7320508;
  s.min_gamma = 2e-10;
  s.below_5 = 3;
  s.sharpest_dihedral = {1, 2, 0, 3};
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_EQ(error_, path("a.mesh") +
                        ": 1 tetrahedra, dihedral angles 54.74 to 90.00 degrees, smallest face "
                        "angle 45.00, gamma 0.732 / 0.732 / 2e-10 (1 % / mean / smallest), 3 below "
                        "5 degrees, the worst at (0.5, 0.5, 0)\n");
  EXPECT_EQ(go({"cdt", path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find(": 1 tetrahedra, dihedral"), std::string::npos);
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-q"}), kDone);
  EXPECT_EQ(error_, "");
  answer_.statistics.rounding_inverted = 1;  // what failed is said at the very end
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kFailed);
  EXPECT_NE(error_.find("(0.5, 0.5, 0)\ndelmesher: "), std::string::npos) << error_;
}

// The tetrahedron in the corner of a cube, squeezed to a height of 0.001, as its own mesh, and as a
// mesh of something larger.
TEST_F(Run, WarnsOfSmallAnglesAndSaysWhetherTheInputForcesThem) {
  answer_.mesh.vertices[3] = {0, 0, 0.001};
  answer_.mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  answer_.mesh.boundary_facets = {0, 1, 2, 3};
  answer_.mesh.boundary_labels = {0, 0, 0, 0};
  MeshStatistics& s = answer_.statistics.final;
  s.tetrahedra = 1;
  s.min_dihedral = 0.081;
  s.min_face_angle = 0.0573;
  s.sharpest_dihedral = {1, 2, 0, 3};
  s.sharpest_face_angle = {1, 0, 3};
  const auto lines = [&] { return std::count(error_.begin(), error_.end(), '\n'); };
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_EQ(lines(), 3) << error_;
  const std::string start = "delmesher: " + path("in.off") + ": warning: the smallest ";
  EXPECT_TRUE(error_.starts_with(start + "face angle is 0.057 degrees, at (1, 0, 0), where the "
                                         "input has a corner of 0.057\n"))
      << error_;
  EXPECT_NE(
      error_.find(start + "dihedral angle is 0.081 degrees, at (0.5, 0.5, 0), where facets of "
                          "the input meet at 0.081\n"),
      std::string::npos)
      << error_;
  s.sharpest_face_angle = {4, 0, 3};  // a vertex on the sharp edge, in a face across
  answer_.mesh.vertices.push_back({0.5, 0.5, 0});
  answer_.mesh.tetrahedra = {{0, 1, 4, 3}, {0, 4, 2, 3}};
  answer_.mesh.inside = {1, 1};
  answer_.mesh.boundary = {{0, 2, 4}, {0, 4, 1}, {0, 1, 3}, {1, 4, 3}, {4, 2, 3}, {0, 3, 2}};
  answer_.mesh.boundary_facets = {0, 0, 1, 2, 2, 3};
  answer_.mesh.boundary_labels = std::vector<std::int32_t>(6);
  s.tetrahedra = 2;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_TRUE(error_.starts_with(start + "face angle is 0.057 degrees, at (0.5, 0.5, 0), where "
                                         "facets of the input meet at 0.081\n"))
      << error_;
  answer_.mesh.vertices.pop_back();
  answer_.mesh.tetrahedra = {{0, 1, 2, 3}};
  answer_.mesh.inside = {1};
  answer_.mesh.boundary = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  answer_.mesh.boundary_facets = {0, 1, 2, 3};
  answer_.mesh.boundary_labels = {0, 0, 0, 0};
  s.sharpest_face_angle = {1, 0, 3};
  s.tetrahedra = 1;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-q"}), kDone);
  EXPECT_EQ(error_, "");
  // No angles are promised of these.
  EXPECT_EQ(go({"cdt", path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_EQ(lines(), 1) << error_;
  // Less was asked for.
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "--delta", "0.05"}), kDone);
  EXPECT_EQ(error_.find("face angle is"), std::string::npos) << error_;

  // With a neighbour, the small angles are at no edge and no corner of the input.
  answer_.mesh.vertices.push_back({0.2, 0.2, -1});
  answer_.mesh.tetrahedra.push_back({0, 2, 1, 4});
  answer_.mesh.inside.push_back(1);
  answer_.mesh.boundary = {{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 4, 1}, {1, 4, 2}, {2, 4, 0}};
  answer_.mesh.boundary_facets = {1, 2, 3, 1, 2, 3};
  answer_.mesh.boundary_labels = std::vector<std::int32_t>(6);
  s.tetrahedra = 2;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("at (1, 0, 0), not the 14.47 asked for\n"), std::string::npos) << error_;
  EXPECT_NE(error_.find("at (0.5, 0.5, 0), and no edge of the input forces it there\n"),
            std::string::npos)
      << error_;
  // Facets that meet there, but at a much larger angle.
  answer_.mesh.boundary_facets = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("and no edge of the input forces it there\n"), std::string::npos);
}

TEST_F(Run, ImproveSaysWhatThereWasBefore) {
  std::ofstream(path("in.tet")) << "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n";
  TetMesh given;
  library_.improve_mesh = [&](const TetMesh& mesh, const Options&) {
    given = mesh;
    return answer_;
  };
  MeshStatistics &before = answer_.statistics.refined, &after = answer_.statistics.final;
  after.tetrahedra = 1;
  after.min_dihedral = 54.736;
  after.max_dihedral = 90;
  before.tetrahedra = 7;
  before.min_dihedral = 1.5;
  before.max_dihedral = 175;
  before.min_face_angle = 2;
  before.below_5 = 3;
  EXPECT_EQ(go({"improve", path("in.tet"), "-o", path("a.mesh"), "--stats", path("s.json")}),
            kDone);
  EXPECT_EQ(given.tetrahedra, answer_.mesh.tetrahedra);
  EXPECT_TRUE(error_.starts_with(path("a.mesh") + ": 1 tetrahedra, dihedral angles 54.74 to 90.00"))
      << error_;
  EXPECT_TRUE(
      error_.ends_with("; before: 7 tetrahedra, dihedral angles 1.50 to 175.00 degrees, "
                       "smallest face angle 2.00, 3 below 5 degrees\n"))
      << error_;
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1);
  std::ifstream stats(path("s.json"));
  const auto json = nlohmann::json::parse(stats);
  EXPECT_EQ(json["parameters"]["job"], "improve");
  EXPECT_EQ(json["parameters"].size(), 6U);
  EXPECT_EQ(json["input"]["tetrahedra"], 1);
  EXPECT_EQ(json["given"]["tetrahedra"], 7);
  EXPECT_EQ(json["final"]["tetrahedra"], 1);
  EXPECT_EQ(json["flat"], 0);
  EXPECT_EQ(go({"improve", path("in.tet"), "-o", path("a.mesh"), "-q"}), kDone);
  EXPECT_EQ(error_, "");
  answer_.status = {StatusCode::invalid_mesh, "tetrahedron 0 is wrong"};
  EXPECT_EQ(go({"improve", path("in.tet"), "-o", path("b.mesh")}), kInvalid);
  EXPECT_EQ(error_, "delmesher: " + path("in.tet") + ": tetrahedron 0 is wrong\n");
  EXPECT_FALSE(fs::exists(path("b.mesh")));
  EXPECT_EQ(go({"improve", path("in.off"), "-o", path("b.mesh")}), kUnreadable);
  EXPECT_TRUE(one_error_line()) << error_;
}

TEST_F(Run, StatusesBecomeExitCodesAndLeaveNoOutput) {
  const std::vector<std::pair<StatusCode, int>> cases = {{StatusCode::invalid_options, 2},
                                                         {StatusCode::invalid_surface, 4},
                                                         {StatusCode::limit_reached, 5},
                                                         {StatusCode::internal_error, 6},
                                                         {StatusCode::interrupted, 130}};
  for (const auto& [status, code] : cases) {
    answer_.status = {status, "because\nof this"};
    EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), code);
    EXPECT_TRUE(one_error_line()) << error_;
    EXPECT_NE(error_.find("in.off: because?of this"), std::string::npos) << error_;
    EXPECT_EQ(files(), 1U);
  }
}

TEST_F(Run, InvertedIsOneAndFlatIsSaid) {
  answer_.statistics.rounding_flat = 2;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kDone);
  EXPECT_NE(error_.find("2 flat"), std::string::npos);
  answer_.statistics.rounding_inverted = 3;
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh"), "-q"}), kFailed);
  EXPECT_NE(error_.find("3 inverted and 2 flat"), std::string::npos);
  EXPECT_TRUE(one_error_line());
  EXPECT_TRUE(fs::exists(path("a.mesh")));
}

TEST_F(Run, UnwritableOutputsAreFoundBeforeTheRun) {
  for (const char* option : {"-o", "--stats", "--exact", "--save-chamfered"}) {
    const std::string file = path("missing/x.mesh");
    std::vector<std::string> arguments = {path("in.off"), option, file};
    if (std::string(option) != "-o") arguments.insert(arguments.end(), {"-o", path("a.mesh")});
    EXPECT_EQ(go(arguments), kUnreadable);
    EXPECT_TRUE(one_error_line()) << error_;
  }
  EXPECT_EQ(calls_, 0);
  EXPECT_EQ(files(), 1U);
}

TEST_F(Run, UnreadableInputIsThree) {
  std::ofstream(path("bad.off")) << "OFF\n1 1 0\n0 0 nan\n3 0 0 0\n";
  EXPECT_EQ(go({path("bad.off"), "-o", path("a.mesh")}), kUnreadable);
  EXPECT_NE(error_.find("bad.off:3: non-finite coordinate 'nan'"), std::string::npos) << error_;
  EXPECT_EQ(go({"check", path("none.off")}), kUnreadable);
  EXPECT_TRUE(one_error_line());
  EXPECT_EQ(calls_, 0);
}

TEST_F(Run, ExceptionsDoNotEscape) {
  library_.tetrahedralize = [](const Surface&, const Options&) -> Result {
    throw std::bad_alloc();
  };
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kLimit);
  library_.tetrahedralize = [](const Surface&, const Options&) -> Result {
    throw std::runtime_error("oops");
  };
  EXPECT_EQ(go({path("in.off"), "-o", path("a.mesh")}), kInternal);
  EXPECT_TRUE(one_error_line());
}

TEST_F(Run, StatsHaveExactlyTheDocumentedKeys) {
  answer_.statistics.final.tetrahedra = 42;
  ASSERT_EQ(go({path("in.off"), "-o", path("a.mesh"), "--stats", path("s.json")}), kDone);
  std::ifstream in(path("s.json"));
  const auto json = nlohmann::ordered_json::parse(in);
  const auto keys = [](const nlohmann::ordered_json& object) {
    std::string out;
    for (const auto& item : object.items()) out += item.key() + " ";
    return out;
  };
  EXPECT_EQ(
      keys(json),
      "input parameters status phases_seconds wall_seconds cpu_seconds peak_rss_bytes refined "
      "final planar filter prediction chamfer guarantee limits steiner rounding predicates ");
  EXPECT_EQ(keys(json["predicates"]), "filter support extended exact symbolic ");
  EXPECT_EQ(keys(json["input"]), "file vertices triangles bbox_diagonal ");
  EXPECT_EQ(keys(json["phases_seconds"]),
            "read check filter chamfer delaunay segments facets refine enrich classify improve "
            "round write ");
  const std::string mesh =
      "vertices tetrahedra interior_tetrahedra min_face_angle max_face_angle min_dihedral "
      "max_dihedral mean_min_face_angle mean_max_face_angle mean_min_dihedral mean_max_dihedral "
      "tetrahedra_below_5_degrees tetrahedra_below_10_degrees dihedral_1_percent min_gamma "
      "mean_gamma gamma_1_percent min_sicn mean_sicn "
      "face_angle_histogram dihedral_histogram ";
  EXPECT_EQ(keys(json["refined"]), mesh);
  EXPECT_EQ(keys(json["final"]), mesh);
  EXPECT_EQ(json["final"]["face_angle_histogram"].size(), 12U);
  EXPECT_EQ(keys(json["planar"]), "facets groups given_facets bound deviation ");
  EXPECT_EQ(keys(json["filter"]), "dropped_triangles rounds ");
  EXPECT_EQ(keys(json["prediction"]), "tetrahedra tau ");
  EXPECT_EQ(keys(json["chamfer"]), "acute_vertices acute_edges ");
  EXPECT_EQ(keys(json["guarantee"]), "acute corner gabriel fallback_corners ");
  EXPECT_EQ(keys(json["limits"]), "guard_stops refinement_capped cdt_restarts thinned ");
  EXPECT_EQ(keys(json["steiner"]), "on_segments on_facets in_volume in_final_mesh ");
  EXPECT_EQ(keys(json["rounding"]), "inverted flat repaired thinned max_surface_deviation ");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["final"]["tetrahedra"], 42);
  EXPECT_EQ(json["input"]["triangles"], 4);
  EXPECT_GT(json["peak_rss_bytes"], 1000000);
}

TEST_F(Run, CheckReportsAsTextAndJson) {
  report_.facets = 4;
  EXPECT_EQ(go({"check", path("in.off")}), kDone);
  EXPECT_NE(out_.find("a valid surface"), std::string::npos);
  report_.status = {StatusCode::invalid_surface, "triangles 1 and 2 intersect"};
  report_.defects.push_back(
      {Defect::Kind::self_intersection, {}, {1, 2}, "triangles 1 and 2 intersect"});
  report_.defect_counts[static_cast<std::size_t>(Defect::Kind::self_intersection)] = 3;
  EXPECT_EQ(go({"check", path("in.off")}), kInvalid);
  EXPECT_NE(out_.find("self-intersection: 3\n    triangles 1 and 2 intersect\n    and 2 more"),
            std::string::npos)
      << out_;
  EXPECT_TRUE(one_error_line());
  EXPECT_EQ(go({"check", "--json", path("in.off")}), kInvalid);
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["valid"], false);
  EXPECT_EQ(json["defect_counts"]["self-intersection"], 3);
  EXPECT_EQ(json["defects"][0]["triangles"], nlohmann::json({1, 2}));
}

TEST_F(Run, ASignalStopsTheLibraryAndLeavesNothing) {
  library_.tetrahedralize = [](const Surface&, const Options& options) {
    std::raise(SIGINT);
    Result result;
    if (!options.progress({Phase::refine, -1, 0})) {
      result.status = {StatusCode::interrupted, "interrupted"};
    }
    return result;
  };
  // In a child process: the flag stays set for the rest of its life.
  const auto child = [this] {
    install_signal_handlers();
    std::_Exit(go({path("in.off"), "-o", path("a.mesh")}));
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(kInterrupted), "");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Run, TheSecondSignalDoesNotWait) {
  library_.tetrahedralize = [this](const Surface&, const Options&) -> Result {
    std::ofstream(path("left.part0")) << "x";
    set_temporaries({path("left.part0")});
    std::raise(SIGTERM);
    std::raise(SIGINT);
    std::_Exit(0);
  };
  const auto child = [this] {
    install_signal_handlers();
    go({path("in.off"), "-o", path("a.mesh")});
  };
  EXPECT_EXIT(child(), testing::ExitedWithCode(kInterrupted), "");
  EXPECT_EQ(files(), 1U);
}

TEST(ProgressText, SaysWhatIsKnown) {
  EXPECT_EQ(progress_text({Phase::refine, 0.456, 123}), "refine    45 %  123 vertices");
  EXPECT_EQ(progress_text({Phase::check, -1, 0}), "check");
  EXPECT_EQ(progress_text({Phase::refine, -1, 7, 123456}),
            "refine  7 vertices  (about 120000 tetrahedra predicted)");
  EXPECT_EQ(progress_text({Phase::check, 7, 0}), "check     100 %");
}

}  // namespace
}  // namespace delmesher::cli
