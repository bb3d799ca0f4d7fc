// How the arguments of the command line are read.
#include "mesher/cli/arguments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace delmesher::cli {
namespace {

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
  EXPECT_TRUE(parsed.command.options.slivers);
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
                               "--size-field",
                               "sizes.pos",
                               "--size-growth",
                               "0.2",
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
  EXPECT_EQ(parsed.command.sizes_file, "sizes.pos");
  EXPECT_EQ(o.size_growth, 0.2);
  EXPECT_EQ(o.region, Region::hull);
  EXPECT_EQ(o.max_vertices, 1000U);
  EXPECT_EQ(o.time_limit_seconds, 2.5);
  EXPECT_EQ(o.threads, 3U);
  EXPECT_FALSE(o.simplify_bridges);
  EXPECT_TRUE(o.want_exact && o.want_chamfered);
  EXPECT_TRUE(parsed.command.verbose);
}

TEST(Arguments, PlanarIsANumberOrAuto) {
  const auto planar = [](std::vector<std::string> more) {
    std::vector<std::string> all = {"a.off", "-o", "a.mesh", "--planar"};
    all.insert(all.end(), more.begin(), more.end());
    const Parsed parsed = parse(all);
    EXPECT_TRUE(parsed.run) << parsed.error;
    return parsed.command.options.planar;
  };
  EXPECT_EQ(planar({"0"}), 0);
  EXPECT_EQ(planar({"1e-4"}), 1e-4);
  EXPECT_EQ(planar({"auto"}), kPlanarAuto);
  EXPECT_EQ(planar({"auto", "--preset", "paper"}), kPlanarAuto);
  expect_usage_error({"a.off", "-o", "a.mesh", "--planar", "0.02"}, "--planar");
  expect_usage_error({"a.off", "-o", "a.mesh", "--planar", "some"}, "--planar");
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
  EXPECT_EQ(plane.command.options.as_paper, AsPaper{.steiner_point = true});
  const Options by_default = parse({"plane", "i.off", "-o", "o.node"}).command.options;
  EXPECT_EQ(by_default.acute, 60);
  EXPECT_EQ(by_default.as_paper, AsPaper{});
  EXPECT_TRUE(parse({"plane", "i.off", "-o", "o.node", "--as-paper", "steiner-point"})
                  .command.options.as_paper.steiner_point);
  expect_usage_error({"plane", "i.off", "-o", "o.node", "--as-paper", "order"}, "order");
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
  EXPECT_EQ(parse({"version"}).out, parse({"--version"}).out);
  EXPECT_EQ(parse({"help"}).out, parse({"--help"}).out);
  EXPECT_EQ(parse({"help", "repair"}).out, parse({"repair", "--help"}).out);
  const Parsed nothing = parse({});
  EXPECT_EQ(nothing.exit_code, kUsage);
  EXPECT_EQ(nothing.error, "delmesher: nothing to do\n\n" + parse({"--help"}).out);
}

TEST(Arguments, WhatIsMistypedIsNamedWithWhatMayBeMeant) {
  expect_usage_error({"--frobnicate", "cube.off"}, "'--frobnicate': no such option of mesh\n");
  expect_usage_error({"--detla", "3", "cube.off"},
                     "'--detla': no such option of mesh: did you mean --delta?");
  expect_usage_error({"in.off", "-o", "a.mesh", "--max-egde=2"}, "did you mean --max-edge?");
  expect_usage_error({"in.off", "-o", "a.mesh", "-x"}, "'-x': no such option of mesh");
  expect_usage_error({"improve", "a.msh", "--tau", "1"}, "'--tau': no such option of improve");
  expect_usage_error({"check", "cube.off", "--weld", "1"},
                     "'--weld': no such option of check, but of repair\n");
  expect_usage_error({"in.off", "-o", "a.mesh", "--delta"}, "--delta: its value is missing, see");
  expect_usage_error({"in.off", "-o", "-"}, "standard output needs a format: -.EXT, as in -.msh");
  expect_usage_error({"repair", "in.off", "-o", "-"}, "as in -.stl");
  expect_usage_error({"meshh", "cube.off"}, "no command or file 'meshh': did you mean mesh?");
  expect_usage_error({"chekc", "cube.off"}, "did you mean check?");
  // A word that stands where a value is expected is no option, and a file may be called like a
  // command.
  expect_usage_error({"in.off", "-o", "a.mesh", "--delta", "-1"}, "out of range: -1");
  EXPECT_EQ(parse({"mesh", "meshes", "-o", "a.mesh"}).command.input, "meshes");
  expect_usage_error({"in.off", "-o", "a.mesh", "--tau", "2"},
                     "out of range: 2 (at least 0, at most 1)");
  expect_usage_error({"in.off", "-o", "a.mesh", "--max-edge", "0"}, "out of range: 0 (above 0)");
  expect_usage_error({"in.off", "-o", "a.mesh", "--size-growth", "2"}, "out of range: 2");
  expect_usage_error({"in.off", "-o", "a.mesh", "--size-field", "a.mesh"}, "a.mesh: named twice");
}

