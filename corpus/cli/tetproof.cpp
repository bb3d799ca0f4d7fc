// tetproof: runs meshers on models, checks what they deliver and reports.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>

#include "corpus/cli/commands.h"
#include "corpus/cli/numbers.h"
#include "corpus/peers/meshers.h"
#ifdef TETPROOF_HAS_VERIFY
#include "oracles/verify_command.h"
#endif

namespace tetproof {
namespace {

constexpr double kMostJobs = 4096;

void add_tier(CLI::App& app, std::string& tier) {
  app.add_option("--tier", tier,
                 "How many of the models: smoke (30 small ones), nightly (300), "
                 "weekly (all)")
      ->check(CLI::IsMember({"smoke", "nightly", "weekly"}));
}

// Limits of children: how many at a time, how long, how large.
template <typename Arguments>
void add_limits(CLI::App& app, Arguments& a, const char* jobs, const char* seconds,
                const char* mebibytes) {
  app.add_option("-j,--jobs", a.jobs, jobs)->check(number_in(0, kMostJobs))->capture_default_str();
  app.add_option("--timeout", a.timeout, seconds)->check(seconds_of_a_run())->capture_default_str();
  app.add_option("--memory", a.memory_mebibytes, mebibytes)
      ->check(mebibytes_of_a_run())
      ->capture_default_str();
}

CLI::App* declare_run(CLI::App& tetproof, RunArguments& a, const char* command = "run",
                      const char* description =
                          "Run meshers on models, each in a child process under limits; resumes "
                          "where it stopped") {
  CLI::App* app = tetproof.add_subcommand(command, description);
  std::string names;
  for (const std::string& name : mesher_names()) names += name + ", ";
  app->add_option("paths", a.paths,
                  "Surface files, or folders of .off .obj .stl .ply files, also .gz; for meshers "
                  "of the plane files of planar graphs")
      ->required();
  app->add_option("-m,--mesher", a.meshers,
                  names +
                      "cmd:'PROG {in} {out.mesh}', NAME=cmd:'...' or "
                      "NAME=delmesher:'mesh OPTIONS'; may be repeated");
  app->add_flag("--ablation", a.ablation,
                "Also run our mesher by default, with each departure from the paper undone alone "
                "(delmesher+NAME), and with the paper's preset (delmesher-e4)");
  app->add_option("--db", a.database, "SQLite file of the results")->required();
  add_limits(*app, a, "Runs at a time", "Wall seconds per run", "Resident MiB per run");
  app->add_option("--cpu", a.cpu, "Processor seconds per run (default: as --timeout)")
      ->check(seconds_of_a_run());
  app->add_option("--stop-after", a.stop_after,
                  "Begin no further model after this many seconds (exit 5 if some are left)")
      ->check(seconds_of_a_run());
  add_tier(*app, a.tier);
  app->add_option("--shard", a.shard, "I/N: only the I-th of N parts of the models");
  app->add_option("--retry", a.retry,
                  "Run again the rows with this disposition: killed, timeout, ...")
      ->check(CLI::IsMember({"ok", "unverified", "wrong-result", "rejected", "crash", "timeout",
                             "out-of-memory", "killed"}));
  app->add_option("--delmesher-binary", a.delmesher,
                  "Our mesher (default: the one beside this program)");
  app->add_option("--keep", a.keep,
                  "Folder in which to keep the meshes, and the chamfered surfaces of ours");
  app->add_option("--keep-tetrahedra", a.keep_tetrahedra, "Keep no mesh with more than these");
  app->add_flag("--solver", a.solver,
                "Solve Poisson's equation on each mesh, inside: iterations, condition, error");
  app->add_flag("--verify,!--no-verify", a.verify, "Verify each mesh (the default)");
  app->add_flag(
      "--exact", a.sidecars,
      "Run delmesher once more for its record, which must give the same bytes, and verify with all "
      "oracles");
  return app;
}

CLI::App* declare_report(CLI::App& tetproof, ReportArguments& a) {
  CLI::App* app = tetproof.add_subcommand("report", "Tables of one or more campaigns");
  app->add_option("databases", a.databases, "Results of tetproof run")
      ->required()
      ->check(CLI::ExistingFile);
  app->add_option("-o,--output", a.folder, "Folder of the report");
  CLI::Option* league = app->add_option("--league", a.league,
                                        "Write this page of the league (.md), and its runs beside "
                                        "it (.csv), instead of a report; the "
                                        ".csv of an earlier page may be among the results");
  app->add_option("--commit", a.commit, "With --league: of which our own programs are")
      ->needs(league);
  app->add_option("--drop", a.left_out,
                  "With --league: a mesher to leave off the page; its runs stay beside it")
      ->needs(league);
  app->add_option("--base", a.base, "Results to compare with: meshers NAME@base")
      ->check(CLI::ExistingFile);
  app->add_option("--model", a.model, "Model of Table 3 and Figure 13, by name");
  app->add_option("--families", a.families, "Lines PATTERN,FAMILY: groups of models in the league")
      ->check(CLI::ExistingFile);
  app->add_flag(
      "--history", a.history,
      "The databases are campaigns in order of time: show what changed, and when; the rest of the "
      "report is about the last");
  app->add_flag("--processor-time", a.processor_time,
                "Show processor seconds only, for campaigns on a busy machine");
  app->add_option("--views", a.views,
                  "Models with pictures, if their meshes were kept (run --keep)")
      ->capture_default_str();
  app->add_option("--show", a.show, "Models that get pictures in any case, by name");
  return app;
}

CLI::App* declare_export(CLI::App& tetproof, ExportArguments& a) {
  CLI::App* app = tetproof.add_subcommand("export", "The rows as CSV, JSON or JUnit XML");
  app->add_option("databases", a.databases, "Results of tetproof run")
      ->required()
      ->check(CLI::ExistingFile);
  app->add_option("-o,--output", a.output, "FILE.csv, FILE.json or FILE.xml (JUnit)")->required();
  app->add_flag("--brief", a.brief,
                "JSON without statistics, histograms, findings, host and paths");
  app->add_flag("--stable", a.stable, "Without times, memory, host and paths");
  return app;
}

CLI::App* declare_merge(CLI::App& tetproof, MergeArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "merge", "Rows of several results into one; merging again changes nothing");
  app->add_option("databases", a.databases, "Results of tetproof run, for example of shards")
      ->required()
      ->check(CLI::ExistingFile);
  app->add_option("-o,--output", a.output, "SQLite file to merge into")->required();
  return app;
}

CLI::App* declare_meshers(CLI::App& tetproof, MeshersArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "meshers", "List other meshers known by name: licence, promise, version or what is missing");
  app->add_flag("--at-hand", a.at_hand, "Only the names of those of surfaces that can be run here");
  return app;
}

