#include "reports/gate_runs.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "reports/gate.h"
#include "reports/selection.h"

namespace tetproof {
namespace {

using Json = nlohmann::json;

Json object_of(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  return json.is_object() ? json : Json::object();
}

// The worst of the repetitions decides how the run ended; a run killed from outside says nothing.
// One that nobody vouches for is worse than one that is verified.
int weight_of_ending(const RunRow& row) {
  if (row.disposition == Disposition::killed) return 0;
  if (!has_mesh(row)) return 3;
  return is_verified(row) ? 1 : 2;
}

// Among those that ended alike the verdict decides.
bool is_worse(const RunRow* a, const RunRow* b) {
  const auto rank = [](const RunRow& row) {
    return std::pair(-weight_of_ending(row), verdict_rank(verdict_of(row)));
  };
  return rank(*a) < rank(*b);
}

Run parsed(const RunRow& row) {
  Run run{row, {}, {}, object_of(row.verdict_json), object_of(row.stats_json), {}};
  try {
    run.verdict.value("error", "");
    run.verdict.value("unproven", std::vector<std::string>{});
    for (const Json& oracle : run.verdict.value("oracles", Json::array())) {
      // One that is there twice has passed if it has both times.
      const bool passed = oracle.value("passed", false);
      bool& all = run.passed.try_emplace(oracle.value("name", ""), true).first->second;
      all = all && passed;
    }
  } catch (const Json::exception&) {
    throw std::runtime_error(row.key.mesher + " " + row.model_name +
                             ": a verdict of another shape");
  }
  return run;
}

void join(std::map<std::string, bool>& passed, const std::map<std::string, bool>& more) {
  std::erase_if(passed, [&](const auto& oracle) { return !more.contains(oracle.first); });
  for (auto& [name, has] : passed) has = has && more.at(name);
}

// 0 or less has not been measured.
template <typename Number>
void take_less(Number& least, Number value) {
  if (value > 0 && (!(least > 0) || value < least)) least = value;
}

Run run_of(const std::vector<const RunRow*>& repetitions) {
  const RunRow* decisive = *std::ranges::min_element(repetitions, is_worse);
  Run run = parsed(*decisive);
  for (const RunRow* row : repetitions) {
    run.started.push_back(row->started);
    if (!has_mesh(*row)) continue;
    take_less(run.row.cpu_seconds, row->cpu_seconds);
    take_less(run.row.peak_rss_bytes, row->peak_rss_bytes);
    if (row == decisive) continue;
    run.others.push_back(parsed(*row));
    if (is_verified(*row)) join(run.passed, run.others.back().passed);
  }
  return run;
}

std::optional<double> extreme(const Run& run, const Getter& value,
                              const double& (*better)(const double&, const double&)) {
  std::optional<double> result = value(run);
  for (const Run& other : run.others) {
    const std::optional<double> x = value(other);
    result = result && x ? std::optional(better(*result, *x)) : std::nullopt;
  }
  return result;
}

}  // namespace

int verdict_rank(const std::string& verdict) {
  static const std::map<std::string, int> kRanks = {
      {"exact", 4}, {"rounded", 3}, {"deviating", 2}, {"broken", 1}};
  const auto found = kRanks.find(verdict);
  return found == kRanks.end() ? 0 : found->second;
}

bool has_mesh(const RunRow& row) {
  return row.disposition == Disposition::ok || row.disposition == Disposition::unverified;
}

bool is_verified(const RunRow& row) {
  return row.disposition == Disposition::ok && verdict_rank(verdict_of(row)) > 0;
}

std::optional<double> Run::figure(const char* oracle, const char* name) const {
  for (const Json& entry : verdict.value("oracles", Json::array())) {
    if (entry.value("name", "") != oracle) continue;
    const Json figures = entry.value("figures", Json::object());
    if (figures.contains(name) && figures.at(name).is_number()) return figures.at(name);
  }
  return std::nullopt;
}

std::optional<double> least(const Run& run, const Getter& value) {
  return extreme(run, value, std::min<double>);
}

std::optional<double> most(const Run& run, const Getter& value) {
  return extreme(run, value, std::max<double>);
}

Runs runs_of(const std::vector<RunRow>& rows) {
  Runs runs;
  std::map<RunKey, std::vector<const RunRow*>> by_key;
  std::map<std::array<std::string, 2>, const RunRow*> at;  // without a time
  for (const RunRow& row : rows) {
    by_key[row.key].push_back(&row);
    if (!row.started.empty()) continue;
    const auto [seen, fresh] = at.try_emplace({row.key.mesher, row.key.model_sha256}, &row);
    if (!fresh && seen->second->key != row.key) {
      throw std::runtime_error(row.key.mesher + " " + row.model_name +
                               ": runs of different limits, flags or versions, and no times (as in "
                               "a stable export) that say which came last");
    }
  }
  for (const auto& [mesher, by_model] : select_runs(rows).runs) {
    for (const auto& [model, row] : by_model) {
      runs[mesher].emplace(model, run_of(by_key.at(row.key)));
    }
  }
  return runs;
}

}  // namespace tetproof
