#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <memory>

#include "corpus/campaign.h"
#include "corpus/cli/commands.h"
#include "corpus/process.h"

namespace tetproof {
namespace {

struct RunOptions {
  std::vector<std::string> paths, meshers;
  std::string database, shard, delmesher, keep;
  double timeout = 600, cpu = 0, stop_after = 0;
  std::uint64_t memory_mebibytes = 4096;
  unsigned jobs = 1;
  bool verify = false;
};

void on_interrupt(int) {
  interrupt_campaign();
}

void handle_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;  // without SA_RESTART, so that poll() returns
  sigemptyset(&action.sa_mask);
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaction(s, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

std::vector<Model> chosen_models(const RunOptions& options) {
  const ModelList list = collect_models({options.paths.begin(), options.paths.end()});
  for (const auto& path : list.duplicates) {
    fmt::print("same content as another model, left out: {}\n", path.string());
  }
  if (options.shard.empty()) return list.models;
  unsigned index = 0, count = 0;
  char rest = 0;
  if (std::sscanf(options.shard.c_str(), "%u/%u%c", &index, &count, &rest) != 2 || index < 1 ||
      index > count) {
    throw CLI::ValidationError("--shard", "I/N with 1 <= I <= N is expected");
  }
  return shard_of(list.models, index, count);
}

std::vector<Mesher> chosen_meshers(const RunOptions& options) {
  MesherPrograms programs;
  programs.supervisor = beside_this_program("tetproof-supervise");
  programs.tetgen = beside_this_program("tetproof-tetgen");
  programs.delmesher = std::filesystem::absolute(
      options.delmesher.empty() ? beside_this_program("delmesher").string() : options.delmesher);
  std::vector<Mesher> meshers;
  try {
    for (const std::string& name : options.meshers) meshers.push_back(make_mesher(name, programs));
  } catch (const std::runtime_error& error) {
    throw CLI::ValidationError("-m", error.what());
  }
  return meshers;
}

CampaignOptions campaign_options(const RunOptions& options) {
  CampaignOptions campaign;
  campaign.supervisor = beside_this_program("tetproof-supervise");
  campaign.self = std::filesystem::read_symlink("/proc/self/exe");
  campaign.database = options.database;
  campaign.keep = options.keep;
  campaign.limits.wall_seconds = options.timeout;
  campaign.limits.cpu_seconds = options.cpu > 0 ? options.cpu : options.timeout;
  campaign.limits.memory_bytes = options.memory_mebibytes << 20;
  campaign.limits.file_bytes = 64ull << 30;
  campaign.stop_after_seconds = options.stop_after;
  campaign.jobs = std::max(1u, options.jobs);
#ifdef TETPROOF_HAS_VERIFY
  campaign.verify = options.verify;
#endif
  campaign.terminal = isatty(STDOUT_FILENO) != 0;
  return campaign;
}

int run(const RunOptions& options) {
  const auto models = chosen_models(options);
  const auto meshers = chosen_meshers(options);
  handle_interrupts();
  fmt::print("{} models, {} meshers, results in {}\n", models.size(), meshers.size(),
             options.database);
  std::fflush(stdout);
  const auto folder = std::filesystem::absolute(options.database).parent_path();
  std::filesystem::create_directories(folder);
  const CampaignSummary summary = run_campaign(models, meshers, campaign_options(options));
  std::string text = fmt::format("{} runs were there already", summary.present);
  for (std::size_t d = 0; d < summary.counts.size(); ++d) {
    if (summary.counts[d] == 0) continue;
    text +=
        fmt::format(", {} {}", summary.counts[d], disposition_name(static_cast<Disposition>(d)));
  }
  fmt::print("{}{}\n", summary.interrupted ? "interrupted; " : "", text);
  if (summary.models_left_out > 0) {
    fmt::print("{} models were not begun within {} s; run again to go on\n",
               summary.models_left_out, options.stop_after);
  }
  if (summary.interrupted) return 130;
  return summary.models_left_out > 0 ? 5 : 0;
}

}  // namespace

Command add_run_command(CLI::App& tetproof) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* app = tetproof.add_subcommand(
      "run",
      "Run meshers on models, each in a child process under limits; resumes where it stopped");
  std::string names;
  for (const std::string& name : mesher_names()) names += (names.empty() ? "" : ", ") + name;
  app->add_option("paths", options->paths, "Surface files, or folders of .off .obj .stl .ply files")
      ->required();
  app->add_option("-m,--mesher", options->meshers,
                  names +
                      ", cmd:'PROG {in} {out.mesh}', NAME=cmd:'...' or "
                      "NAME=delmesher:'mesh OPTIONS'")
      ->required();
  app->add_option("--db", options->database, "SQLite file of the results")->required();
  app->add_option("-j,--jobs", options->jobs, "Runs at a time")->capture_default_str();
  app->add_option("--timeout", options->timeout, "Wall seconds per run")->capture_default_str();
  app->add_option("--cpu", options->cpu, "Processor seconds per run (default: as --timeout)");
  app->add_option("--memory", options->memory_mebibytes, "Resident MiB per run")
      ->capture_default_str();
  app->add_option("--stop-after", options->stop_after,
                  "Begin no further model after this many seconds (exit 5 if some are left)");
  app->add_option("--shard", options->shard, "I/N: only the I-th of N parts of the models");
  app->add_option("--delmesher-binary", options->delmesher,
                  "Our mesher (default: the one beside this program)");
  app->add_option("--keep", options->keep, "Folder in which to keep the meshes");
#ifdef TETPROOF_HAS_VERIFY
  app->add_flag("--verify", options->verify, "Ask the oracles about each mesh as well");
#endif
  return {app, [options] { return run(*options); }};
}

}  // namespace tetproof