TEST(Arguments, HelpFitsAScreen) {
  const std::string help = parse({"--help"}).out;
  EXPECT_LE(std::count(help.begin(), help.end(), '\n'), 24) << help;
  EXPECT_NE(help.find("delmesher part.stl -o part.msh"), std::string::npos);
  for (const char* command : {"", "mesh", "cdt", "plane", "check", "improve", "repair"}) {
    std::vector<std::string> arguments = {"--help"};
    if (*command != '\0') arguments.insert(arguments.begin(), command);
    const std::string text = parse(arguments).out;
    EXPECT_NE(text.find("Exit codes: 0 done;"), std::string::npos) << command;
    EXPECT_NE(text.find("Examples:\n  delmesher "), std::string::npos) << command;
    EXPECT_NE(text.find("Usage: delmesher "), std::string::npos) << command;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  }
}

TEST(Arguments, HelpSaysTheRanges) {
  const std::string help = parse({"mesh", "--help"}).out;
  EXPECT_NE(help.find("(14.47; above 0, at most"), std::string::npos) << help;
  EXPECT_NE(help.find("--threads N"), std::string::npos) << help;
  EXPECT_NE(help.find("-o, --output FILE"), std::string::npos) << help;
  EXPECT_EQ(help.find("4294967294"), std::string::npos) << help;  // a limit that is out of reach
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
  EXPECT_EQ(parse({"in/a.stl.gz", "-o", "{name}.msh"}).command.outputs[0], "a.msh");
  EXPECT_EQ(parse({"a.b.GZ", "-o", "{name}.msh"}).command.outputs[0], "a.msh");
  EXPECT_EQ(parse({"a.gz", "-o", "{name}.msh"}).command.outputs[0], "a.msh");
  expect_usage_error({"a.stl", "b.stl", "-o", "one.msh"}, "one.msh: named twice");
  expect_usage_error({"a.stl", "b.stl", "-o", "one.msh"}, "as in -o out/{name}.msh");
  expect_usage_error({"a.stl", "-o", "a.msh", "--jobs", "1.5"}, "not a whole number: 1.5");
  expect_usage_error({"a.stl", "-o", "a.msh", "--max-vertices", "9.5"}, "not a whole number: 9.5");
  EXPECT_EQ(parse({"a.stl", "-o", "a.msh", "--max-vertices", "1e6"}).command.options.max_vertices,
            1000000U);
  expect_usage_error({"a.stl", "x/a.obj", "-o", "{name}.msh"}, "a.msh: named twice");
  expect_usage_error({"a.stl", "b.stl", "-o", "-.msh"}, "standard output");
}

TEST(Arguments, StandardStreams) {
  const Parsed parsed = parse({"-", "-o", "-.vtu", "--stats", "s.json"});
  ASSERT_TRUE(parsed.run) << parsed.error;
  EXPECT_EQ(parsed.command.input, "-");
  EXPECT_EQ(parsed.command.outputs[0], "-.vtu");
  expect_usage_error({"a.off", "-o", "-"}, "standard output needs a format");
  expect_usage_error({"a.off", "-o", "-.vtu", "--stats", "-"}, "standard output can take one file");
  expect_usage_error({"a.off", "-o", "-.node"}, "standard output can take one file");
}

TEST(Arguments, MistakesAreTwo) {
  expect_usage_error({"in.off"}, "--output is required, see delmesher mesh --help\n");
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

TEST(Arguments, Ascii) {
  EXPECT_FALSE(parse({"in.off", "-o", "a.msh"}).command.write.ascii);
  EXPECT_TRUE(parse({"improve", "a.mesh", "-o", "b.vtu", "--ascii"}).command.write.ascii);
  EXPECT_TRUE(parse({"plane", "a.poly", "-o", "b.vtu", "--ascii"}).command.write.ascii);
}

TEST(Arguments, SecondOrder) {
  EXPECT_EQ(parse({"in.off", "-o", "a.msh"}).command.write.order, 1);
  for (const char* job : {"mesh", "cdt"}) {
    EXPECT_EQ(parse({job, "in.off", "-o", "a.inp", "--order", "2"}).command.write.order, 2);
  }
  EXPECT_EQ(parse({"improve", "a.mesh", "-o", "b.bdf", "--order=2"}).command.write.order, 2);
  expect_usage_error({"in.off", "-o", "a.msh", "-o", "b.tet", "--order", "2"}, "b.tet");
  expect_usage_error({"in.off", "-o", "a.msh", "--order", "3"}, "--order");
  expect_usage_error({"plane", "in.poly", "-o", "a.msh", "--order", "2"}, "--order");
}

}  // namespace
}  // namespace delmesher::cli