CLI::App* declare_convert(CLI::App& tetproof, ConvertArguments& a) {
  CLI::App* app = tetproof.add_subcommand("convert", "A surface in another format, exactly");
  app->add_option("input", a.input, "A surface file")->required();
  app->add_option("output", a.output, "FILE.off, FILE.mesh or FILE.stl")->required();
  app->add_option(
      "--solids", a.solids,
      "Number the shells from 1, as labels of FILE.mesh, and write a line for each solid "
      "here: the shell around it and those of its cavities");
  return app;
}

CLI::App* declare_measure(CLI::App& tetproof, MeasureArguments& a) {
  CLI::App* app =
      tetproof.add_subcommand("measure", "Angles, counts and orientation of a mesh file, as JSON");
  app->add_option("mesh", a.mesh, "A .mesh, .msh, .vtu, .node or .tet file")->required();
  app->add_flag("--plane", a.plane, "A mesh of triangles in the plane: .msh, .vtu, .node or .off");
  app->add_option("-o,--output", a.output, "Where to write it (default: standard output)");
  app->add_flag("--solver", a.solver, "Solve Poisson's equation on it, too");
  return app;
}

CLI::App* declare_picture(CLI::App& tetproof, PictureArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "picture", "The place that an oracle names, in the mesh and in the input, as SVG");
  app->add_option("input", a.input, "The surface")->required();
  app->add_option("mesh", a.mesh, "The mesh that was judged")->required();
  app->add_option("-o,--output", a.output, "FILE.svg")->required();
  CLI::Option* verdict =
      app->add_option("--verdict", a.verdict, "What tetproof verify --json says of it")
          ->check(CLI::ExistingFile);
  app->add_option("--sentence", a.sentence, "What an oracle says, instead")->excludes(verdict);
  app->add_flag("--own-surface", a.own_surface, "It was judged by an envelope");
  return app;
}

