#include "reports/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "reports/gate_runs.h"
#include "reports/resampling.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

using Json = nlohmann::json;

constexpr double kDeviations = 4;          // robust standard deviations that count as noise
constexpr double kLongestSeconds = 1;      // a run's largest weight in the mean of all
constexpr double kLargestBytes = 64e6;     // the same for memory
constexpr double kMostTetrahedra = 10000;  // and for sizes
constexpr double kLargestRatio = 4;        // an angle's largest part in the mean of all
constexpr const char* kOnlyBase = "only the base has";
constexpr int kTurns = 3;  // changes of side in base, new, base, new

struct Pair {
  const Run* base;
  const Run* fresh;
};

Getter of(std::optional<MeshColumns> RunRow::*part, double MeshColumns::*column) {
  return [=](const Run& run) -> std::optional<double> {
    if (!(run.row.*part)) return std::nullopt;
    return (*(run.row.*part)).*column;
  };
}

Getter of(std::optional<double> MeshColumns::*column) {
  return [=](const Run& run) { return run.row.mesh ? (*run.row.mesh).*column : std::nullopt; };
}

// The difference of a largest angle from 180 degrees, so that more is better.
Getter rest_of(double MeshColumns::*column) {
  return [=](const Run& run) -> std::optional<double> {
    if (!run.row.mesh) return std::nullopt;
    return 180 - (*run.row.mesh).*column;
  };
}

std::optional<double> tetrahedra(const Run& run) {
  if (!run.row.mesh) return std::nullopt;
  return static_cast<double>(run.row.mesh->tetrahedra);
}

// An angle, or its difference from 180 degrees, or gamma; more is better.
struct Angle {
  FindingKind kind;
  const char* name;
  Getter value;
  double factor, total_factor;
  const char* unit = " degrees";
};

// Processor time or memory.
struct Cost {
  FindingKind kind;
  const char* name;
  const char* unit;
  double divisor;  // turns the stored unit into the printed one
  double factor, total_factor, least, largest_weight;
  double (*value)(const RunRow&);
};

class Gate {
 public:
  Gate(const std::vector<RunRow>& base, const std::vector<RunRow>& fresh,
       const GateOptions& options)
      : base_(runs_of(base)), fresh_(runs_of(fresh)), options_(options) {}

  GateReport run() {
    for (const auto& [mesher, runs] : base_) compare_mesher(mesher, runs);
    for (const auto& [mesher, runs] : fresh_) {
      if (!base_.contains(mesher)) report_.notes.push_back(mesher + ": not in the base");
    }
    return std::move(report_);
  }

 private:
  void compare_mesher(const std::string& mesher, const std::map<std::string, Run>& runs) {
    std::vector<Pair> pairs, meshes;
    std::size_t better = 0, missing = 0;
    for (const auto& [model, base] : runs) {
      const Run* fresh = find_fresh(mesher, model);
      if (fresh == nullptr) {
        ++missing;
        if (options_.missing_is_bad) add(FindingKind::missing, base, "was run, is not");
        continue;
      }
      pairs.push_back({&base, fresh});
      better += (has_mesh(fresh->row) && !has_mesh(base.row)) ||
                (is_verified(fresh->row) && !is_verified(base.row));
      if (compare_endings(base, *fresh)) meshes.push_back({&base, fresh});
    }
    if (missing > 0 && !options_.missing_is_bad) note(mesher, missing, "runs of the base missing");
    if (better > 0) note(mesher, better, "runs are ok or verified that were not");
    report_.pairs += pairs.size();
    report_.both_ok += meshes.size();
    compare_identities(mesher, pairs);
    compare_angles(mesher, meshes);
    compare_slivers(mesher, meshes);
    compare_sizes(mesher, meshes);
    compare_costs(mesher, meshes);
  }

  const Run* find_fresh(const std::string& mesher, const std::string& model) const {
    const auto runs = fresh_.find(mesher);
    if (runs == fresh_.end()) return nullptr;
    const auto found = runs->second.find(model);
    return found == runs->second.end() ? nullptr : &found->second;
  }

  void note(const std::string& mesher, std::size_t count, const char* what) {
    report_.notes.push_back(fmt::format("{}: {} {}", mesher, count, what));
  }

  void differ(const std::string& mesher, const std::string& text) {
    report_.differences.push_back(mesher + ": " + text);
  }

  void add(FindingKind kind, const Run& run, std::string text) {
    report_.findings.push_back({kind, run.row.key.mesher, run.row.model_name, std::move(text)});
  }

