#include "oracles/verdict/report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace tetproof::oracles {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

nlohmann::ordered_json to_json(const Spot& spot) {
  nlohmann::ordered_json json;  // null
  if (spot.site) {
    const SiteKind& kind = kSiteKinds[static_cast<std::size_t>(spot.site->kind)];
    json["kind"] = kind.name;
    for (std::size_t k = 0; k < kind.numbers; ++k) {
      json["numbers"].push_back(spot.site->numbers[k]);
    }
  }
  if (spot.at) json["at"] = *spot.at;
  return json;
}

}  // namespace

std::optional<double> OracleReport::figure(std::string_view figure_name) const {
  for (const auto& [key, value] : figures) {
    if (key == figure_name) return value;
  }
  return std::nullopt;
}

OracleReport surface_not_decided(const std::string& oracle) {
  OracleReport report(oracle, "boundary faces");
  report.undecided = true;
  report.notes.emplace_back(
      "the surface of a refined mesh is not the input's: the file alone does not say whether it is "
      "a mesh of this input, a record (--exact) does");
  return report;
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::exact:
      return "exact";
    case Verdict::rounded:
      return "rounded";
    case Verdict::deviating:
      return "deviating";
    case Verdict::undecided:
      return "undecided";
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

bool VerifyReport::any_failed() const {
  return oracles.empty() || std::any_of(oracles.begin(), oracles.end(), [](const auto& oracle) {
           return !oracle.passed() && !oracle.undecided;
         });
}

std::string to_json(const VerifyReport& report) {
  nlohmann::ordered_json json;
  json["verdict"] = verdict_name(report.verdict);
  if (!report.scope.empty()) json["scope"] = report.scope;
  if (!report.unproven.empty()) json["unproven"] = report.unproven;
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
    entry["status"] = oracle.status();
    entry["checked"] = oracle.checked;
    entry["checked_what"] = oracle.checked_what;
    entry["violations"] = oracle.violations;
    entry["findings"] = oracle.findings;
    entry["places"] = nlohmann::ordered_json::array();
    for (const Spot& spot : oracle.spots) entry["places"].push_back(to_json(spot));
    entry["notes"] = oracle.notes;
    for (const auto& [name, value] : oracle.figures) entry["figures"][name] = value;
    for (const auto& [name, bins] : oracle.histograms) entry["histograms"][name] = bins;
    json["oracles"].push_back(entry);
  }
  // Names of files, and in them, need not be UTF-8.
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

namespace {

// Items of one paragraph, indented from the second line on.
class Paragraph {
 public:
  explicit Paragraph(std::string begin) : line_(std::move(begin)) {}
  void add(const std::string& item, const char* separator = "; ") {
    constexpr std::size_t kWidth = 120;
    if (line_.size() + std::char_traits<char>::length(separator) + item.size() + 1 > kWidth) {
      text_ += line_ + (separator[0] == ' ' ? "" : std::string(1, separator[0])) + "\n";
      line_ = "      " + item;
    } else {
      line_ += separator + item;
    }
  }
  // Words of a sentence, on a line of their own.
  void sentence(const std::string& words) {
    text_ += line_ + "\n";
    line_ = "     ";
    std::string word;
    for (const char c : words + " ") {
      if (c != ' ') {
        word += c;
      } else if (!word.empty()) {
        add(word, " ");
        word.clear();
      }
    }
  }
  std::string text() const { return text_ + line_ + "\n"; }

 private:
  std::string text_, line_;
};

std::string summary(const VerifyReport& report) {
  std::uint64_t passed = 0, failed = 0, told = 0, undecided = 0;
  std::string names, open_names;
  const auto list = [](std::string& to, const std::string& name) {
    to += (to.empty() ? " (" : ", ") + name;
  };
  for (const OracleReport& oracle : report.oracles) {
    ++(oracle.undecided ? undecided : !oracle.passed() ? failed : oracle.promised ? passed : told);
    if (!oracle.passed()) list(oracle.undecided ? open_names : names, oracle.name);
  }
  if (!names.empty()) names += ")";
  Paragraph line(std::string("verdict: ") + verdict_name(report.verdict) +
                 (report.scope.empty() ? "" : ", of " + report.scope + " alone"));
  std::string unproven;
  for (const std::string& promise : report.unproven) {
    unproven += (unproven.empty() ? "not proven: " : ", ") + promise;
  }
  if (!unproven.empty()) line.add(unproven);
  line.add(std::to_string(passed) + " passed, " + std::to_string(failed) + " FAILED" + names +
           ", " + std::to_string(told) + " for information");
  if (undecided > 0) line.add(std::to_string(undecided) + " undecided" + open_names + ")");
  if (report.verdict == Verdict::rounded || report.verdict == Verdict::deviating) {
    const std::string ulps =
        report.deviation_ulps > 0  // of an envelope they are not known
            ? ", " + number(report.deviation_ulps) + " ulp of the largest coordinate there"
            : "";
    line.add("deviation " + number(report.deviation) + ulps);
    line.add(number(report.deviation_share) + " of the diagonal");
  }
  if (report.inverted + report.flat > 0) {
    line.add(std::to_string(report.inverted) + " inverted and " + std::to_string(report.flat) +
             " flat " + report.cells + " as written");
  }
  return line.text();
}

std::string paragraph(const OracleReport& oracle) {
  Paragraph lines(std::string(oracle.status()) + "  " + oracle.name + ": " +
                  std::to_string(oracle.checked) + " " + oracle.checked_what + " checked");
  if (oracle.violations > 0) lines.add(std::to_string(oracle.violations) + " violations", ", ");
  for (const auto& [name, value] : oracle.figures) lines.add(name + " " + number(value));
  for (const auto& [name, bins] : oracle.histograms) {
    std::string counts = name + " in bins of 15 degrees:";
    for (const std::uint64_t count : bins) counts += " " + std::to_string(count);
    lines.sentence(counts);
  }
  for (const std::string& finding : oracle.findings) lines.sentence(finding);
  for (const std::string& note : oracle.notes) lines.sentence("note: " + note);
  return lines.text();
}

}  // namespace

std::string to_text(const VerifyReport& report) {
  std::string text = summary(report);
  for (const OracleReport& oracle : report.oracles) text += paragraph(oracle);
  return text;
}

}  // namespace tetproof::oracles