CLI::App* declare_gate(CLI::App& tetproof, GateArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "gate", "Compare with an earlier campaign; exit 1 and a line each if something got worse");
  app->add_option("--base", a.base,
                  "Baseline: results, or exports in JSON; several are repetitions of one campaign, "
                  "whose least times count")
      ->required()
      ->check(CLI::ExistingFile);
  app->add_option("--new", a.fresh, "Results, or exports in JSON, to judge; several as above")
      ->required()
      ->check(CLI::ExistingFile);
  GateOptions& o = a.options;
  const auto limit = [&](const char* group, const char* name, double& value, const char* what,
                         double low, double high) {
    app->add_option(name, value, what)
        ->check(number_in(low, high))
        ->capture_default_str()
        ->group(group);
  };
  const double most = 1e6;
  const char* one = "Limits for one model";
  limit(one, "--time-factor", o.time_factor, "Processor time this many times as long", 1, most);
  limit(one, "--memory-factor", o.memory_factor, "Peak memory this many times as large", 1, most);
  limit(one, "--size-factor", o.size_factor, "Tetrahedra this many times as many, or as few", 1,
        most);
  limit(
      one, "--angle-factor", o.angle_factor,
      "Smallest face angle (refined, final), dihedral or 1 % quantile of gamma below this fraction "
      "of the base's",
      0, 1);
  limit(one, "--mean-factor", o.mean_factor,
        "The same for mean gamma and mean angles (largest ones: 180 degrees minus them)", 0, 1);
  limit(one, "--sliver-share", o.sliver_share,
        "Share of tetrahedra with a dihedral below 5 or 10 degrees larger by this", 0, 1);
  limit(one, "--deviation-ulps", o.deviation_ulps,
        "Written surface off the input by this many ulp more (and half as much again)", 0, most);
  limit(one, "--least-seconds", o.least_seconds, "Smaller differences are noise", 0, most);
  limit(one, "--least-bytes", o.least_bytes, "Smaller differences are noise", 0, 1e18);
  limit(one, "--least-tetrahedra", o.least_tetrahedra, "Smaller differences are noise", 0, 1e18);
  limit(one, "--least-slivers", o.least_slivers, "Smaller differences are noise", 0, 1e18);
  const char* all = "Limits for all models of a mesher together (from 8 pairs on)";
  limit(all, "--total-time-factor", o.total_time_factor,
        "Processor time, if the sides were measured in turn (else --time-factor)", 1, most);
  limit(all, "--total-memory-factor", o.total_memory_factor, "Peak memory", 1, most);
  limit(all, "--total-size-factor", o.total_size_factor, "Tetrahedra, more or fewer", 1, most);
  limit(all, "--total-angle-factor", o.total_angle_factor,
        "Smallest angles and 1 % quantile of gamma", 0, 1);
  limit(all, "--total-mean-factor", o.total_mean_factor, "Mean angles and gamma", 0, 1);
  limit(all, "--total-sliver-share", o.total_sliver_share, "Share of small dihedrals", 0, 1);
  app->add_flag("--quiet-machine", o.quiet_machine,
                "Judge times as if the sides had been measured in turn");
  app->add_flag("--allow-missing", a.allow_missing, "Runs of the base may be missing");
  app->add_flag("--allow-fewer", a.allow_fewer, "Meshes may have fewer tetrahedra");
  app->add_option("--allow-silent", o.may_be_silent,
                  "Oracles that may be missing although the base has them");
  return app;
}

CLI::App* declare_classify(CLI::App& tetproof, ClassifyArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "classify",
      "Which files are valid surfaces: closed, manifold, oriented, not intersecting "
      "themselves; writes the manifest of a collection");
  app->add_option("paths", a.paths,
                  "Surface files, or folders of .off .obj .stl .ply files, also .gz")
      ->required();
  app->add_option("-o,--output", a.output,
                  "Manifest; files decided in an earlier one of this name (CSV) are not looked at "
                  "again (default: standard output)");
  app->add_flag("--json", a.json, "JSON rather than CSV");
  app->add_option("--licences", a.licences, "CSV with columns file and licence")
      ->check(CLI::ExistingFile);
  add_tier(*app, a.tier);
  add_limits(*app, a, "Files at a time", "Seconds per file", "Resident MiB per file");
  return app;
}