  void add_for_all(FindingKind kind, const std::string& mesher, std::string text) {
    report_.findings.push_back({kind, mesher, "", std::move(text)});
  }

  // Returns whether there are two meshes to compare.
  bool compare_endings(const Run& base, const Run& fresh) {
    if (!has_mesh(base.row)) return false;
    if (!has_mesh(fresh.row)) {
      add(FindingKind::disposition, base,
          fmt::format("was {}, is {}: {}", disposition_name(base.row.disposition),
                      disposition_name(fresh.row.disposition), fresh.row.reason.substr(0, 200)));
      return false;
    }
    if (!is_verified(base.row)) return true;
    const std::string before = verdict_of(base.row), after = verdict_of(fresh.row);
    if (!is_verified(fresh.row)) {
      std::string why = fresh.verdict.value("error", fresh.row.reason);
      if (why.empty()) why = fresh.row.verdict_json.empty() ? "the oracles were not asked" : after;
      add(FindingKind::unverified, base, fmt::format("was {}, is unverified: {}", before, why));
      return true;
    }
    ++report_.verified;
    if (verdict_rank(after) < verdict_rank(before)) {
      add(FindingKind::verdict, base, fmt::format("verdict was {}, is {}", before, after));
    }
    compare_oracles(base, fresh);
    compare_conformity(base, fresh);
    return true;
  }

  void compare_oracles(const Run& base, const Run& fresh) {
    // Meshes are repaired after rounding only if they need it. A mesh that does not need it is no
    // worse.
    const auto is_repair = [](const auto& oracle) {
      return oracle.first.starts_with("unrepaired-");
    };
    const bool repaired = std::any_of(fresh.passed.begin(), fresh.passed.end(), is_repair);
    for (const auto& oracle : base.passed) {
      const auto& [name, passed] = oracle;
      if (!passed || (is_repair(oracle) && !repaired)) continue;
      const auto now = fresh.passed.find(name);
      if (now != fresh.passed.end() && now->second) continue;
      const bool silent = now == fresh.passed.end();
      if (silent && options_.may_be_silent.contains(name)) {
        ++silent_[name];
        continue;
      }
      add(FindingKind::oracle, base,
          fmt::format("oracle {} passed, {}", name, silent ? "was not asked" : "does not"));
    }
    const std::set<std::string> before = unproven(base);
    for (const std::string& promise : unproven(fresh)) {
      if (before.contains(promise)) continue;
      add(FindingKind::oracle, base, fmt::format("no longer proven: {}", promise));
    }
  }

  // What the first line of a verdict names, without the numbers in brackets.
  static std::set<std::string> unproven(const Run& run) {
    std::set<std::string> promises;
    for (const Json& promise : run.verdict.value("unproven", Json::array())) {
      const std::string text = promise.get<std::string>();
      promises.insert(text.substr(0, text.find(" (")));
    }
    return promises;
  }

  // If coordinates are written with a bit less, rounded points are twice as far off, and input
  // vertices with full mantissas are moved.
  void compare_conformity(const Run& base, const Run& fresh) {
    const auto deviation = [](const Run& run) -> std::optional<double> {
      const auto found = run.verdict.find("deviation_ulps");
      if (found == run.verdict.end() || !found->is_number()) return std::nullopt;
      return found->get<double>();
    };
    const auto moved = [](const Run& run) {
      return run.figure("conformity", "input vertices moved");
    };
    const std::string& mesher = base.row.key.mesher;
    const auto off = most(base, deviation), off_now = most(fresh, deviation);
    if (both(mesher, "largest deviation", off, off_now)) {
      const double before = *off, after = *off_now;
      if (after > before + options_.deviation_ulps && after > 1.5 * before) {
        add(FindingKind::conformity, base,
            fmt::format("surface off by {:.3g} ulp instead of {:.3g}", after, before));
      }
    }
    const auto count = most(base, moved), count_now = most(fresh, moved);
    if (both(mesher, "input vertices moved", count, count_now) && *count_now > *count) {
      add(FindingKind::conformity, base,
          fmt::format("{:.0f} input vertices moved instead of {:.0f}", *count_now, *count));
    }
  }

  // Can the measure be compared? Counts it if not.
  bool both(const std::string& mesher, const char* measure, const std::optional<double>& base,
            const std::optional<double>& fresh) {
    if (base && fresh) return true;
    if (base || fresh) ++lacking_[mesher][{measure, base ? kOnlyBase : "only the new side has"}];
    return false;
  }

