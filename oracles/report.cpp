#include "oracles/report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

namespace tetproof::oracles {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::exact:
      return "exact";
    case Verdict::rounded:
      return "rounded";
    case Verdict::deviating:
      return "deviating";
    case Verdict::broken:
      return "broken";
  }
  return "?";
}

const OracleReport* VerifyReport::find(const std::string& name) const {
  for (const OracleReport& oracle : oracles) {
    if (oracle.name == name) return &oracle;
  }
  return nullptr;
}

bool VerifyReport::all_passed() const {
  for (const OracleReport& oracle : oracles) {
    if (!oracle.passed()) return false;
  }
  return !oracles.empty();
}

std::string to_json(const VerifyReport& report) {
  nlohmann::ordered_json json;
  json["verdict"] = verdict_name(report.verdict);
  json["deviation"] = report.deviation;
  json["deviation_ulps"] = report.deviation_ulps;
  json["deviation_relative"] = report.deviation_share;
  json["inverted"] = report.inverted;
  json["flat"] = report.flat;
  json["oracles"] = nlohmann::ordered_json::array();
  for (const OracleReport& oracle : report.oracles) {
    nlohmann::ordered_json entry;
    entry["name"] = oracle.name;
    entry["passed"] = oracle.passed();
    entry["checked"] = oracle.checked;
    entry["checked_what"] = oracle.checked_what;
    entry["violations"] = oracle.violations;
    entry["findings"] = oracle.findings;
    entry["notes"] = oracle.notes;
    for (const auto& [name, value] : oracle.figures) entry["figures"][name] = value;
    for (const auto& [name, bins] : oracle.histograms) entry["histograms"][name] = bins;
    json["oracles"].push_back(entry);
  }
  return json.dump(2) + "\n";
}

std::string to_text(const VerifyReport& report) {
  std::string text;
  for (const OracleReport& oracle : report.oracles) {
    text += (oracle.passed() ? "pass  " : "FAIL  ") + oracle.name + ": " +
            std::to_string(oracle.checked) + " " + oracle.checked_what + " checked";
    if (oracle.violations > 0) text += ", " + std::to_string(oracle.violations) + " violations";
    for (const auto& [name, value] : oracle.figures) text += "; " + name + " " + number(value);
    text += "\n";
    for (const auto& [name, bins] : oracle.histograms) {
      text += "      " + name + " in bins of 15 degrees:";
      for (const std::uint64_t count : bins) text += " " + std::to_string(count);
      text += "\n";
    }
    for (const std::string& finding : oracle.findings) text += "      " + finding + "\n";
    for (const std::string& note : oracle.notes) text += "      note: " + note + "\n";
  }
  text += std::string("verdict: ") + verdict_name(report.verdict);
  if (report.verdict == Verdict::rounded || report.verdict == Verdict::deviating) {
    text += " (deviation " + number(report.deviation) + " = " + number(report.deviation_ulps) +
            " ulp of the largest coordinate, " + number(report.deviation_share) +
            " of the diagonal)";
  }
  if (report.inverted + report.flat > 0) {
    text += ", " + std::to_string(report.inverted) + " inverted and " +
            std::to_string(report.flat) + " flat tetrahedra as written";
  }
  return text + "\n";
}

}  // namespace tetproof::oracles