CLI::App* declare_slurm(CLI::App& tetproof, SlurmArguments& a) {
  CLI::App* app = declare_run(
      tetproof, a.run, "slurm",
      "Run a campaign as a Slurm job array and merge when done; repeat the command to wait again");
  app->add_option("--shards", a.shards, "Tasks of the array")
      ->required()
      ->check(CLI::PositiveNumber);
  app->add_option("--retries", a.retries, "How often lost tasks are submitted again")
      ->capture_default_str();
  app->add_option("--task-minutes", a.task_minutes, "Time limit of a task");
  CLI::Option* plan = app->add_flag(
      "--plan", a.plan,
      "Submit nothing: estimate hours, memory and the cost of a lost task, from the runs in --db");
  app->add_option("--of", a.of, "Estimate for this many models, of which these are a sample")
      ->check(CLI::PositiveNumber)
      ->needs(plan);
  app->add_option("--sbatch", a.sbatch,
                  "Further options of sbatch, such as --sbatch=--partition=x");
  return app;
}

#ifdef TETPROOF_HAS_GENERATE
CLI::App* declare_generate(CLI::App& tetproof, GenerateArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "generate",
      "Near-degenerate polyhedra, certified valid, and invalid twins; and planar graphs");
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

CLI::App* declare_copies(CLI::App& tetproof, const char* name, const char* about,
                         CopiesArguments& a) {
  CLI::App* app = tetproof.add_subcommand(name, about);
  app->add_option("paths", a.paths,
                  "Surface files, or folders of .off .obj .stl .ply files, also .gz")
      ->required();
  app->add_option("-o,--output", a.folder, "Folder for the files")->required();
  return app;
}

CLI::App* declare_rotate(CLI::App& tetproof, CopiesArguments& a) {
  CLI::App* app = declare_copies(
      tetproof, "rotate",
      "Surfaces as given and in three other positions, in doubles (NAME@r1.off) and in float32 "
      "(NAME@r1s.off), where they are valid; reports compare their meshes",
      a);
  app->add_option("--seed", a.seed, "One position, drawn by this number, in place of the three");
  return app;
}

CLI::App* declare_vary(CLI::App& tetproof, CopiesArguments& a) {
  return declare_copies(
      tetproof, "vary",
      "Surfaces as given and exact copies: turned (NAME@t1.off), scaled (NAME@s1.off), renumbered "
      "(NAME@n1.off), an edge split (NAME@e1.off); reports show for which meshers the "
      "outcome differs",
      a);
}

CLI::App* declare_shrink(CLI::App& tetproof, ShrinkArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "shrink", "The smallest valid surface found on which a mesher fails in the same way");
  app->add_option("input", a.input, "A surface on which it fails")->required();
  app->add_option("-m,--mesher", a.mesher, "As for run")->required();
  app->add_option("-o,--output", a.output, "OFF file of the result")->required();
  add_limits(*app, a, "Runs at a time (1: the same result each time)",
             "Seconds per run of the mesher; more is a failure", "Resident MiB per run");
  app->add_option("--seconds", a.seconds, "In all")
      ->check(seconds_of_a_run())
      ->capture_default_str();
  app->add_option("--runs", a.runs, "Of the mesher, at most")
      ->check(number_in(1, 1e9))
      ->capture_default_str();
  app->add_flag("--no-verify", a.no_verify, "Look at how it ends only, not at what it delivers");
  return app;
}
#endif

