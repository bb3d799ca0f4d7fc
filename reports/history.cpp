#include "reports/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "reports/measures.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr std::size_t kMostChanges = 100;

std::vector<std::string> meshers_of(const std::vector<HistoryStep>& steps) {
  std::vector<std::string> all;
  for (const HistoryStep& step : steps) {
    for (const std::string& mesher : step.runs.meshers) {
      if (std::find(all.begin(), all.end(), mesher) == all.end()) all.push_back(mesher);
    }
  }
  return all;
}

// Models that the mesher meshed in every campaign that has the mesher.
std::vector<std::string> common_models(const std::vector<HistoryStep>& steps,
                                       const std::string& mesher) {
  std::vector<std::string> common;
  bool first = true;
  for (const HistoryStep& step : steps) {
    if (!step.runs.has(mesher)) continue;
    if (first) common = step.runs.models;
    first = false;
    std::erase_if(common, [&](const std::string& model) {
      return step.runs.ok_run(mesher, model) == nullptr;
    });
  }
  return common;
}

struct Sums {
  double tetrahedra = 0, seconds = 0;
  std::vector<double> face_angles, dihedrals, percents, gammas;
};

Sums sums_of(const Selection& runs, const std::string& mesher,
             const std::vector<std::string>& models) {
  Sums sums;
  for (const std::string& model : models) {
    const RunRow& row = *runs.ok_run(mesher, model);
    sums.tetrahedra += static_cast<double>(row.mesh->tetrahedra);
    sums.seconds += row.cpu_seconds;
    sums.face_angles.push_back(row.mesh->min_face_angle);
    sums.dihedrals.push_back(row.mesh->min_dihedral);
    if (row.mesh->dihedral_percent) sums.percents.push_back(*row.mesh->dihedral_percent);
    if (row.mesh->mean_gamma) sums.gammas.push_back(*row.mesh->mean_gamma);
  }
  return sums;
}

std::string versions_of(const Selection& runs, const std::string& mesher) {
  std::set<std::string> versions;
  for (const auto& [model, row] : runs.runs.at(mesher)) versions.insert(row.key.version);
  return versions.size() == 1 ? *versions.begin() : fmt::format("{} versions", versions.size());
}

Chart relative_chart(const std::vector<HistoryStep>& steps, double Sums::*measure) {
  Chart chart;
  chart.kind = Chart::Kind::lines;
  chart.x_title = "campaign";
  chart.y_title = "relative to the first";
  for (const std::string& mesher : meshers_of(steps)) {
    const std::vector<std::string> models = common_models(steps, mesher);
    if (models.empty()) continue;
    Chart::Series series{.label = fmt::format("{} ({})", mesher, models.size()),
                         .style = chart.series.size()};
    double first = 0;
    for (std::size_t s = 0; s < steps.size(); ++s) {
      if (!steps[s].runs.has(mesher)) continue;
      const double value = sums_of(steps[s].runs, mesher, models).*measure;
      if (first == 0) first = value;
      if (first == 0) continue;
      series.points.emplace_back(static_cast<double>(s + 1), value / first);
      series.point_names.push_back(steps[s].name);
    }
    if (series.points.size() > 1) chart.series.push_back(std::move(series));
  }
  return chart;
}

// A measure of a model that may change, and from which ratio (either way) that is reported. What is
// below `least` on both sides is noise.
struct Watched {
  const char* name;
  double ratio, least;
  double (*value)(const RunRow&);
};
constexpr Watched kWatched[] = {
    {"tetrahedra", 1.05, 50,
     [](const RunRow& row) { return static_cast<double>(row.mesh->tetrahedra); }},
    {"smallest face angle", 1.25, 0, [](const RunRow& row) { return row.mesh->min_face_angle; }},
    {"smallest dihedral", 1.25, 0, [](const RunRow& row) { return row.mesh->min_dihedral; }},
    {"processor seconds", 1.5, 0.2, [](const RunRow& row) { return row.cpu_seconds; }},
    {"peak MB", 1.3, 16,
     [](const RunRow& row) { return static_cast<double>(row.peak_rss_bytes) / 1e6; }}};

struct Change {
  double size;  // logarithm of the ratio; infinite where a mesh came or went
  std::vector<std::string> row;
};

class Changes {
 public:
  explicit Changes(const std::vector<HistoryStep>& steps) {
    for (const std::string& mesher : meshers_of(steps)) {
      const HistoryStep* before = nullptr;
      for (const HistoryStep& step : steps) {
        if (!step.runs.has(mesher)) continue;
        if (before != nullptr) compare(mesher, *before, step);
        before = &step;
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Change& a, const Change& b) { return a.size > b.size; });
  }

