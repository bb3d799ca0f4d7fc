// Limits that our mesher set itself, and what it did where an attempt was not good enough, by its
// own statistics.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/measures.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

using Json = nlohmann::ordered_json;

struct Struck {
  std::uint64_t runs = 0, tightened = 0, capped = 0, restarts = 0, thinned = 0;
};

std::uint64_t count(const Json& from, const char* name) {
  return from.value(name, std::uint64_t{0});
}

void add(const Json& stats, Struck& struck) {
  if (!stats.is_object() || !stats.contains("limits") || !stats.contains("guarantee")) return;
  const auto& limits = stats["limits"];
  const auto& guarantee = stats["guarantee"];
  ++struck.runs;
  struck.tightened += guarantee.value("acute", 0.0) > stats["parameters"].value("acute", 90.0);
  struck.capped += limits.value("refinement_capped", false);
  struck.restarts += count(limits, "cdt_restarts");
  struck.thinned += count(limits, "thinned");
}

// Rungs in the order of the statistics.
struct Rung {
  std::string name;
  std::uint64_t runs = 0, times = 0;
};

void add(const Json& stats, std::vector<Rung>& rungs) {
  if (!stats.is_object() || !stats.contains("ladder")) return;
  for (const auto& [name, value] : stats["ladder"].items()) {
    const auto times = value.get<std::uint64_t>();
    auto rung = std::ranges::find(rungs, name, &Rung::name);
    if (rung == rungs.end()) rung = rungs.insert(rung, {name});
    rung->runs += times > 0;
    rung->times += times;
  }
}

Json stats_of(const RunRow& row) {
  return Json::parse(row.stats_json, nullptr, false);
}

}  // namespace

Table limit_table(const Selection& selection) {
  Table table;
  table.name = "limits";
  table.title = "Limits that the mesher set itself";
  table.header = {"Mesher", "Runs", "Tightened", "Capped", "CDT restarts", "Points thinned"};
  for (const std::string& mesher : selection.meshers) {
    Struck s;
    for (const RunRow* row : selection.ok_runs(mesher)) add(stats_of(*row), s);
    if (s.runs == 0) continue;
    table.rows.push_back({mesher});
    for (const std::uint64_t n : {s.runs, s.tightened, s.capped, s.restarts, s.thinned}) {
      table.rows.back().push_back(std::to_string(n));
    }
  }
  table.notes = {
      "Of the successful runs, by the mesher's own statistics. \"Tightened\" are runs with "
      "chamfers up to 90 degrees, because the refinement would not end; \"capped\" are runs that "
      "gave up slivers, or angles above the guaranteed ones, at four times the points; points are "
      "thinned where doubles are too coarse for them."};
  return table;
}

Table ladder_table(const Selection& selection) {
  Table table;
  table.name = "ladder";
  table.title = "What the mesher did where an attempt was not good enough";
  table.header = {"Mesher", "Runs", "Rung", "Taken by", "Times"};
  for (const std::string& mesher : selection.meshers) {
    std::vector<Rung> rungs;
    const std::vector<const RunRow*> runs = selection.ok_runs(mesher);
    for (const RunRow* row : runs) add(stats_of(*row), rungs);
    for (const Rung& rung : rungs) {
      if (rung.times == 0) continue;
      table.rows.push_back({mesher, std::to_string(runs.size()), rung.name,
                            std::to_string(rung.runs), std::to_string(rung.times)});
    }
  }
  table.notes = {
      "Of the successful runs, by the mesher's own statistics (\"ladder\"), in the order in which "
      "rungs are taken; those that no run took are left out."};
  return table;
}

}  // namespace tetproof