#ifdef TETPROOF_HAS_UNION
CLI::App* declare_union(CLI::App& tetproof, UnionArguments& a) {
  CLI::App* app = tetproof.add_subcommand(
      "union",
      "One surface around overlapping bodies, or around a surface that intersects itself; exact "
      "except that new points are rounded");
  app->add_option("input", a.input, "A surface file")->required();
  app->add_option("-o,--output", a.output, "FILE.stl, FILE.ply or FILE.off")->required();
  app->add_flag(
      "--nonzero", a.nonzero,
      "Also count as inside where the winding number is negative (default: only where it is "
      "positive)");
  app->add_option("--separate", a.separate,
                  "Move parts that touch at edges or vertices apart, each vertex by at most this "
                  "fraction of the diagonal (0: leave them)")
      ->capture_default_str()
      ->check(number_in(0, 0.01));
  app->add_flag(
      "--walls", a.walls,
      "Drop nothing: bodies that overlap, or touch in different triangles, and open sheets "
      "become triangles that meet in common vertices and edges alone, those of several "
      "bodies once for each label (for delmesher mesh --regions all)");
  app->add_option("--snap", a.snap,
                  "With --walls: vertices, edges and faces nearer than this count as touching, "
                  "some up to four times as far, too: a "
                  "length, or a fraction of the diagonal as in 1e-6d (what roundings of doubles or "
                  "floats explain)");
  app->footer(
      "Exit codes: 0 done, 1 parts touch so that it is not manifold there, 2 usage, 3 unreadable "
      "or cannot be written, 4 it does not close up, 5 memory, the precision of doubles, or "
      "parts that could not be moved apart, 6 internal error, 130 interrupted. Nothing is written "
      "but with 0 and 1.");
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
  PictureArguments picture;
  const CLI::App* picture_app = declare_picture(app, picture);
  ExportArguments exporting;
  const CLI::App* export_app = declare_export(app, exporting);
  MergeArguments merging;
  const CLI::App* merge_app = declare_merge(app, merging);
  GateArguments gate;
  const CLI::App* gate_app = declare_gate(app, gate);
  ClassifyArguments classification;
  const CLI::App* classify_app = declare_classify(app, classification);
  SlurmArguments slurm;
  const CLI::App* slurm_app = declare_slurm(app, slurm);
  MeshersArguments meshers;
  const CLI::App* meshers_app = declare_meshers(app, meshers);
  ConvertArguments conversion;
  const CLI::App* convert_app = declare_convert(app, conversion);
#ifdef TETPROOF_HAS_GENERATE
  GenerateArguments generate;
  const CLI::App* generate_app = declare_generate(app, generate);
  CopiesArguments rotate;
  const CLI::App* rotate_app = declare_rotate(app, rotate);
  CopiesArguments vary;
  const CLI::App* vary_app = declare_vary(app, vary);
  ShrinkArguments shrink;
  const CLI::App* shrink_app = declare_shrink(app, shrink);
#endif
#ifdef TETPROOF_HAS_UNION
  UnionArguments uniting;
  const CLI::App* union_app = declare_union(app, uniting);
#endif
#ifdef TETPROOF_HAS_VERIFY
  app.add_subcommand("verify", "Exact checks of a mesh against its input (see verify --help)");
#endif
  app.add_subcommand(
      "bisect", "The commit that changed a model's mesh or a number of it (see bisect --help)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (run_app->parsed()) return run_command(run);
  if (report_app->parsed()) return report_command(report);
  if (export_app->parsed()) return export_command(exporting);
  if (picture_app->parsed()) return picture_command(picture);
  if (gate_app->parsed()) return gate_command(gate);
  if (classify_app->parsed()) return classify_command(classification);
  if (slurm_app->parsed()) return slurm_command(slurm);
  if (merge_app->parsed()) return merge_command(merging);
  if (meshers_app->parsed()) return meshers_command(meshers);
  if (convert_app->parsed()) return convert_command(conversion);
#ifdef TETPROOF_HAS_GENERATE
  if (generate_app->parsed()) return generate_command(generate);
  if (rotate_app->parsed()) return rotate_command(rotate);
  if (vary_app->parsed()) return vary_command(vary);
  if (shrink_app->parsed()) return shrink_command(shrink);
#endif
#ifdef TETPROOF_HAS_UNION
  if (union_app->parsed()) return union_command(uniting);
#endif
  return measure_command(measure);
}

}  // namespace
}  // namespace tetproof

int main(int argc, char** argv) {
  try {
#ifdef TETPROOF_HAS_VERIFY
    tetproof::survive_lack_of_memory();
    // The oracles read their own arguments.
    if (argc > 1 && std::strcmp(argv[1], "verify") == 0) {
      return tetproof::run_verify(argc - 1, argv + 1);
    }
#endif
    // So does the script that it is.
    if (argc > 1 && std::strcmp(argv[1], "bisect") == 0) return tetproof::bisect_command(argv + 1);
    std::vector<char*> words(argv, argv + argc);
    char help[] = "--help";
    if (argc == 1) words.push_back(help);
    return tetproof::parse_and_run(static_cast<int>(words.size()), words.data());
  } catch (const tetproof::UsageError& error) {
    std::fprintf(stderr, "tetproof: %s\n", error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fputs("tetproof: not enough memory\n", stderr);
    return 5;
  } catch (const std::length_error&) {
    std::fputs("tetproof: more than this machine can number\n", stderr);
    return 5;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tetproof: %s\n", error.what());
    return 3;
  }
}
