// Tables about runs rather than meshes: their times, and the failed ones.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "reports/measures.h"
#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

constexpr std::size_t kSlowest = 25;

struct TimeClass {
  const char* label;
  double below;  // seconds
};

constexpr TimeClass kTimeClasses[] = {{"< 1 s", 1},           {"1 to 10 s", 10},
                                      {"10 to 60 s", 60},     {"1 to 10 min", 600},
                                      {"10 to 60 min", 3600}, {"> 1 h", 1e300}};

// Removes numbers and names from a reason, so that equal failures look equal.
std::string without_particulars(const RunRow& row) {
  std::string text = row.reason;
  for (const std::string& name : {row.model_path, row.model_name, short_name(row.model_name)}) {
    for (auto at = text.find(name); !name.empty() && at != std::string::npos;
         at = text.find(name, at + 1)) {
      text.replace(at, name.size(), "*");
    }
  }
  std::string result;
  for (const char c : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit) {
      result += c;
    } else if (result.empty() || result.back() != 'N') {
      result += 'N';
    }
  }
  for (const char* fraction : {"N.N", "Ne-N", "Ne+N", "NeN"}) {
    for (auto at = result.find(fraction); at != std::string::npos; at = result.find(fraction)) {
      result.replace(at, std::string(fraction).size(), "N");
    }
  }
  return result.substr(0, 120);
}

std::map<std::string, double> phase_shares(const RunRow& row) {
  std::map<std::string, double> shares;
  const auto json = nlohmann::json::parse(row.stats_json, nullptr, false);
  if (!json.is_object() || !json.contains("phases_seconds")) return shares;
  double total = 0;
  for (const auto& [phase, seconds] : json.at("phases_seconds").items()) {
    if (!seconds.is_number()) continue;
    shares[phase] = seconds.get<double>();
    total += shares[phase];
  }
  for (auto& [phase, share] : shares) share = total > 0 ? share / total : 0;
  return shares;
}

}  // namespace

Table time_table(const Selection& selection) {
  Table table;
  table.name = "times";
  table.title = "How long the runs took, % of the successes";
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"Mesher", "Successes"};
  for (const TimeClass& c : kTimeClasses) table.header.emplace_back(c.label);
  for (const char* name :
       {"median s", "95 % s", "longest s", "oracles, median s", "oracles, all s"}) {
    table.header.emplace_back(name);
  }
  for (const std::string& mesher : selection.meshers) {
    const auto seconds = values_of(selection.ok_runs(mesher), wall_seconds());
    std::vector<std::string> row = {mesher, std::to_string(seconds.size())};
    double from = 0;
    for (const TimeClass& c : kTimeClasses) {
      const auto count = std::count_if(seconds.begin(), seconds.end(),
                                       [&](double s) { return s >= from && s < c.below; });
      row.push_back(
          seconds.empty()
              ? "-"
              : fixed(100.0 * static_cast<double>(count) / static_cast<double>(seconds.size()), 1));
      from = c.below;
    }
    for (const double p : {0.5, 0.95, 1.0}) row.push_back(fixed(quantile(seconds, p), 2));
    Rows all;  // the oracles took time for wrong meshes, too
    for (const auto& [model, run] : selection.runs.at(mesher)) all.push_back(&run);
    const auto verifying = values_of(all, verify_seconds());
    row.push_back(fixed(median(verifying), 2));
    row.push_back(verifying.empty()
                      ? "-"
                      : fixed(std::accumulate(verifying.begin(), verifying.end(), 0.0), 1));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "oracles: wall time of verifying the meshes, of all that were delivered; it counts in no "
      "other "
      "time."};
  return table;
}

Table phase_table(const Selection& selection) {
  Table table;
  table.name = "phases";
  table.title = "Time by phase, mean share in %";
  // In the order in which the mesher goes through them.
  static constexpr std::array kPhases = {"read",     "check",  "filter", "chamfer", "delaunay",
                                         "segments", "facets", "refine", "enrich",  "classify",
                                         "improve",  "round",  "write"};
  table.header = {"Mesher", "Runs"};
  table.header.insert(table.header.end(), kPhases.begin(), kPhases.end());
  for (const std::string& mesher : selection.meshers) {
    std::map<std::string, std::vector<double>> shares;
    std::size_t runs = 0;
    for (const RunRow* row : selection.ok_runs(mesher)) {
      const auto of_run = phase_shares(*row);
      if (!of_run.contains("refine")) continue;  // a mesher with other phases
      ++runs;
      for (const auto& [phase, share] : of_run) shares[phase].push_back(100 * share);
    }
    if (runs == 0) continue;
    std::vector<std::string> row = {mesher, std::to_string(runs)};
    for (const char* phase : kPhases) row.push_back(fixed(mean(shares[phase]), 1));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "As the mesher reports them; every model has the same weight, however long it took. "
      "TetGen and foreign programs do not report phases."};
  return table;
}

Table slowest_table(const Selection& selection) {
  Rows rows;
  for (const std::string& mesher : selection.meshers) {
    for (const auto& [model, row] : selection.runs.at(mesher)) rows.push_back(&row);
  }
  std::stable_sort(rows.begin(), rows.end(), [](const RunRow* a, const RunRow* b) {
    return a->wall_seconds > b->wall_seconds;
  });
  if (rows.size() > kSlowest) rows.resize(kSlowest);
  Table table;
  table.name = "slowest";
  table.title = fmt::format("The {} slowest runs", rows.size());
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"Model",   "Mesher",     "Disposition", "Seconds",
                  "Peak MB", "Tetrahedra", "Oracles, s"};
  for (const RunRow* row : rows) {
    table.rows.push_back(
        {row->model_name, row->key.mesher, disposition_name(row->disposition),
         fixed(row->wall_seconds, 2), fixed(peak_megabytes()(*row), 0),
         row->mesh ? std::to_string(row->mesh->tetrahedra) + region_mark({row}) : "-",
         fixed(row->verify_seconds, 2)});
  }
  return table;
}

Table failure_group_table(const Selection& selection) {
  Table table;
  table.name = "failures";
  table.title = "Failures by reason";
  table.header = {"Mesher", "Disposition", "Runs", "Reason (N: a number)", "For example"};
  for (const std::string& mesher : selection.meshers) {
    std::map<std::pair<Disposition, std::string>, Rows> groups;
    for (const auto& [model, row] : selection.runs.at(mesher)) {
      if (row.disposition == Disposition::ok) continue;
      groups[{row.disposition, without_particulars(row)}].push_back(&row);
    }
    std::vector<std::pair<std::pair<Disposition, std::string>, Rows>> sorted(groups.begin(),
                                                                             groups.end());
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return a.second.size() > b.second.size();
    });
    for (const auto& [what, rows] : sorted) {
      table.rows.push_back({mesher, disposition_name(what.first), std::to_string(rows.size()),
                            what.second, rows.front()->model_name});
    }
  }
  return table;
}

Table failure_table(const Selection& selection) {
  Table table;
  table.name = "not-ok";
  table.title = "Runs that are not ok";
  table.header = {"Model", "Mesher", "Disposition", "Seconds", "Oracles, s", "Reason"};
  for (const std::string& model : selection.models) {
    for (const std::string& mesher : selection.meshers) {
      const RunRow* row = selection.run(mesher, model);
      if (row == nullptr || row->disposition == Disposition::ok) continue;
      table.rows.push_back({row->model_name, mesher, disposition_name(row->disposition),
                            fixed(row->wall_seconds, 2), fixed(row->verify_seconds, 2),
                            row->reason.substr(0, 300)});
    }
  }
  return table;
}

}  // namespace tetproof
