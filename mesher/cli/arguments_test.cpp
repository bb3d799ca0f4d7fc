// How the arguments of the command line are read.
#include "mesher/cli/arguments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "mesher/cli/test_option_values.h"
#include "mesher/delmesher/option_table.h"

namespace delmesher::cli {
namespace {

Parsed parse(std::vector<std::string> arguments) {
  return parse_arguments(std::move(arguments));
}

// Of a run of the job that has them.
template <class JobOptions = Options>
JobOptions options_of(const Parsed& parsed) {
  EXPECT_TRUE(parsed.run) << parsed.error;
  const auto* options = std::get_if<JobOptions>(&parsed.command.options);
  EXPECT_NE(options, nullptr);
  return options != nullptr ? *options : JobOptions();
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
  EXPECT_EQ(parsed.command.job(), Job::mesh);
  EXPECT_EQ(parsed.command.input, "in.off");
  EXPECT_EQ(parsed.command.outputs, std::vector<std::string>({"out.mesh"}));
  EXPECT_FALSE(options_of(parsed).want_exact);
  const auto expect_defaults = []<class JobOptions>(std::vector<std::string> arguments,
                                                    const JobOptions& defaults) {
    const auto given = options::values_of(options_of<JobOptions>(parse(arguments)));
    const auto expected = options::values_of(defaults);
    ASSERT_EQ(given.size(), expected.size());
    for (std::size_t n = 0; n < given.size(); ++n) {
      EXPECT_EQ(given[n].value, expected[n].value) << arguments[0] << " " << given[n].text.name;
    }
  };
  expect_defaults({"mesh", "i.off", "-o", "o.mesh"}, Options());
  expect_defaults({"mesh", "i.off", "-o", "o.mesh", "--preset", "paper"}, paper_options());
  expect_defaults({"cdt", "i.off", "-o", "o.mesh"}, CdtOptions());
  expect_defaults({"plane", "i.poly", "-o", "o.vtu"}, PlaneOptions());
  expect_defaults({"plane", "i.poly", "-o", "o.vtu", "--preset", "paper"}, paper_plane_options());
  expect_defaults({"check", "i.off"}, CheckOptions());
  expect_defaults({"improve", "i.mesh", "-o", "o.mesh"}, ImproveOptions());
  expect_defaults({"repair", "i.off", "-o", "o.off"}, RepairOptions());
  expect_defaults({"remesh", "i.off", "-o", "o.off"}, RemeshOptions());
}

// A command with each option of a job alone: an option of the table is read, has the effect of its
// name, and is rejected by jobs without it.
struct JobCase {
  std::vector<std::string> arguments;
  std::vector<options::Value> values;
};
template <class JobOptions>
JobCase job_case(std::vector<std::string> arguments) {
  return {std::move(arguments), options::values_of(JobOptions())};
}
std::vector<JobCase> job_cases() {
  return {job_case<Options>({"mesh", "i.off", "-o", "o.mesh"}),
          job_case<CdtOptions>({"cdt", "i.off", "-o", "o.mesh"}),
          job_case<PlaneOptions>({"plane", "i.poly", "-o", "o.vtu"}),
          job_case<CheckOptions>({"check", "i.off"}),
          job_case<ImproveOptions>({"improve", "i.mesh", "-o", "o.mesh"}),
          job_case<RepairOptions>({"repair", "i.off", "-o", "o.off"}),
          job_case<RemeshOptions>({"remesh", "i.off", "-o", "o.off"})};
}

TEST(Arguments, EveryOptionOfTheTableIsReadAlone) {
  for (const JobCase& job : job_cases()) {
    for (std::size_t n = 0; n < job.values.size(); ++n) {
      const options::Value& option = job.values[n];
      const std::string name(option.text.name);
      const auto [text, value] = another_value(option);
      std::vector<std::string> arguments = job.arguments;
      if (option.is_paper()) {
        arguments.insert(arguments.end(), {"--as-paper", options::argument_name(name)});
      } else {
        arguments.push_back("--" + options::argument_name(name));
        if (!text.empty()) arguments.push_back(text);
      }
      if (name == "size_growth") arguments.insert(arguments.end(), {"--size-field", "s.txt"});
      const bool of_mesh = job.arguments[0] == "mesh";
      if (name == "feature" && of_mesh) arguments.insert(arguments.end(), {"--tolerance", "1"});
      const Parsed parsed = parse(arguments);
      ASSERT_TRUE(parsed.run) << parsed.error;
      const auto given = std::visit([](const auto& options) { return options::values_of(options); },
                                    parsed.command.options);
      ASSERT_EQ(given.size(), job.values.size());
      for (std::size_t k = 0; k < given.size(); ++k) {
        if (name == "feature" && of_mesh && given[k].text.name == "tolerance") continue;
        EXPECT_EQ(given[k].value, k == n ? value : job.values[k].value)
            << job.arguments[0] << " --" << name << ": " << given[k].text.name;
      }
      if (option.kind == options::Kind::sources) {
        EXPECT_EQ(parsed.command.sizes_file, text);
      }
    }
  }
}

TEST(Arguments, OptionsOfOtherJobsAreRefused) {
  std::size_t refused = 0;
  for (const JobCase& job : job_cases()) {
    for (const JobCase& other : job_cases()) {
      for (const options::Value& option : other.values) {
        if (option.is_paper()) continue;
        const bool is_there =
            std::any_of(job.values.begin(), job.values.end(),
                        [&](const auto& mine) { return mine.text.name == option.text.name; });
        if (is_there) continue;
        std::vector<std::string> arguments = job.arguments;
        arguments.push_back("--" + options::argument_name(option.text.name));
        if (const std::string text = another_value(option).first; !text.empty()) {
          arguments.push_back(text);
        }
        expect_usage_error(arguments, "no such option of " + job.arguments[0] + ", but of ");
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 60U);
}

TEST(Arguments, ToleranceIsALengthOrAShareOfTheDiagonal) {
  const auto tolerance = [](const std::string& text) {
    return options_of(parse({"i.off", "-o", "o.mesh", "--tolerance", text})).tolerance;
  };
  EXPECT_EQ(tolerance("0.25"), 0.25);
  EXPECT_EQ(tolerance("1e-3d"), -1e-3);
  EXPECT_EQ(tolerance("0.1d"), -0.1);
  for (const char* wrong : {"0", "-1", "0d", "-1e-3d", "0.2d", "d", "1e-3e", "nan", "1 d"}) {
    expect_usage_error({"i.off", "-o", "o.mesh", "--tolerance", wrong}, "--tolerance");
  }
  expect_usage_error({"i.off", "-o", "o.mesh", "--feature", "30"}, "without --tolerance");
}

TEST(Arguments, FilesAndSwitchesOfTheCommandLine) {
  const Parsed parsed = parse({"in.off", "-o", "a.mesh", "-o", "b.vtu", "--stats", "s.json",
                               "--save-chamfered", "c.off", "--exact", "e.txt", "-v"});
  EXPECT_EQ(parsed.command.outputs, std::vector<std::string>({"a.mesh", "b.vtu"}));
  EXPECT_EQ(parsed.command.stats_file, "s.json");
  EXPECT_TRUE(options_of(parsed).want_exact && options_of(parsed).want_chamfered);
  EXPECT_TRUE(parsed.command.verbose);
}

TEST(Arguments, GivenTwiceOrWithoutEffect) {
  expect_usage_error({"in.off", "-o", "a.mesh", "--delta", "3", "--delta", "4"},
                     "'--delta': given twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "--delta=3", "--tau", "0", "--delta=3"},
                     "'--delta': given twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "-q", "--quiet"}, "'--quiet': given twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "--gabriel", "--gabriel"}, "given twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "--stats", "a", "--stats", "b"}, "given twice");
  expect_usage_error({"in.off", "-o", "a.mesh", "--jobs", "4"},
                     "--jobs: of no effect with one input, see --threads");
  expect_usage_error({"in.off", "-o", "a.mesh", "-o", "a.node", "--ascii"},
                     "--ascii: of no effect but on .msh and .vtu");
  expect_usage_error({"in.off", "-o", "a.mesh", "-o", "a.vtu", "--msh", "2.2"},
                     "--msh: of no effect but on .msh");
  EXPECT_TRUE(parse({"in.off", "-o", "a.mesh", "-o", "a.msh", "--msh", "2.2"}).run);
  expect_usage_error({"in.off", "-o", "a.mesh", "--size-growth", "0.2"},
                     "--size-growth: of no effect without --size-field");
  EXPECT_TRUE(parse({"in.off", "-o", "a.mesh", "-o", "a.VTU", "--ascii"}).run);
  EXPECT_TRUE(parse({"a.off", "b.off", "-o", "{name}.mesh", "--jobs", "1"}).run);
}

TEST(Arguments, PlanarIsANumberOrAuto) {
  const auto planar = [](std::vector<std::string> more) {
    std::vector<std::string> all = {"a.off", "-o", "a.mesh", "--planar"};
    all.insert(all.end(), more.begin(), more.end());
    return options_of(parse(all)).planar;
  };
  EXPECT_EQ(planar({"0"}), 0);
  EXPECT_EQ(planar({"1e-4"}), 1e-4);
  EXPECT_EQ(planar({"auto"}), kPlanarAuto);
  EXPECT_EQ(planar({"auto", "--preset", "paper"}), kPlanarAuto);
  expect_usage_error({"a.off", "-o", "a.mesh", "--planar", "0.02"}, "--planar");
  expect_usage_error({"a.off", "-o", "a.mesh", "--planar", "some"}, "--planar");
}

TEST(Arguments, ExplicitOptionsOverrideThePresetInAnyOrder) {
  const Options paper = options_of(parse({"i.off", "-o", "o.mesh", "--preset", "paper"}));
  EXPECT_EQ(paper.threads, 1U);
  EXPECT_EQ(paper.acute, 90);
  EXPECT_EQ(paper.tau, 1e-4);
  EXPECT_EQ(paper.delta, 14.47);
  EXPECT_EQ(paper.region, Region::hull);
  const Options mixed = options_of(parse({"i.off", "-o", "o.mesh", "--tau", "0", "--region",
                                          "interior", "--preset", "paper", "--acute", "70"}));
  EXPECT_EQ(mixed.acute, 70);
  EXPECT_EQ(mixed.tau, 0);
  EXPECT_EQ(mixed.delta, 14.47);
  EXPECT_EQ(mixed.region, Region::interior);
}

TEST(Arguments, WhatIsDoneAsThePaperSays) {
  const auto choices = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"i.off", "-o", "o.mesh"});
    return options_of(parse(more)).as_paper;
  };
  const AsPaper all = paper_options().as_paper;
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
  EXPECT_EQ(cdt.command.job(), Job::cdt);
  EXPECT_EQ(options_of<CdtOptions>(cdt).region, Region::hull);
  const Parsed check = parse({"check", "in.off", "--json", "--acute", "90"});
  EXPECT_TRUE(check.run);
  EXPECT_TRUE(check.command.json);
  EXPECT_EQ(options_of<CheckOptions>(check).acute, 90);
  const Parsed plane = parse({"plane", "in.poly", "-o", "out.svg", "--preset", "paper"});
  EXPECT_TRUE(plane.run);
  EXPECT_EQ(plane.command.job(), Job::plane);
  EXPECT_EQ(options_of<PlaneOptions>(plane).as_paper,
            (PlaneAsPaper{.steiner_point = true, .kept_points = true}));
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
  EXPECT_EQ(parsed.command.job(), Job::improve);
  EXPECT_EQ(parsed.command.outputs, std::vector<std::string>({"a.mesh", "b.vtu"}));
  EXPECT_EQ(options_of<ImproveOptions>(parsed).max_vertices, 9U);
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

TEST(Arguments, OfRegions) {
  const Options some = options_of<Options>(
      parse({"in.stl", "-o", "a.msh", "--regions", "copper,air", "--max-edge", "2,copper=0.5"}));
  EXPECT_EQ(some.regions, Regions::named);
  EXPECT_EQ(some.region_names, std::vector<std::string>({"copper", "air"}));
  EXPECT_EQ(some.max_edge, 2);
  ASSERT_EQ(some.region_sizes.size(), 1U);
  EXPECT_EQ(some.region_sizes[0].region, "copper");
  EXPECT_EQ(some.region_sizes[0].max_edge, 0.5);
  EXPECT_EQ(options_of<Options>(parse({"in.stl", "-o", "a.msh", "--regions=largest"})).regions,
            Regions::largest);
  expect_usage_error({"in.stl", "-o", "a.msh", "--regions", "copper,"}, "not names with");
  expect_usage_error({"in.stl", "-o", "a.msh", "--split-walls", ",a|b"}, "not names with");
  for (const char* wrong : {"1,2", "copper=0", "=1", "copper=", "1,", "copper=1,x"}) {
    expect_usage_error({"in.stl", "-o", "a.msh", "--max-edge", wrong}, "not lengths X or REGION=X");
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
  // A word in the place of a value is not an option, and a file may be called like a
  // command.
  expect_usage_error({"in.off", "-o", "a.mesh", "--delta", "-1"}, "out of range: -1");
  EXPECT_EQ(parse({"mesh", "meshes", "-o", "a.mesh"}).command.input, "meshes");
  expect_usage_error({"in.off", "-o", "a.mesh", "--tau", "2"}, "out of range: 2 (0 to 1)");
  expect_usage_error({"in.off", "-o", "a.mesh", "--max-edge", "0"}, "out of range: 0 (above 0)");
  expect_usage_error({"in.off", "-o", "a.mesh", "--size-growth", "2", "--size-field", "s"},
                     "out of range: 2");
  expect_usage_error({"in.off", "-o", "a.mesh", "--size-field", "a.mesh"}, "a.mesh: named twice");
}

TEST(Arguments, HelpFitsAScreen) {
  const std::string help = parse({"--help"}).out;
  EXPECT_LE(std::count(help.begin(), help.end(), '\n'), 24) << help;
  EXPECT_NE(help.find("delmesher part.stl -o part.msh"), std::string::npos);
  for (const char* command : {"", "mesh", "cdt", "plane", "check", "improve", "repair", "remesh"}) {
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

// Words with one space between them.
std::string unfolded(const std::string& text) {
  std::istringstream in(text);
  std::string out;
  for (std::string word; in >> word;) out += (out.empty() ? "" : " ") + word;
  return out;
}

TEST(Arguments, HelpSaysTheRanges) {
  const std::string help = unfolded(parse({"mesh", "--help"}).out);
  EXPECT_NE(help.find("degrees (14.47; above 0, at most 30)"), std::string::npos) << help;
  EXPECT_NE(help.find("--threads N"), std::string::npos) << help;
  EXPECT_NE(help.find("-o, --output FILE"), std::string::npos) << help;
  EXPECT_EQ(help.find("4294967294"), std::string::npos) << help;  // a limit that is out of reach
}

// docs/options.md, from the help of the commands and from the table.
std::string options_page() {
  std::string page =
      "# Options of delmesher\n\n"
      "Written by `TETPROOF_WRITE_DOCS=1` and the test `Arguments.OptionsPageIsUpToDate` from "
      "`mesher/delmesher/option_table.h`. Lengths are in\nthe units of the input; in parentheses "
      "stand the default and the values accepted. C and Python have the same names, with `_` for "
      "`-`;\nchoices of `--as-paper` are `paper_NAME` there.\n";
  std::set<std::string> of_mesh;  // the rows of the first job
  for (const JobCase& job : job_cases()) {
    page += "\n## `" + job.arguments[0] + "`\n\n| option | meaning |\n|---|---|\n";
    std::istringstream lines(parse({job.arguments[0], "--help"}).out);
    const bool first = of_mesh.empty();
    std::string row, as_for_mesh;
    const auto end_row = [&] {
      for (auto at = row.find('|'); at != std::string::npos; at = row.find('|', at + 2)) {
        row.insert(at, "\\");
      }
      const auto gap = row.find("  ");
      if (!row.empty()) {
        const std::string option = "`" + row.substr(0, gap) + "`";
        const std::string text = "| " + option + " | " + unfolded(row.substr(gap)) + " |\n";
        if (first) of_mesh.insert(text);
        if (first || !of_mesh.contains(text)) {
          page += text;
        } else {
          // Without what it takes.
          std::string name = row.substr(0, gap);
          if (const auto value = name.rfind(' '); name[value + 1] != '-') name.resize(value);
          as_for_mesh += (as_for_mesh.empty() ? "`" : ", `") + name + "`";
        }
      }
      row.clear();
    };
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("  -h, ")) continue;
      if (line.starts_with("  -")) {
        end_row();
        row = line.substr(2) + "  ";
      } else if (!row.empty() && line.starts_with("   ")) {
        row += line;
      } else {
        end_row();
      }
    }
    if (!as_for_mesh.empty()) page += "\nAs for `mesh`: " + as_for_mesh + ".\n";
  }
  page += "\n## Choices of `--as-paper`\n\n| choice | meaning |\n|---|---|\n";
  for (const options::Value& option : options::values_of(Options())) {
    if (!option.is_paper()) continue;
    page += "| `" + options::argument_name(option.text.name) + "` | " +
            std::string(option.text.help) + " |\n";
  }
  return page;
}

TEST(Arguments, OptionsPageIsUpToDate) {
  const std::string path = DELMESHER_DOCS "/options.md";
  if (std::getenv("TETPROOF_WRITE_DOCS") != nullptr) std::ofstream(path) << options_page();
  std::ifstream file(path);
  const std::string written((std::istreambuf_iterator<char>(file)), {});
  EXPECT_EQ(written, options_page());
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
  expect_usage_error({"a.stl", "b.stl", "-o", "{name}.msh", "--jobs", "1.5"},
                     "not a whole number: 1.5");
  expect_usage_error({"a.stl", "-o", "a.msh", "--max-vertices", "9.5"}, "not a whole number: 9.5");
  EXPECT_EQ(options_of(parse({"a.stl", "-o", "a.msh", "--max-vertices", "1e6"})).max_vertices,
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
  EXPECT_EQ(parse({"in.off", "-o", "a.inp", "--points", "p.txt"}).command.points_file, "p.txt");
  expect_usage_error({"in.off", "-o", "a.stl", "--points", "a.stl"}, "named twice");
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
