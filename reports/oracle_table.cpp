// What the oracles said of every mesher's files.
#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "reports/tables.h"

namespace tetproof {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 5> kVerdicts = {"exact", "rounded", "deviating", "broken",
                                                  "not verified"};

struct OracleCount {
  std::size_t asked = 0, failed = 0;
  std::string example;  // of a failure
};

struct MesherVerdicts {
  std::size_t verified = 0;
  std::map<std::string, std::size_t> verdicts;
  std::map<std::string, OracleCount> oracles;
};

std::string shortened(const std::string& text) {
  constexpr std::size_t kLongest = 120;
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

void add(const Json& json, const std::string& model, MesherVerdicts& sum,
         std::vector<std::string>& order) {
  ++sum.verified;
  if (!json.contains("verdict")) {
    ++sum.verdicts["not verified"];
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
      if (row.verdict_json.empty()) continue;
      const Json json = Json::parse(row.verdict_json, nullptr, false);
      if (json.is_object()) add(json, row.model_name, meshers[mesher], order);
    }
  }
  table.header = {"Mesher", "Files"};
  table.header.insert(table.header.end(), kVerdicts.begin(), kVerdicts.end());
  table.header.insert(table.header.end(), order.begin(), order.end());
  for (const std::string& mesher : selection.meshers) {
    if (!meshers.contains(mesher)) continue;
    MesherVerdicts& sum = meshers[mesher];
    std::vector<std::string> row = {mesher, std::to_string(sum.verified)};
    for (const char* verdict : kVerdicts) row.push_back(std::to_string(sum.verdicts[verdict]));
    for (const std::string& name : order) {
      const OracleCount& count = sum.oracles[name];
      row.push_back(count.asked == 0 ? "-"
                                     : std::to_string(count.asked - count.failed) + " of " +
                                           std::to_string(count.asked));
      if (count.failed > 0) {
        table.notes.push_back(mesher + ", " + name + ", for example " + shortened(count.example));
      }
    }
    table.rows.push_back(std::move(row));
  }
  table.notes.insert(table.notes.begin(),
                     "Of every oracle: how many of the files passed that it was asked about (run "
                     "--verify); an oracle that needs what another found broken is not asked.");
  return table;
}

}  // namespace tetproof
