#include <fmt/core.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <set>

#include "corpus/campaigns/campaign.h"
#include "corpus/campaigns/printable.h"
#include "corpus/campaigns/process.h"
#include "corpus/cli/commands.h"

namespace tetproof {
namespace {

void on_interrupt(int) {
  interrupt_campaign();
}

std::array<unsigned, 2> shard_from(const std::string& text) {
  std::array<unsigned, 2> shard{};
  const char *at = text.data(), *end = at + text.size();
  const auto first = std::from_chars(at, end, shard[0]);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, shard[1]) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || shard[0] < 1 ||
      shard[0] > shard[1]) {
    throw UsageError("--shard: I/N with 1 <= I <= N is expected");
  }
  return shard;
}

std::vector<Model> chosen_models(const RunArguments& arguments) {
  const ModelList list = collect_models({arguments.paths.begin(), arguments.paths.end()});
  for (const auto& path : list.duplicates) {
    fmt::print("same content as another model, left out: {}\n", printable(path.string()));
  }
  std::vector<Model> models = list.models;
  if (!arguments.tier.empty()) models = tier_of(models, tier_from_name(arguments.tier));
  if (arguments.shard.empty()) return models;
  const auto [index, count] = shard_from(arguments.shard);
  return shard_of(models, index, count);
}

}  // namespace

std::vector<std::string> asked_meshers(const RunArguments& arguments) {
  std::vector<std::string> names = arguments.meshers;
  if (arguments.ablation) {
    for (const std::string& name : ablation_names()) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  if (names.empty()) throw UsageError("-m or --ablation is required");
  return names;
}

namespace {

std::vector<Mesher> chosen_meshers(const RunArguments& arguments) {
  MesherPrograms programs = programs_here();
  if (!arguments.delmesher.empty()) {
    programs.delmesher = std::filesystem::absolute(arguments.delmesher);
  }
  std::vector<Mesher> meshers;
  std::set<std::string> names;
  try {
    for (const std::string& name : asked_meshers(arguments)) {
      meshers.push_back(make_mesher(name, programs));
      // Tables know them by their names.
      if (!names.insert(meshers.back().name).second) {
        throw std::runtime_error("two meshers are called " + meshers.back().name +
                                 "; NAME=cmd:'...' gives another name");
      }
    }
    const auto of_plane = [](const Mesher& mesher) { return mesher.of_plane(); };
    if (std::ranges::any_of(meshers, of_plane) && !std::ranges::all_of(meshers, of_plane)) {
      throw std::runtime_error("meshers of the plane and of surfaces have no models in common");
    }
  } catch (const std::runtime_error& error) {
    throw UsageError(std::string("-m: ") + error.what());
  }
  return meshers;
}

CampaignOptions campaign_options(const RunArguments& arguments) {
  CampaignOptions campaign;
  campaign.supervisor = beside_this_program("tetproof-supervise");
  campaign.self = std::filesystem::read_symlink("/proc/self/exe");
  campaign.database = arguments.database;
  campaign.keep = arguments.keep;
  campaign.limits.wall_seconds = arguments.timeout;
  campaign.limits.cpu_seconds = arguments.cpu > 0 ? arguments.cpu : arguments.timeout;
  campaign.limits.memory_bytes = arguments.memory_mebibytes << 20;
  campaign.limits.file_bytes = 64ull << 30;
  Limits& verify = campaign.verify_limits;
  verify.wall_seconds = std::max(verify.wall_seconds, campaign.limits.wall_seconds);
  verify.cpu_seconds = std::max(verify.cpu_seconds, campaign.limits.cpu_seconds);
  verify.memory_bytes = std::max(verify.memory_bytes, campaign.limits.memory_bytes);
  campaign.keep_tetrahedra = arguments.keep_tetrahedra;
  for (const std::string& name : arguments.retry) {
    campaign.retry.insert(disposition_from_name(name));
  }
  campaign.stop_after_seconds = arguments.stop_after;
  campaign.jobs = std::max(1u, arguments.jobs);
#ifdef TETPROOF_HAS_VERIFY
  campaign.verify = arguments.verify || arguments.sidecars;
  campaign.sidecars = arguments.sidecars;
#else
  campaign.verify = false;
#endif
  campaign.solver = arguments.solver;
  campaign.terminal = isatty(STDOUT_FILENO) != 0;
  return campaign;
}

}  // namespace

void handle_interrupts() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;  // without SA_RESTART, so that poll() returns
  sigemptyset(&action.sa_mask);
  for (const int s : {SIGINT, SIGTERM, SIGHUP}) sigaction(s, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
}

void demand_folder_of(const std::string& file, const std::string& option) {
  const auto folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder)) {
    throw UsageError(option + ": " + folder.string() + ": no such folder");
  }
}

int run_command(const RunArguments& arguments) {
  demand_folder_of(arguments.database, "--db");
  const auto models = chosen_models(arguments);
  const auto meshers = chosen_meshers(arguments);
  handle_interrupts();
  fmt::print("{} models, {} meshers, results in {}\n", models.size(), meshers.size(),
             arguments.database);
  std::fflush(stdout);
  CampaignSummary summary;
  try {
    summary = run_campaign(models, meshers, campaign_options(arguments));
  } catch (const CannotRun& error) {
    throw UsageError(std::string("cannot be run: ") + error.what());
  }
  fmt::print("{}", count_table(summary.meshers));
  fmt::print("{}{} elapsed; {} of the runs were there already\n",
             summary.interrupted ? "interrupted; " : "", duration_text(summary.elapsed_seconds),
             summary.present);
  if (summary.models_left_out > 0) {
    fmt::print("{} models were not begun within {} s; run again to go on\n",
               summary.models_left_out, arguments.stop_after);
  }
  for (const std::string& name : summary.models_changed) {
    fmt::print(stderr, "tetproof: {}: has gone or changed; nothing is stored of its run\n",
               printable(name));
  }
  if (summary.interrupted) return 130;
  if (!summary.models_changed.empty()) return 3;
  return summary.models_left_out > 0 ? 5 : 0;
}

}  // namespace tetproof
