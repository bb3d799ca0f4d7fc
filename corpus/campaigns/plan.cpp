#include "corpus/campaigns/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr std::size_t kNearest = 9;
constexpr double kMebibyte = 1048576;
constexpr int kResamplings = 1000;

std::string hours(double seconds) {
  return fmt::format("{:.2f} h", seconds / 3600);
}

// The measured runs of one mesher.
class Measured {
 public:
  explicit Measured(double timeout) : timeout_(timeout) {}

  void add(const RunRow& row) {
    const double oracles = row.verify_seconds.value_or(0);
    longest_oracles_ = std::max(longest_oracles_, oracles);
    by_model_[row.key.model_sha256] = {row.cpu_seconds + oracles, row.peak_rss_bytes};
    if (row.model_bytes == 0) return;
    const auto bytes = static_cast<double>(row.model_bytes);
    per_byte_.push_back({bytes, (row.cpu_seconds + oracles) / bytes,
                         static_cast<double>(row.peak_rss_bytes) / bytes});
  }

  const PlannedCost* known(const Model& model) const {
    const auto found = by_model_.find(model.sha256);
    return found == by_model_.end() ? nullptr : &found->second;
  }

  PlannedCost estimate(const Model& model) const {
    const double bytes = static_cast<double>(std::max<std::uint64_t>(model.bytes, 1));
    std::vector<PerByte> near = per_byte_;
    const auto distance = [bytes](const PerByte& p) {
      return std::fabs(std::log(p.bytes / bytes));
    };
    std::sort(near.begin(), near.end(), [&](const PerByte& a, const PerByte& b) {
      return std::pair(distance(a), a.seconds) < std::pair(distance(b), b.seconds);
    });
    near.resize(std::min(near.size(), kNearest));
    std::vector<double> seconds, memory;
    for (const PerByte& p : near) {
      seconds.push_back(p.seconds);
      memory.push_back(p.memory);
    }
    return {std::min(median(seconds).value_or(0) * bytes, timeout_ + longest_oracles_),
            static_cast<std::uint64_t>(quantile(memory, 0.9).value_or(0) * bytes)};
  }

  bool empty() const { return per_byte_.empty(); }

 private:
  struct PerByte {
    double bytes, seconds, memory;
  };
  double timeout_, longest_oracles_ = 0;
  std::map<std::string, PlannedCost> by_model_;
  std::vector<PerByte> per_byte_;
};

}  // namespace

Plan plan_of(const std::vector<Model>& models, const std::vector<std::string>& meshers,
             const std::vector<RunRow>& rows, unsigned shards, double timeout) {
  Plan plan;
  std::map<std::string, double> seconds_of_model;
  for (const std::string& name : meshers) {
    Measured measured(timeout);
    for (const RunRow& row : rows) {
      if (row.key.mesher == name && row.disposition != Disposition::killed) measured.add(row);
    }
    if (measured.empty()) {
      throw std::runtime_error("nothing was measured of " + name +
                               "; run some models of all sizes first");
    }
    PlannedMesher& mesher = plan.meshers.emplace_back();
    mesher.name = name;
    for (const Model& model : models) {
      const PlannedCost* known = measured.known(model);
      const PlannedCost cost = known != nullptr ? *known : measured.estimate(model);
      ++mesher.runs;
      mesher.measured += known != nullptr;
      mesher.seconds += cost.seconds;
      mesher.longest_run = std::max(mesher.longest_run, cost.seconds);
      mesher.peak_bytes = std::max(mesher.peak_bytes, cost.peak_bytes);
      seconds_of_model[model.sha256] += cost.seconds;
    }
    plan.runs += mesher.runs;
    plan.seconds += mesher.seconds;
    plan.longest_run = std::max(plan.longest_run, mesher.longest_run);
    plan.peak_bytes = std::max(plan.peak_bytes, mesher.peak_bytes);
  }
  for (unsigned shard = 1; shard <= shards; ++shard) {
    double seconds = 0;
    for (const Model& model : shard_of(models, shard, shards)) {
      seconds += seconds_of_model[model.sha256];
    }
    plan.longest_shard = std::max(plan.longest_shard, seconds);
  }
  for (const Model& model : models) plan.by_model.push_back(seconds_of_model[model.sha256]);
  return plan;
}

Extrapolation extrapolated(const Plan& plan, std::size_t models, unsigned shards) {
  if (plan.by_model.empty()) throw std::runtime_error("there are no models to go by");
  if (models < plan.by_model.size()) {
    throw std::runtime_error(
        fmt::format("{} models are not a sample of {}", plan.by_model.size(), models));
  }
  const std::size_t size = plan.by_model.size();
  Extrapolation all;
  all.models = models;
  all.seconds = plan.seconds * static_cast<double>(models) / static_cast<double>(size);
  std::mt19937_64 random(1);
  std::vector<double> totals, longest;
  std::vector<double> sample(size);
  std::vector<double> of_shard(std::max(1u, shards));
  for (int i = 0; i < kResamplings; ++i) {
    for (double& seconds : sample) seconds = plan.by_model[random() % size];
    std::fill(of_shard.begin(), of_shard.end(), 0);
    double total = 0;
    for (std::size_t m = 0; m < models; ++m) {
      const double seconds = sample[random() % size];
      total += seconds;
      of_shard[m % of_shard.size()] += seconds;
    }
    totals.push_back(total);
    longest.push_back(*std::max_element(of_shard.begin(), of_shard.end()));
  }
  all.low = *quantile(totals, 0.025);
  all.high = *quantile(totals, 0.975);
  all.longest_shard = *median(longest);
  return all;
}

std::string to_text(const Extrapolation& all, unsigned shards, unsigned jobs) {
  return fmt::format(
      "{} models like these: {} of processor time with the oracles, {} to {} in 95 of 100 draws; "
      "the longest of {} shards {}\n",
      all.models, hours(all.seconds), hours(all.low), hours(all.high), shards,
      hours(all.longest_shard / std::max(1u, jobs)));
}

std::string to_text(const Plan& plan, unsigned shards, unsigned jobs) {
  const auto mebibytes = [](std::uint64_t bytes) {
    return fmt::format("{:.0f} MiB", static_cast<double>(bytes) / kMebibyte);
  };
  std::string text;
  for (const PlannedMesher& m : plan.meshers) {
    text += fmt::format("{}: {} runs, {} of them measured; {}, the longest {:.0f} s; up to {}\n",
                        m.name, m.runs, m.measured, hours(m.seconds), m.longest_run,
                        mebibytes(m.peak_bytes));
  }
  const double parallel = std::max(1u, jobs);
  text += fmt::format("{} runs, {} of processor time with the oracles\n", plan.runs,
                      hours(plan.seconds));
  text += fmt::format("{} shards of {} at a time: {} for the longest, {} on average\n", shards,
                      jobs, hours(std::max(plan.longest_shard / parallel, plan.longest_run)),
                      hours(plan.seconds / shards / parallel));
  text += fmt::format("memory of a run: up to {}\n", mebibytes(plan.peak_bytes));
  const double average = plan.runs == 0 ? 0 : plan.seconds / static_cast<double>(plan.runs);
  text += fmt::format(
      "a lost task is submitted again and repeats what it was at, {:.0f} s at most and {:.1f} s on "
      "average for each run at a time; what it has stored stays\n",
      plan.longest_run, average);
  return text;
}

}  // namespace tetproof
