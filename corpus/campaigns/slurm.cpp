#include "corpus/campaigns/slurm.h"

#include <fmt/format.h>
#include <poll.h>

#include <array>
#include <cctype>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>

#include "corpus/campaigns/campaign.h"
#include "corpus/campaigns/disposition.h"
#include "corpus/campaigns/shell.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

constexpr int kPollMilliseconds = 2000;
constexpr int kSilentPolls = 5;  // squeue may fail for a while, for example when slurmctld restarts

struct Answer {
  bool ok = false;
  std::string text;  // standard output and errors
};

Answer ask(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += shell_quoted(word) + " ";
  Answer answer;
  FILE* pipe = popen((line + "2>&1").c_str(), "r");
  if (pipe == nullptr) return answer;
  std::array<char, 4096> buffer;
  while (const std::size_t size = fread(buffer.data(), 1, buffer.size(), pipe)) {
    answer.text.append(buffer.data(), size);
  }
  answer.ok = pclose(pipe) == 0;
  return answer;
}

class Waiter {
 public:
  Waiter(const SlurmCampaign& campaign, const Tell& tell) : campaign_(campaign), tell_(tell) {}

  SlurmEnd run() {
    fs::create_directories(campaign_.folder);
    begin_anew_if_changed();
    std::string job = remembered_job();
    if (!job.empty()) tell_("job " + job + " was submitted before");
    for (unsigned attempt = 0;; ++attempt) {
      if (!job.empty() && !wait_for(job)) return SlurmEnd::interrupted;
      const auto open = open_shards();
      if (open.empty()) return SlurmEnd::merged;
      if (attempt > campaign_.retries) return SlurmEnd::lost;
      if (!job.empty()) tell_(fmt::format("lost: tasks {}", array_of(open)));
      const auto submitted = submit(open);
      if (!submitted) return SlurmEnd::failed;
      job = *submitted;
      std::ofstream(campaign_.folder / "job") << job << '\n';
      tell_(fmt::format("job {}: tasks {}", job, array_of(open)));
    }
  }

 private:
  // Finished shards are finished for one request only; their rows stay in any case.
  void begin_anew_if_changed() const {
    const std::string script = task_script(campaign_);
    std::ifstream file(campaign_.folder / "task.sh");
    const std::string before{std::istreambuf_iterator<char>(file), {}};
    if (before == script) return;
    for (const auto& entry : fs::directory_iterator(campaign_.folder)) {
      if (entry.path().extension() == ".done") fs::remove(entry.path());
    }
    fs::remove(campaign_.folder / "job");
    std::ofstream(campaign_.folder / "task.sh") << script;
  }

  std::string remembered_job() const {
    std::ifstream file(campaign_.folder / "job");
    std::string job;
    file >> job;
    return job;
  }

  std::vector<unsigned> open_shards() const {
    std::vector<unsigned> open;
    for (unsigned shard = 1; shard <= campaign_.shards; ++shard) {
      if (!fs::exists(campaign_.folder / fmt::format("shard-{}.done", shard)))
        open.push_back(shard);
    }
    return open;
  }

  std::optional<std::string> submit(const std::vector<unsigned>& shards) const {
    std::vector<std::string> words = {"sbatch",
                                      "--parsable",
                                      "--array=" + array_of(shards),
                                      fmt::format("--cpus-per-task={}", campaign_.processors),
                                      "--job-name=tetproof",
                                      "--no-requeue",
                                      "--output=" + (campaign_.folder / "shard-%a.log").string(),
                                      "--open-mode=append"};
    if (campaign_.memory_mebibytes > 0) {
      words.push_back(fmt::format("--mem={}M", campaign_.memory_mebibytes));
    }
    if (campaign_.task_minutes > 0) {
      words.push_back(fmt::format("--time={:.0f}", campaign_.task_minutes));
    }
    words.insert(words.end(), campaign_.sbatch.begin(), campaign_.sbatch.end());
    words.push_back((campaign_.folder / "task.sh").string());
    const Answer answer = ask(words);
    const std::string id = last_line(answer.text);
    if (!answer.ok || id.empty() || std::isdigit(static_cast<unsigned char>(id[0])) == 0) {
      tell_("sbatch: " + id);
      return std::nullopt;
    }
    return id.substr(0, id.find(';'));  // with several clusters the name of one follows
  }

  // Waits until no task of the job is left; false if interrupted.
  bool wait_for(const std::string& job) const {
    int silent = 0;
    std::string before;
    while (!campaign_interrupted()) {
      const Answer answer =
          ask({"squeue", "--noheader", "--array", "--format=%T", "--jobs=" + job});
      // Slurm forgets a job some minutes after its end and then calls its id invalid.
      const bool forgotten = answer.text.find("Invalid job id") != std::string::npos;
      if (forgotten || (answer.ok && answer.text.find_first_not_of(" \n") == std::string::npos)) {
        return true;
      }
      if (!answer.ok && ++silent > kSilentPolls) tell_("squeue: " + last_line(answer.text));
      if (answer.ok) {
        silent = 0;
        const std::string now = counts_of(answer.text);
        if (now != before) tell_(now);
        before = now;
      }
      poll(nullptr, 0, kPollMilliseconds);
    }
    return false;
  }

  std::string counts_of(const std::string& states) const {
    std::size_t running = 0, others = 0;
    std::istringstream lines(states);
    for (std::string state; lines >> state;) ++(state == "RUNNING" ? running : others);
    return fmt::format("{} tasks run, {} wait, {} of {} are done", running, others,
                       campaign_.shards - open_shards().size(), campaign_.shards);
  }

  const SlurmCampaign& campaign_;
  const Tell& tell_;
};

}  // namespace

fs::path shard_database(const SlurmCampaign& campaign, unsigned shard) {
  return campaign.folder / fmt::format("shard-{}.sqlite", shard);
}

std::string task_script(const SlurmCampaign& campaign) {
  std::string command;
  for (const std::string& word : campaign.task) command += shell_quoted(word) + " ";
  const std::string stem = shell_quoted((campaign.folder / "shard-").string());
  // A task that ends without making its .done file is lost, whatever ended it.
  return fmt::format(
      "#!/bin/sh\n# models: {}\n"
      "echo \"== $(date -u +%FT%TZ) task $SLURM_ARRAY_TASK_ID on $(hostname)\"\n"
      "{}--db {}\"$SLURM_ARRAY_TASK_ID.sqlite\" --shard \"$SLURM_ARRAY_TASK_ID/{}\" &&\n"
      "  : >{}\"$SLURM_ARRAY_TASK_ID.done\"\n",
      campaign.models, command, stem, campaign.shards, stem);
}

std::string array_of(const std::vector<unsigned>& shards) {
  std::string text;
  for (std::size_t i = 0; i < shards.size();) {
    std::size_t end = i;
    while (end + 1 < shards.size() && shards[end + 1] == shards[end] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", shards[i]);
    if (end > i) text += fmt::format("-{}", shards[end]);
    i = end + 1;
  }
  return text;
}

SlurmEnd run_slurm_campaign(const SlurmCampaign& campaign, const Tell& tell) {
  return Waiter(campaign, tell).run();
}

}  // namespace tetproof
