// Limits that our mesher set itself, by its own statistics.
#include <nlohmann/json.hpp>

#include "reports/measures.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

struct Struck {
  std::uint64_t runs = 0, guard = 0, stops = 0, corners = 0, everywhere = 0;
  std::uint64_t capped = 0, restarts = 0, thinned = 0;
};

void add(const std::string& text, Struck& struck) {
  const auto stats = nlohmann::json::parse(text, nullptr, false);
  if (!stats.is_object() || !stats.contains("limits") || !stats.contains("guarantee")) return;
  const auto& limits = stats["limits"];
  const auto& guarantee = stats["guarantee"];
  const auto count = [](const nlohmann::json& from, const char* name) {
    return from.value(name, std::uint64_t{0});
  };
  ++struck.runs;
  struck.guard += count(limits, "guard_stops") > 0;
  struck.stops += count(limits, "guard_stops");
  struck.corners += count(guarantee, "fallback_corners");
  struck.everywhere += guarantee.value("acute", 0.0) > stats["parameters"].value("acute", 90.0);
  struck.capped += limits.value("refinement_capped", false);
  struck.restarts += count(limits, "cdt_restarts");
  struck.thinned += count(limits, "thinned");
}

}  // namespace

Table limit_table(const Selection& selection) {
  Table table;
  table.name = "limits";
  table.title = "Limits that the mesher set itself";
  table.header = {"Mesher",        "Runs",   "Guard acted",  "Times",         "Corners tightened",
                  "All tightened", "Capped", "CDT restarts", "Points thinned"};
  for (const std::string& mesher : selection.meshers) {
    Struck s;
    for (const RunRow* row : selection.ok_runs(mesher)) add(row->stats_json, s);
    if (s.runs == 0) continue;
    table.rows.push_back({mesher});
    for (const std::uint64_t n :
         {s.runs, s.guard, s.stops, s.corners, s.everywhere, s.capped, s.restarts, s.thinned}) {
      table.rows.back().push_back(std::to_string(n));
    }
  }
  table.notes = {
      "Of the successful runs, by the mesher's own statistics. The guard begins a refinement that "
      "would not end anew, stricter; \"capped\" are runs that gave up slivers, or angles above the "
      "guaranteed ones, at four times the points; points are thinned where doubles are too coarse "
      "for them."};
  return table;
}

}  // namespace tetproof
