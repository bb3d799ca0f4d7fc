#include "reports/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "reports/selection.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr double kDeviations = 4;     // robust standard deviations that count as noise
constexpr std::size_t kFewPairs = 8;  // below, the spread says nothing

struct Pair {
  const RunRow* base;
  const RunRow* fresh;
};

int verdict_rank(const std::string& verdict) {
  static const std::map<std::string, int> kRanks = {
      {"exact", 4}, {"rounded", 3}, {"deviating", 2}, {"broken", 1}};
  const auto found = kRanks.find(verdict);
  return found == kRanks.end() ? 0 : found->second;
}

std::map<std::string, bool> oracles_of(const RunRow& row) {
  std::map<std::string, bool> passed;
  const auto json = nlohmann::json::parse(row.verdict_json, nullptr, false);
  if (!json.is_object()) return passed;
  for (const auto& oracle : json.value("oracles", nlohmann::json::array())) {
    passed[oracle.value("name", "")] = oracle.value("passed", false);
  }
  return passed;
}

// One measure of all pairs of a mesher.
struct Measure {
  FindingKind kind;
  const char* unit;
  double factor, least, divisor;  // the divisor turns the stored unit into the printed one
  double (*value)(const RunRow&);
  bool depends_on_machine;
};

class Gate {
 public:
  Gate(const std::vector<RunRow>& base, const std::vector<RunRow>& fresh,
       const GateOptions& options)
      : base_(select_runs(base)), fresh_(select_runs(fresh)), options_(options) {}

  GateReport run() {
    for (const std::string& mesher : base_.meshers) compare_mesher(mesher);
    for (const std::string& mesher : fresh_.meshers) {
      if (!base_.has(mesher)) report_.notes.push_back(mesher + ": not in the base");
    }
    return std::move(report_);
  }

 private:
  void compare_mesher(const std::string& mesher) {
    std::vector<Pair> both_ok;
    std::size_t better = 0, missing = 0;
    for (const auto& [model, row] : base_.runs.at(mesher)) {
      const RunRow* fresh = fresh_.run(mesher, model);
      if (fresh == nullptr) {
        ++missing;
        if (options_.missing_is_bad) add(FindingKind::missing, row, "not run");
        continue;
      }
      ++report_.pairs;
      const bool was_ok = row.disposition == Disposition::ok;
      const bool is_ok = fresh->disposition == Disposition::ok;
      better += is_ok && !was_ok;
      if (was_ok && !is_ok) {
        add(FindingKind::disposition, row,
            fmt::format("was ok, is {}: {}", disposition_name(fresh->disposition),
                        fresh->reason.substr(0, 200)));
        continue;
      }
      if (was_ok && is_ok) {
        compare_verdicts(row, *fresh);
        both_ok.push_back({&row, fresh});
      }
    }
    if (missing > 0 && !options_.missing_is_bad) note(mesher, missing, "runs of the base missing");
    if (better > 0) note(mesher, better, "runs are ok that were not");
    compare_measures(mesher, both_ok);
  }

  void note(const std::string& mesher, std::size_t count, const char* what) {
    report_.notes.push_back(fmt::format("{}: {} {}", mesher, count, what));
  }

  void add(FindingKind kind, const RunRow& row, std::string text) {
    report_.findings.push_back({kind, row.key.mesher, row.model_name, std::move(text)});
  }

  void compare_verdicts(const RunRow& base, const RunRow& fresh) {
    const std::string before = verdict_of(base), after = verdict_of(fresh);
    if (before.empty()) return;
    if (verdict_rank(after) < verdict_rank(before)) {
      add(FindingKind::verdict, base,
          fmt::format("verdict was {}, is {}", before, after.empty() ? "not asked" : after));
      return;
    }
    const auto now = oracles_of(fresh);
    for (const auto& [name, passed] : oracles_of(base)) {
      if (!passed) continue;
      const auto found = now.find(name);
      if (found == now.end() || !found->second) {
        add(FindingKind::verdict, base,
            fmt::format("oracle {} passed, {}", name,
                        found == now.end() ? "was not asked" : "does not"));
      }
    }
  }

