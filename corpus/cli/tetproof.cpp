// tetproof: runs meshers on models, checks what they deliver and reports.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <exception>

#include "corpus/cli/commands.h"
#include "corpus/meshers.h"
#ifdef TETPROOF_HAS_VERIFY
#include "oracles/verify_command.h"
#endif

namespace tetproof {
namespace {

CLI::App* declare_run(CLI::App& tetproof, RunArguments& a) {
  CLI::App* app = tetproof.add_subcommand("run",
                                          "Run meshers on models, each in a child process under "
                                          "limits; resumes where it stopped");
  std::string names;
  for (const std::string& name : mesher_names()) names += name + ", ";
  app->add_option("paths", a.paths, "Surface files, or folders of .off .obj .stl .ply files")
      ->required();
  app->add_option("-m,--mesher", a.meshers,
                  names +
                      "cmd:'PROG {in} {out.mesh}', NAME=cmd:'...' or "
                      "NAME=delmesher:'mesh OPTIONS'; may be repeated")
      ->required();
  app->add_option("--db", a.database, "SQLite file of the results")->required();
  app->add_option("-j,--jobs", a.jobs, "Runs at a time")->capture_default_str();
  app->add_option("--timeout", a.timeout, "Wall seconds per run")->capture_default_str();
  app->add_option("--cpu", a.cpu, "Processor seconds per run (default: as --timeout)");
  app->add_option("--memory", a.memory_mebibytes, "Resident MiB per run")->capture_default_str();
  app->add_option("--stop-after", a.stop_after,
                  "Begin no further model after this many seconds (exit 5 if some are left)");
  app->add_option("--shard", a.shard, "I/N: only the I-th of N parts of the models");
  app->add_option("--delmesher-binary", a.delmesher,
                  "Our mesher (default: the one beside this program)");
  app->add_option("--keep", a.keep, "Folder in which to keep the meshes");
#ifdef TETPROOF_HAS_VERIFY
  app->add_flag("--verify", a.verify, "Ask the oracles about each mesh as well");
  app->add_flag(
      "--exact", a.sidecars,
      "With --verify: delmesher runs once more for its sidecar, and is asked for the same "
      "bytes; all oracles are asked");
#endif
  return app;
}

CLI::App* declare_report(CLI::App& tetproof, ReportArguments& a) {
  CLI::App* app = tetproof.add_subcommand("report", "Tables of one or more campaigns");
  app->add_option("databases", a.databases, "Results of tetproof run")
      ->required()
      ->check(CLI::ExistingFile);
  app->add_option("-o,--output", a.folder, "Folder of the report")->required();
  return app;
}

CLI::App* declare_measure(CLI::App& tetproof, MeasureArguments& a) {
  CLI::App* app =
      tetproof.add_subcommand("measure", "Angles, counts and orientation of a mesh file, as JSON");
  app->add_option("mesh", a.mesh, "A .mesh, .msh, .vtu, .node or .tet file")->required();
  app->add_option("-o,--output", a.output, "Where to write it (default: standard output)");
  return app;
}

#ifdef TETPROOF_HAS_GENERATE
CLI::App* declare_generate(CLI::App& tetproof, GenerateArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "generate", "Near-degenerate polyhedra, certified valid, and invalid twins");
  app->add_option("family", a.families, "Names of families, or all");
  app->add_option("--seed", a.seed)->capture_default_str();
  app->add_option("--first", a.first, "Number of the first member")->capture_default_str();
  app->add_option("--count", a.count, "Members of each family")->capture_default_str();
  app->add_option("-o,--output", a.folder, "Folder for the files and manifest.csv");
  app->add_option("--model", a.models, "Surfaces that derived families start from; may be repeated")
      ->check(CLI::ExistingFile);
  app->add_flag("--twins", a.twins, "Write invalid twins too, with the expected reason");
  app->add_flag("--list", a.list, "Name the families");
  return app;
}

CLI::App* declare_shrink(CLI::App& tetproof, ShrinkArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "shrink", "The smallest valid surface found on which a mesher fails in the same way");
  app->add_option("input", a.input, "A surface on which it fails")->required();
  app->add_option("-m,--mesher", a.mesher, "As for run")->required();
  app->add_option("-o,--output", a.output, "OFF file of the result")->required();
  app->add_option("--timeout", a.timeout, "Seconds per run of the mesher; more is a failure")
      ->capture_default_str();
  app->add_option("--memory", a.memory_mebibytes, "Resident MiB per run")->capture_default_str();
  app->add_option("--seconds", a.seconds, "In all")->capture_default_str();
  app->add_option("--runs", a.runs, "Of the mesher, at most")->capture_default_str();
  app->add_flag("--no-verify", a.no_verify, "Look at how it ends only, not at what it delivers");
  return app;
}
#endif

int parse_and_run(int argc, char** argv) {
  CLI::App app("Runs tetrahedral meshers on models, checks what they deliver and reports.",
               "tetproof");
  app.set_version_flag("--version", std::string("tetproof ") + TETPROOF_VERSION);
  app.require_subcommand(1);
  RunArguments run;
  ReportArguments report;
  MeasureArguments measure;
  const CLI::App* run_app = declare_run(app, run);
  const CLI::App* report_app = declare_report(app, report);
  declare_measure(app, measure);
#ifdef TETPROOF_HAS_GENERATE
  GenerateArguments generate;
  const CLI::App* generate_app = declare_generate(app, generate);
  ShrinkArguments shrink;
  const CLI::App* shrink_app = declare_shrink(app, shrink);
#endif
#ifdef TETPROOF_HAS_VERIFY
  app.add_subcommand("verify", "Exact checks of a mesh against its input (see verify --help)");
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (run_app->parsed()) return run_command(run);
  if (report_app->parsed()) return report_command(report);
#ifdef TETPROOF_HAS_GENERATE
  if (generate_app->parsed()) return generate_command(generate);
  if (shrink_app->parsed()) return shrink_command(shrink);
#endif
  return measure_command(measure);
}

}  // namespace
}  // namespace tetproof

int main(int argc, char** argv) {
#ifdef TETPROOF_HAS_VERIFY
  // The oracles read their own arguments.
  if (argc > 1 && std::strcmp(argv[1], "verify") == 0) {
    return tetproof::run_verify(argc - 1, argv + 1);
  }
#endif
  try {
    return tetproof::parse_and_run(argc, argv);
  } catch (const tetproof::UsageError& error) {
    std::fprintf(stderr, "tetproof: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tetproof: %s\n", error.what());
    return 3;
  }
}