  void compare_identities(const std::string& mesher, const std::vector<Pair>& pairs) {
    compare_texts(mesher, pairs, "flags", [](const Run& r) { return r.row.key.flags; });
    compare_texts(mesher, pairs, "versions", [](const Run& r) { return r.row.key.version; });
    compare_texts(mesher, pairs, "limits", [](const Run& r) { return r.row.key.limits; });
    std::vector<Pair> told;  // by the base: older results do not
    std::ranges::copy_if(pairs, std::back_inserter(told),
                         [](const Pair& pair) { return !pair.base->row.promise.empty(); });
    compare_texts(mesher, told, "promises", [](const Run& r) { return r.row.promise; });
    compare_texts(mesher, told, "regions", [](const Run& r) { return r.row.region; });
    compare_settings(mesher, pairs);
    compare_repetitions(mesher, pairs);
  }

  void compare_repetitions(const std::string& mesher, const std::vector<Pair>& pairs) {
    const auto differs = [](const Run& run) {
      return std::ranges::any_of(run.others, [&](const Run& other) {
        return other.row.mesh != run.row.mesh || verdict_of(other.row) != verdict_of(run.row);
      });
    };
    std::size_t base = 0, fresh = 0;
    for (const Pair& pair : pairs) {
      base += differs(*pair.base);
      fresh += differs(*pair.fresh);
    }
    for (const auto& [count, side] : {std::pair(base, "base"), std::pair(fresh, "new")}) {
      if (count > 0) {
        differ(mesher, fmt::format("repetitions differ: {} of {} models of the {} side; the worst "
                                   "of each measure counts",
                                   count, pairs.size(), side));
      }
    }
  }

  template <typename Text>
  void compare_texts(const std::string& mesher, const std::vector<Pair>& pairs, const char* what,
                     Text text) {
    std::map<std::pair<std::string, std::string>, std::size_t> differing;
    for (const Pair& pair : pairs) {
      if (text(*pair.base) != text(*pair.fresh)) ++differing[{text(*pair.base), text(*pair.fresh)}];
    }
    for (const auto& [texts, count] : differing) {
      differ(mesher, fmt::format("{} differ: base \"{}\", new \"{}\" ({} of {} pairs)", what,
                                 texts.first, texts.second, count, pairs.size()));
    }
  }

  // Compares the settings by the mesher's account: with the same flags, its defaults.
  void compare_settings(const std::string& mesher, const std::vector<Pair>& pairs) {
    std::map<std::string, std::size_t> differing;
    for (const Pair& pair : pairs) {
      const Json before = pair.base->stats.value("parameters", Json::object());
      const Json after = pair.fresh->stats.value("parameters", Json::object());
      if (!before.is_object() || !after.is_object() || before.empty() || after.empty()) continue;
      for (const auto& [name, value] : before.items()) {
        const std::string now = after.contains(name) ? after.at(name).dump() : "none";
        if (now != value.dump()) ++differing[fmt::format("{} {} -> {}", name, value.dump(), now)];
      }
    }
    for (const auto& [text, count] : differing) {
      differ(mesher, fmt::format("settings differ by the mesher's account: {} ({} of {} pairs)",
                                 text, count, pairs.size()));
    }
  }

  void compare_angles(const std::string& mesher, const std::vector<Pair>& pairs) {
    const double one = options_.angle_factor, all = options_.total_angle_factor;
    const double one_mean = options_.mean_factor, all_means = options_.total_mean_factor;
    using enum FindingKind;
    using Columns = MeshColumns;
    const Angle angles[] = {
        {face_angle, "smallest face angle", of(&RunRow::mesh, &Columns::min_face_angle), one, all},
        {dihedral, "smallest dihedral", of(&RunRow::mesh, &Columns::min_dihedral), one, all},
        {dihedral, "refined smallest dihedral", of(&RunRow::refined, &Columns::min_dihedral), one,
         all},
        {mean_angle, "mean of smallest face angles",
         of(&RunRow::mesh, &Columns::mean_min_face_angle), one_mean, all_means},
        {mean_angle, "180 degrees less the mean of largest face angles",
         rest_of(&Columns::mean_max_face_angle), one_mean, all_means},
        {mean_angle, "mean of smallest dihedrals", of(&RunRow::mesh, &Columns::mean_min_dihedral),
         one_mean, all_means},
        {mean_angle, "180 degrees less the mean of largest dihedrals",
         rest_of(&Columns::mean_max_dihedral), one_mean, all_means},
        {gamma, "mean gamma", of(&Columns::mean_gamma), one_mean, all_means, ""},
        {gamma, "1 % quantile of gamma", of(&Columns::gamma_percent), one, all, ""}};
    compare_refined_angle(mesher, pairs);
    for (const Angle& angle : angles) compare_angle(mesher, pairs, angle);
    say_what_lacks(mesher);
  }

