// A campaign as a Slurm job array: one task per shard, each with a database of its own. Lost tasks
// are submitted again and resume. The shards are merged when all are done.
//
// Laws: whatever is killed, the merged rows are those of a run on one machine (times, memory and
// hosts excepted). The same request again waits for running tasks, submits lost ones, and changes
// nothing once all is merged.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tetproof {

struct SlurmCampaign {
  std::filesystem::path folder;   // on a file system that all nodes see
  std::vector<std::string> task;  // command of a task, without --shard and --db
  std::string models;             // identifies a collection of models
  unsigned shards = 1;
  unsigned retries = 3;
  unsigned processors = 1;             // of a task
  std::uint64_t memory_mebibytes = 0;  // of a task
  double task_minutes = 0;             // 0: the partition's limit
  std::vector<std::string> sbatch;     // further options
};

enum class SlurmEnd : std::uint8_t {
  merged,       // all shards are done
  lost,         // tasks were lost more often than `retries`
  interrupted,  // by interrupt_campaign(): the tasks go on
  failed        // Slurm does not accept the job; `tell` got the reason
};

// Gets messages about the progress, a line each.
using Tell = std::function<void(const std::string&)>;

// Submits, waits, submits again.
SlurmEnd run_slurm_campaign(const SlurmCampaign& campaign, const Tell& tell);

std::filesystem::path shard_database(const SlurmCampaign& campaign, unsigned shard);

// The batch script of a task.
std::string task_script(const SlurmCampaign& campaign);
// "1-3,7": shards as sbatch takes them.
std::string array_of(const std::vector<unsigned>& shards);

}  // namespace tetproof
