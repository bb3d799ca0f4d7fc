// The verdicts of the oracles on every mesher's files.
#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "reports/tables.h"

namespace tetproof {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 5> kVerdicts = {"exact", "rounded", "deviating", "broken",
                                                  "unverified"};

struct OracleCount {
  std::size_t asked = 0, failed = 0;
  std::string example;  // of a failure
};

struct MesherVerdicts {
  std::size_t files = 0;
  std::map<std::string, std::size_t> verdicts;
  std::map<std::string, OracleCount> oracles;
};

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 120;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

void add(const Json& json, const std::string& model, MesherVerdicts& sum,
         std::vector<std::string>& order) {
  ++sum.files;
  if (!json.contains("verdict")) {
    ++sum.verdicts["unverified"];
    return;
  }
  ++sum.verdicts[json.at("verdict").get<std::string>()];
  for (const Json& oracle : json.value("oracles", Json::array())) {
    const auto name = oracle.at("name").get<std::string>();
    if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
    OracleCount& count = sum.oracles[name];
    ++count.asked;
    if (oracle.at("passed").get<bool>()) continue;
    ++count.failed;
    if (!count.example.empty()) continue;
    const Json findings = oracle.value("findings", Json::array());
    count.example =
        model + ": " + (findings.empty() ? "nothing to check" : findings[0].get<std::string>());
  }
}

}  // namespace

Table oracle_table(const Selection& selection) {
  Table table;
  table.name = "oracles";
  table.title = "Verdicts of the oracles";
  std::map<std::string, MesherVerdicts> meshers;
  std::vector<std::string> order;  // of oracles, as they come in the reports
  for (const std::string& mesher : selection.meshers) {
    for (const auto& [model, row] : selection.runs.at(mesher)) {
      if (row.disposition == Disposition::unverified && row.verdict_json.empty()) {
        ++meshers[mesher].files;
        ++meshers[mesher].verdicts["unverified"];
      }
      if (row.verdict_json.empty()) continue;
      const Json json = Json::parse(row.verdict_json, nullptr, false);
      if (json.is_object()) add(json, row.model_name, meshers[mesher], order);
    }
  }
  std::vector<std::string> shown;
  for (const std::string& mesher : selection.meshers) {
    if (meshers.contains(mesher)) shown.push_back(mesher);
  }
  if (shown.empty()) return table;
  table.header = {"Verdict or oracle"};
  table.header.insert(table.header.end(), shown.begin(), shown.end());
  const auto add_row = [&](const std::string& name, const auto& cell) {
    std::vector<std::string> row = {name};
    for (const std::string& mesher : shown) row.push_back(cell(meshers[mesher]));
    table.rows.push_back(std::move(row));
  };
  add_row("files", [](const MesherVerdicts& sum) { return std::to_string(sum.files); });
  for (const char* verdict : kVerdicts) {
    add_row(verdict, [&](MesherVerdicts& sum) { return std::to_string(sum.verdicts[verdict]); });
  }
  for (const std::string& name : order) {
    add_row(name, [&](MesherVerdicts& sum) {
      const OracleCount& count = sum.oracles[name];
      if (count.asked == 0) return std::string("-");
      return std::to_string(count.asked - count.failed) + " of " + std::to_string(count.asked);
    });
    for (const std::string& mesher : shown) {
      const OracleCount& count = meshers[mesher].oracles[name];
      if (count.failed == 0) continue;
      table.notes.push_back(mesher + ", " + name + ", for example " + shortened(count.example));
    }
  }
  table.notes.insert(
      table.notes.begin(),
      "For each oracle: files that passed, of those that it checked (run --verify). An oracle "
      "does not run if it needs what another one found broken.");
  return table;
}

}  // namespace tetproof