  // The oracle's measurement if both have it, else the mesher's account of itself.
  void compare_refined_angle(const std::string& mesher, const std::vector<Pair>& pairs) {
    const auto measured = [](const Run& run) {
      return run.figure("refined-angles", "smallest face angle");
    };
    std::vector<Pair> by_oracle, by_mesher;
    for (const Pair& pair : pairs) {
      (least(*pair.base, measured) && least(*pair.fresh, measured) ? by_oracle : by_mesher)
          .push_back(pair);
    }
    Angle angle{FindingKind::face_angle, "refined smallest face angle", measured,
                options_.angle_factor, options_.total_angle_factor};
    compare_angle(mesher, by_oracle, angle);
    angle.value = of(&RunRow::refined, &MeshColumns::min_face_angle);
    compare_angle(mesher, by_mesher, angle);
  }

  void compare_angle(const std::string& mesher, const std::vector<Pair>& pairs,
                     const Angle& angle) {
    std::vector<Weighted> logs;
    for (const Pair& pair : pairs) {
      const auto before = least(*pair.base, angle.value), after = least(*pair.fresh, angle.value);
      if (!both(mesher, angle.name, before, after)) continue;
      if (*before <= 0) continue;  // nothing was refined, or it cannot be worse
      const double ratio = *after / *before;
      if (ratio < angle.factor) {
        add(angle.kind, *pair.base,
            fmt::format("{} {:.4g} instead of {:.4g}{}", angle.name, *after, *before, angle.unit));
      }
      const double bounded = std::clamp(ratio, 1 / kLargestRatio, kLargestRatio);
      logs.push_back({std::log(bounded), 1});
    }
    if (all_beyond(logs, std::log(angle.total_factor), 0, -1)) {
      add_for_all(angle.kind, mesher,
                  fmt::format("{} {:.3f} times that of the base, on average over {} models",
                              angle.name, std::exp(mean_of(logs)), logs.size()));
    }
  }

  void compare_slivers(const std::string& mesher, const std::vector<Pair>& pairs) {
    compare_share(mesher, pairs, "share below 5 degrees", of(&MeshColumns::share_below_5));
    compare_share(mesher, pairs, "share below 10 degrees", of(&MeshColumns::share_below_10));
    say_what_lacks(mesher);
  }

  void compare_share(const std::string& mesher, const std::vector<Pair>& pairs, const char* name,
                     const Getter& value) {
    std::vector<Weighted> differences;
    double before_sum = 0, after_sum = 0;
    // From one repetition: the largest share need not be that of the largest mesh.
    const Getter number = [&](const Run& run) -> std::optional<double> {
      const auto share = value(run), all = tetrahedra(run);
      return share && all ? std::optional(*share * *all) : std::nullopt;
    };
    for (const Pair& pair : pairs) {
      const auto before = most(*pair.base, value), after = most(*pair.fresh, value);
      if (!before && !after) ++lacking_[mesher][{name, "neither side has"}];
      if (!both(mesher, name, before, after)) continue;
      const double more = *most(*pair.fresh, number) - *most(*pair.base, number);
      if (*after - *before > options_.sliver_share && more >= options_.least_slivers) {
        add(FindingKind::slivers, *pair.base,
            fmt::format("{}: {:.2f} instead of {:.2f} % of the tetrahedra", name, 100 * *after,
                        100 * *before));
      }
      differences.push_back({*after - *before, 1});
      before_sum += *before;
      after_sum += *after;
    }
    if (all_beyond(differences, options_.total_sliver_share, 0, 1)) {
      const auto models = static_cast<double>(differences.size());
      add_for_all(
          FindingKind::slivers, mesher,
          fmt::format("{}: {:.2f} instead of {:.2f} % on average over {} models", name,
                      100 * after_sum / models, 100 * before_sum / models, differences.size()));
    }
  }