  std::vector<Change> found;

 private:
  void compare(const std::string& mesher, const HistoryStep& before, const HistoryStep& after) {
    for (const std::string& model : before.runs.models) {
      const RunRow *old = before.runs.run(mesher, model), *fresh = after.runs.run(mesher, model);
      if (old == nullptr || fresh == nullptr) continue;
      const auto add = [&](double size, const char* what, std::string from, std::string to) {
        found.push_back({size,
                         {mesher, short_name(old->model_name), what, std::move(from), std::move(to),
                          after.name, fresh->key.version}});
      };
      if (old->disposition != fresh->disposition) {
        add(HUGE_VAL, "disposition", disposition_name(old->disposition),
            disposition_name(fresh->disposition));
      } else if (old->mesh && fresh->mesh) {
        for (const Watched& watched : kWatched) compare_values(watched, *old, *fresh, add);
      }
    }
  }

  template <class Add>
  void compare_values(const Watched& watched, const RunRow& old, const RunRow& fresh, Add& add) {
    const double a = watched.value(old), b = watched.value(fresh);
    if (std::max(a, b) < watched.least || a == b) return;
    const double size = std::min(a, b) > 0 ? std::fabs(std::log(b / a)) : HUGE_VAL;
    if (size > std::log(watched.ratio))
      add(size, watched.name, significant(a, 4), significant(b, 4));
  }
};

}  // namespace

std::vector<HistoryStep> load_history(const std::vector<std::filesystem::path>& databases) {
  std::vector<HistoryStep> steps;
  for (const auto& path : databases) steps.push_back({path.stem().string(), load_runs({path})});
  return steps;
}

Table history_table(const std::vector<HistoryStep>& steps) {
  Table table;
  table.name = "history";
  table.title = "Campaign by campaign";
  table.header = {"Campaign",   "Mesher",        "Version",          "ok of runs",
                  "Unverified", "Models in all", "Tetrahedra",       "Processor s",
                  "Min face",   "Min dihedral",  "1 % of dihedrals", "Mean gamma"};
  for (const std::string& mesher : meshers_of(steps)) {
    const std::vector<std::string> models = common_models(steps, mesher);
    for (const HistoryStep& step : steps) {
      if (!step.runs.has(mesher)) continue;
      const Sums sums = sums_of(step.runs, mesher, models);
      const bool any = !models.empty();
      table.rows.push_back(
          {step.name, mesher, versions_of(step.runs, mesher),
           fmt::format("{}/{}", step.runs.ok_runs(mesher).size(), run_count(step.runs, mesher)),
           std::to_string(unverified_count(step.runs, mesher)), std::to_string(models.size()),
           any ? fmt::format("{:.0f}", sums.tetrahedra) : "-", any ? fixed(sums.seconds, 2) : "-",
           fixed(mean(sums.face_angles), 2), fixed(mean(sums.dihedrals), 2),
           fixed(mean(sums.percents), 2), fixed(mean(sums.gammas), 3)});
    }
  }
  table.notes = {
      "Tetrahedra and processor time are sums, angles (degrees) and gamma means, over the models "
      "that the mesher meshed in all these campaigns (\"Models in all\")."};
  return table;
}

Table history_changes(const std::vector<HistoryStep>& steps) {
  Table table;
  table.name = "history-changes";
  table.title = "What changed, and with which campaign";
  table.header = {"Mesher", "Model", "What", "Before", "After", "Campaign", "Version"};
  const std::vector<Change> changes = Changes(steps).found;
  for (std::size_t c = 0; c < std::min(kMostChanges, changes.size()); ++c) {
    table.rows.push_back(changes[c].row);
  }
  table.notes = {fmt::format(
      "{} changes, the largest {} of them: another disposition; 5 % of the tetrahedra; a quarter "
      "of a smallest angle; half of the processor time, from 0.2 s; 30 % of the memory.",
      changes.size(), table.rows.size())};
  return table;
}

Chart history_size_chart(const std::vector<HistoryStep>& steps) {
  Chart chart = relative_chart(steps, &Sums::tetrahedra);
  chart.name = "history-size";
  chart.title = "Tetrahedra of the models in all campaigns";
  return chart;
}

Chart history_time_chart(const std::vector<HistoryStep>& steps) {
  Chart chart = relative_chart(steps, &Sums::seconds);
  chart.name = "history-time";
  chart.title = "Processor time of the models in all campaigns";
  return chart;
}

}  // namespace tetproof
