#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "corpus/campaigns/plan.h"
#include "corpus/campaigns/slurm.h"
#include "corpus/cli/commands.h"
#include "corpus/models/models.h"
#include "reports/results.h"
#include "reports/sha256.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

// The memory that the runner itself and its measuring children need besides the mesher.
constexpr std::uint64_t kSpareMebibytes = 2048;

// The request as arguments of `tetproof run`, with absolute paths since tasks start elsewhere.
std::vector<std::string> task_of(const RunArguments& run) {
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe").string(), "run"};
  for (const std::string& path : run.paths) words.push_back(fs::absolute(path).string());
  const auto option = [&](const char* name, const std::string& value) {
    words.emplace_back(name);
    words.push_back(value);
  };
  for (const std::string& mesher : asked_meshers(run)) option("--mesher", mesher);
  // A cluster that ends a task may end a mesher first, and its runner lives on to store the row.
  std::set<std::string> retry(run.retry.begin(), run.retry.end());
  retry.insert("killed");
  for (const std::string& disposition : retry) option("--retry", disposition);
  option("--jobs", std::to_string(run.jobs));
  option("--timeout", fmt::format("{}", run.timeout));
  if (run.cpu > 0) option("--cpu", fmt::format("{}", run.cpu));
  option("--memory", std::to_string(run.memory_mebibytes));
  if (!run.tier.empty()) option("--tier", run.tier);
  if (!run.delmesher.empty()) option("--delmesher-binary", fs::absolute(run.delmesher).string());
  if (!run.keep.empty()) option("--keep", fs::absolute(run.keep).string());
  if (run.keep_tetrahedra > 0) {
    option("--keep-tetrahedra", std::to_string(run.keep_tetrahedra));
  }
  if (run.sidecars) words.emplace_back("--exact");
  if (run.solver) words.emplace_back("--solver");
  if (!run.verify) words.emplace_back("--no-verify");
  return words;
}

int merge(const SlurmCampaign& campaign, const std::string& database) {
  ResultsDatabase target(database, ResultsDatabase::Mode::write);
  std::size_t rows = 0, changed = 0;
  for (unsigned shard = 1; shard <= campaign.shards; ++shard) {
    // Shards may be empty, when there are more of them than models.
    if (!fs::exists(shard_database(campaign, shard))) continue;
    ResultsDatabase part(shard_database(campaign, shard), ResultsDatabase::Mode::read);
    for (const RunRow& row : part.rows()) {
      ++rows;
      changed += target.merge(row);
    }
  }
  fmt::print("{} rows of {} shards, {} new or newer in {}\n", rows, campaign.shards, changed,
             database);
  return 0;
}

int tell_plan(const SlurmArguments& arguments) {
  const RunArguments& run = arguments.run;
  std::vector<Model> models = collect_models({run.paths.begin(), run.paths.end()}).models;
  if (!run.tier.empty()) models = tier_of(models, tier_from_name(run.tier));
  ResultsDatabase measured(run.database, ResultsDatabase::Mode::read);
  const Plan plan =
      plan_of(models, asked_meshers(run), measured.rows(), arguments.shards, run.timeout);
  fmt::print("{} models\n{}", models.size(),
             to_text(plan, arguments.shards, std::max(1u, run.jobs)));
  if (arguments.of > 0) {
    fmt::print("{}", to_text(extrapolated(plan, arguments.of, arguments.shards), arguments.shards,
                             run.jobs));
  }
  return 0;
}

}  // namespace

int slurm_command(const SlurmArguments& arguments) {
  const RunArguments& run = arguments.run;
  if (arguments.plan) return tell_plan(arguments);
  if (!run.shard.empty() || run.stop_after > 0) {
    throw UsageError("--shard and --stop-after make no sense here");
  }
  demand_folder_of(run.database, "--db");
  SlurmCampaign campaign;
  std::string models;
  for (const Model& model : collect_models({run.paths.begin(), run.paths.end()}).models) {
    models += model.sha256;
  }
  campaign.models = sha256_of(models);
  campaign.folder = fs::absolute(run.database).string() + ".slurm";
  campaign.task = task_of(run);
  campaign.shards = arguments.shards;
  campaign.retries = arguments.retries;
  campaign.processors = std::max(1u, run.jobs);
  campaign.memory_mebibytes = run.memory_mebibytes * campaign.processors + kSpareMebibytes;
  campaign.task_minutes = arguments.task_minutes;
  campaign.sbatch = arguments.sbatch;
  handle_interrupts();
  const SlurmEnd end = run_slurm_campaign(campaign, [](const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  });
  switch (end) {
    case SlurmEnd::merged:
      return merge(campaign, run.database);
    case SlurmEnd::interrupted:
      fmt::print("interrupted; the tasks go on, the same command waits for them again\n");
      return 130;
    case SlurmEnd::lost:
      throw std::runtime_error("tasks were lost too often; see the logs in " +
                               campaign.folder.string());
    case SlurmEnd::failed:
      break;
  }
  throw std::runtime_error("the job was not accepted");
}

}  // namespace tetproof