  void compare_measures(const std::string& mesher, const std::vector<Pair>& pairs) {
    const Measure measures[] = {
        {FindingKind::time, "s", options_.time_factor, options_.least_seconds, 1,
         [](const RunRow& r) { return r.cpu_seconds; }, true},
        {FindingKind::memory, "MB", options_.memory_factor, options_.least_bytes, 1e6,
         [](const RunRow& r) { return static_cast<double>(r.peak_rss_bytes); }, true},
        {FindingKind::size, "tetrahedra", options_.size_factor, options_.least_tetrahedra, 1,
         [](const RunRow& r) { return r.mesh ? static_cast<double>(r.mesh->tetrahedra) : 0.0; },
         false}};
    for (const Measure& measure : measures) compare_measure(mesher, pairs, measure);
  }

  void compare_measure(const std::string& mesher, const std::vector<Pair>& pairs,
                       const Measure& m) {
    std::vector<double> log_ratios;
    std::vector<Pair> compared;
    std::set<std::string> hosts;
    for (const Pair& pair : pairs) {
      const double a = m.value(*pair.base), b = m.value(*pair.fresh);
      if (a <= 0 || b <= 0) continue;
      log_ratios.push_back(std::log(b / a));
      compared.push_back(pair);
      hosts.insert(pair.base->host);
      hosts.insert(pair.fresh->host);
    }
    if (compared.empty()) return;
    const bool normalise = m.depends_on_machine && hosts.size() > 1;
    const double middle = *median(log_ratios);
    if (normalise) {
      note_machine(mesher, m, std::exp(middle));
    } else {
      check_all(mesher, compared, m, middle);
    }
    const double expected = normalise ? middle : 0;
    const double noise = m.depends_on_machine ? kDeviations * spread(log_ratios) : 0;
    for (std::size_t i = 0; i < compared.size(); ++i) {
      const double excess = log_ratios[i] - expected;
      const double before = m.value(*compared[i].base) * std::exp(expected);
      const double after = m.value(*compared[i].fresh);
      // Where most models got slower, check_all has said so; the spread is about their middle.
      const bool stands_out = compared.size() == 1 || log_ratios[i] - middle > noise;
      if (excess > std::log(m.factor) && stands_out && after - before > m.least) {
        add(m.kind, *compared[i].base,
            fmt::format("{:.2f} times: {:.4g} {} instead of {:.4g}", std::exp(excess),
                        after / m.divisor, m.unit, before / m.divisor));
      }
    }
  }

  // 1.4826 times the median distance from the median, a standard deviation if all is normal.
  static double spread(const std::vector<double>& values) {
    if (values.size() < kFewPairs) return 0;
    const double middle = *median(values);
    std::vector<double> distances;
    for (const double value : values) distances.push_back(std::fabs(value - middle));
    return 1.4826 * *median(distances);
  }

  void check_all(const std::string& mesher, const std::vector<Pair>& pairs, const Measure& m,
                 double middle) {
    double before = 0, after = 0;
    for (const Pair& pair : pairs) {
      before += m.value(*pair.base);
      after += m.value(*pair.fresh);
    }
    if (pairs.size() < 2 || middle <= std::log(m.factor) || after - before <= m.least) return;
    report_.findings.push_back(
        {m.kind, mesher, "",
         fmt::format("{:.2f} times at the median of {} models", std::exp(middle), pairs.size())});
  }

  void note_machine(const std::string& mesher, const Measure& m, double ratio) {
    report_.notes.push_back(
        fmt::format("{}: different machines, {} taken relative to the median "
                    "ratio {:.2f}",
                    mesher, finding_name(m.kind), ratio));
  }

  Selection base_, fresh_;
  GateOptions options_;
  GateReport report_;
};

}  // namespace

GateReport compare_campaigns(const std::vector<RunRow>& base, const std::vector<RunRow>& fresh,
                             const GateOptions& options) {
  return Gate(base, fresh, options).run();
}

const char* finding_name(FindingKind kind) {
  static constexpr const char* kNames[] = {"disposition", "verdict", "time",
                                           "memory",      "size",    "missing"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace tetproof