  // What the new side does not measure any more might be anything.
  void say_what_lacks(const std::string& mesher) {
    for (const auto& [what, count] : lacking_[mesher]) {
      const std::string text =
          fmt::format("{} of {} models, which {} measured", what.first, count, what.second);
      if (what.second == kOnlyBase) {
        add_for_all(FindingKind::unmeasured, mesher, text);
      } else {
        differ(mesher, "not compared: " + text);
      }
    }
    lacking_.erase(mesher);
    for (const auto& [oracle, count] : silent_) {
      report_.notes.push_back(
          fmt::format("{}: oracle {} was not asked about {} models", mesher, oracle, count));
    }
    silent_.clear();
  }

  void compare_sizes(const std::string& mesher, const std::vector<Pair>& pairs) {
    std::vector<Weighted> ratios;
    std::size_t fewer = 0;
    for (const Pair& pair : pairs) {
      auto before = most(*pair.base, tetrahedra), after = most(*pair.fresh, tetrahedra);
      const auto least_before = least(*pair.base, tetrahedra),
                 least_after = least(*pair.fresh, tetrahedra);
      // Repetitions may differ both ways; the larger change counts.
      if (options_.fewer_is_bad && before && after &&
          *before * *least_before > *after * *least_after) {
        before = least_before;
        after = least_after;
      }
      if (!both(mesher, "tetrahedra", before, after) || *before <= 0) continue;
      const double ratio = *after / *before;
      ratios.push_back({ratio, std::min(*before, kMostTetrahedra)});
      if (std::fabs(*after - *before) < options_.least_tetrahedra) continue;
      const bool more = ratio > options_.size_factor, less = ratio < 1 / options_.size_factor;
      fewer += less;
      if (!more && !(less && options_.fewer_is_bad)) continue;
      add(FindingKind::size, *pair.base,
          fmt::format("{} tetrahedra: {:.0f} instead of {:.0f}, {:.3f} times",
                      more ? "more" : "fewer", *after, *before, ratio));
    }
    if (fewer > 0 && !options_.fewer_is_bad) note(mesher, fewer, "meshes have fewer tetrahedra");
    const double limit = options_.total_size_factor;
    const bool more = all_beyond(ratios, limit, 1, 1);
    if (more || (options_.fewer_is_bad && all_beyond(ratios, 1 / limit, 1, -1))) {
      add_for_all(FindingKind::size, mesher,
                  fmt::format("{} tetrahedra: {:.3f} times those of the base, on average over {} "
                              "models",
                              more ? "more" : "fewer", mean_of(ratios), ratios.size()));
    }
  }

  void compare_costs(const std::string& mesher, const std::vector<Pair>& pairs) {
    const Cost time{FindingKind::time,
                    "processor time",
                    "s",
                    1,
                    options_.time_factor,
                    options_.total_time_factor,
                    options_.least_seconds,
                    kLongestSeconds,
                    [](const RunRow& r) { return r.cpu_seconds; }};
    const Cost memory{FindingKind::memory,
                      "peak memory",
                      "MB",
                      1e6,
                      options_.memory_factor,
                      options_.total_memory_factor,
                      options_.least_bytes,
                      kLargestBytes,
                      [](const RunRow& r) { return static_cast<double>(r.peak_rss_bytes); }};
    compare_cost(mesher, pairs, time);
    compare_cost(mesher, pairs, memory);
    say_what_lacks(mesher);
  }

  void compare_cost(const std::string& mesher, const std::vector<Pair>& pairs, const Cost& cost) {
    std::vector<double> log_ratios;
    std::vector<Weighted> ratios;
    std::vector<Pair> compared;
    std::set<std::string> hosts;
    for (const Pair& pair : pairs) {
      const double before = cost.value(pair.base->row), after = cost.value(pair.fresh->row);
      const auto measured = [](double x) { return x > 0 ? std::optional(x) : std::nullopt; };
      if (before > 0 && before <= cost.least && !(after > 0)) {  // less than can be measured
        ++lacking_[mesher][{cost.name, "only the base has, and little of it,"}];
        continue;
      }
      if (!both(mesher, cost.name, measured(before), measured(after))) continue;
      log_ratios.push_back(std::log(after / before));
      ratios.push_back({after / before, std::min(before, cost.largest_weight)});
      compared.push_back(pair);
      hosts.insert(pair.base->row.host);
      hosts.insert(pair.fresh->row.host);
    }
    if (compared.empty()) return;
    const bool normalise = hosts.size() > 1;
    const double middle = *median(log_ratios);
    if (normalise) {
      note_machine(mesher, cost, std::exp(middle));
    } else {
      check_all(mesher, compared, ratios, cost, middle);
    }
    const double expected = normalise ? middle : 0;
    const double noise = kDeviations * spread(log_ratios);
    for (std::size_t i = 0; i < compared.size(); ++i) {
      const double excess = log_ratios[i] - expected;
      const double before = cost.value(compared[i].base->row) * std::exp(expected);
      const double after = cost.value(compared[i].fresh->row);
      // If most models got slower, check_all has reported it; the spread is about their median.
      const bool stands_out = compared.size() == 1 || log_ratios[i] - middle > noise;
      if (excess > std::log(cost.factor) && stands_out && after - before > cost.least) {
        add(cost.kind, *compared[i].base,
            fmt::format("{}: {:.4g} {} instead of {:.4g}, {:.2f} times", cost.name,
                        after / cost.divisor, cost.unit, before / cost.divisor, std::exp(excess)));
      }
    }
  }

  void check_all(const std::string& mesher, const std::vector<Pair>& pairs,
                 const std::vector<Weighted>& ratios, const Cost& cost, double middle) {
    double before = 0, after = 0;
    for (const Pair& pair : pairs) {
      before += cost.value(pair.base->row);
      after += cost.value(pair.fresh->row);
    }
    const double mean = mean_of(ratios);
    const std::string said = fmt::format(
        "{}: {:.3f} times over {} models, {:.4g} {} instead of {:.4g} in all", cost.name, mean,
        pairs.size(), after / cost.divisor, cost.unit, before / cost.divisor);
    const bool narrow =
        cost.kind != FindingKind::time || options_.quiet_machine || measured_in_turn(pairs);
    const bool above = all_beyond(ratios, cost.total_factor, 1, 1);
    // With few pairs, or on a drifting machine, all count as slower beyond the factor of a single
    // model.
    const bool far_above =
        pairs.size() >= 2 && middle > std::log(cost.factor) && after - before > cost.least;
    if ((narrow && above) || far_above) {
      add_for_all(cost.kind, mesher, said);
    } else if (above) {
      report_.notes.push_back(
          fmt::format("{}: {}; the sides were not measured in turn, so that only {:.2f} times "
                      "would count",
                      mesher, said, cost.factor));
    }
  }

  // Decided by the times at which the runs began: the side changes at least as often as in base,
  // new, base, new.
  static bool measured_in_turn(const std::vector<Pair>& pairs) {
    std::vector<std::pair<std::string, bool>> starts;
    for (const Pair& pair : pairs) {
      for (const std::string& start : pair.base->started) starts.emplace_back(start, false);
      for (const std::string& start : pair.fresh->started) starts.emplace_back(start, true);
    }
    std::sort(starts.begin(), starts.end());
    // Times are known to the second; the order within one is unknown.
    int turns = 0;
    std::optional<bool> side;
    for (std::size_t i = 0; i < starts.size();) {
      const std::string& second = starts[i].first;
      const bool first = starts[i].second;
      bool mixed = false;
      for (; i < starts.size() && starts[i].first == second; ++i)
        mixed |= starts[i].second != first;
      if (mixed) continue;
      turns += side.has_value() && *side != first;
      side = first;
    }
    return turns >= kTurns;
  }

  void note_machine(const std::string& mesher, const Cost& cost, double ratio) {
    report_.notes.push_back(
        fmt::format("{}: different machines, {} taken relative to the median ratio {:.2f}: a "
                    "slowdown of all models does not show",
                    mesher, cost.name, ratio));
  }

  Runs base_, fresh_;
  GateOptions options_;
  GateReport report_;
  // By mesher: how many pairs lack which measure on which side.
  std::map<std::string, std::map<std::pair<std::string, std::string>, std::size_t>> lacking_;
  std::map<std::string, std::size_t> silent_;  // oracles not asked that need not be
};

}  // namespace

GateReport compare_campaigns(const std::vector<RunRow>& base, const std::vector<RunRow>& fresh,
                             const GateOptions& options) {
  return Gate(base, fresh, options).run();
}

const char* finding_name(FindingKind kind) {
  static constexpr std::array kNames = {"disposition", "unverified", "verdict",   "oracle",
                                        "conformity",  "face-angle", "dihedral",  "slivers",
                                        "mean-angle",  "gamma",      "size",      "time",
                                        "memory",      "missing",    "unmeasured"};
  return kNames.at(static_cast<std::size_t>(kind));
}

}  // namespace tetproof
