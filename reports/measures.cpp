#include "reports/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <regex>
#include <set>

namespace tetproof {
namespace {

std::optional<double> per_tetrahedron(const RunRow& row, std::optional<double> amount) {
  if (!amount || !row.mesh || row.mesh->tetrahedra == 0) return std::nullopt;
  return *amount / static_cast<double>(row.mesh->tetrahedra);
}

// The limits of a mesher's runs; more than one set if runs of several campaigns are mixed.
std::string limits_of(const Selection& selection, const std::string& mesher) {
  const auto runs = selection.runs.find(mesher);
  if (runs == selection.runs.end()) return "";
  std::set<std::string> all;
  for (const auto& [model, row] : runs->second) all.insert(row.key.limits);
  std::string text;
  for (const std::string& one : all) text += (text.empty() ? "" : " or ") + one;
  return text;
}

// Meshers by their limits, in the order of the meshers.
std::vector<std::pair<std::string, std::string>> limits_and_meshers(
    const Selection& selection, const std::vector<std::string>& meshers) {
  std::vector<std::pair<std::string, std::string>> groups;
  for (const std::string& mesher : meshers) {
    if (run_count(selection, mesher) == 0) continue;
    const std::string limits = limits_of(selection, mesher);
    const auto same = std::find_if(groups.begin(), groups.end(),
                                   [&](const auto& group) { return group.first == limits; });
    if (same == groups.end()) {
      groups.emplace_back(limits, mesher);
    } else {
      same->second += ", " + mesher;
    }
  }
  return groups;
}

}  // namespace

bool is_of_tetrahedra(double MeshColumns::*column) {
  return column == &MeshColumns::min_dihedral || column == &MeshColumns::max_dihedral ||
         column == &MeshColumns::mean_min_dihedral || column == &MeshColumns::mean_max_dihedral;
}

Value wall_seconds() {
  return [](const RunRow& row) { return row.wall_seconds; };
}

Value verify_seconds() {
  return [](const RunRow& row) { return row.verify_seconds; };
}

Value peak_megabytes() {
  return [](const RunRow& row) { return static_cast<double>(row.peak_rss_bytes) / 1e6; };
}

Value process_microseconds() {
  return [](const RunRow& row) { return per_tetrahedron(row, 1e6 * row.wall_seconds); };
}

Value meshing_microseconds() {
  return [](const RunRow& row) {
    const auto seconds = row.mesh_seconds;
    return per_tetrahedron(row, seconds ? std::optional(1e6 * *seconds) : std::nullopt);
  };
}

Value peak_bytes() {
  return [](const RunRow& row) {
    return per_tetrahedron(row, static_cast<double>(row.peak_rss_bytes));
  };
}

std::vector<double> values_of(const Rows& rows, const Value& value) {
  std::vector<double> values;
  for (const RunRow* row : rows) {
    if (const auto v = value(*row)) values.push_back(*v);
  }
  return values;
}

std::string fixed(std::optional<double> value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

std::string significant(std::optional<double> value, int digits) {
  return value ? fmt::format("{:.{}g}", *value, digits) : "-";
}

std::string degrees(std::optional<double> value) {
  if (!value) return "-";
  if (*value == 0 || std::fabs(*value) >= 0.1) return fmt::format("{:.2f}", *value);
  return fmt::format("{:.2g}", *value);
}

std::vector<std::string> present(const Selection& selection,
                                 const std::vector<std::string>& meshers) {
  std::vector<std::string> found;
  std::copy_if(meshers.begin(), meshers.end(), std::back_inserter(found),
               [&](const auto& mesher) { return selection.has(mesher); });
  return found;
}

std::size_t run_count(const Selection& selection, const std::string& mesher) {
  const auto found = selection.runs.find(mesher);
  return found == selection.runs.end() ? 0 : found->second.size();
}

void append_dispositions(std::vector<std::string>& header) {
  for (std::size_t d = 1; d < kDispositionCount; ++d) {
    header.emplace_back(disposition_name(static_cast<Disposition>(d)));
  }
}

void append_dispositions(const Selection& selection, const std::string& mesher,
                         std::vector<std::string>& row) {
  std::array<std::size_t, kDispositionCount> counts{};
  for (const auto& [model, run] : selection.runs.at(mesher)) {
    ++counts[static_cast<std::size_t>(run.disposition)];
  }
  for (std::size_t d = 1; d < kDispositionCount; ++d) row.push_back(std::to_string(counts[d]));
}

std::size_t unverified_count(const Selection& selection, const std::string& mesher) {
  const auto found = selection.runs.find(mesher);
  if (found == selection.runs.end()) return 0;
  return static_cast<std::size_t>(std::count_if(
      found->second.begin(), found->second.end(),
      [](const auto& run) { return run.second.disposition == Disposition::unverified; }));
}

std::string successes_of(const Selection& selection, const std::string& mesher) {
  const std::size_t unverified = unverified_count(selection, mesher);
  return fmt::format("{}/{}", selection.ok_runs(mesher).size(), run_count(selection, mesher)) +
         (unverified == 0 ? "" : fmt::format(", {} unverified", unverified));
}

std::string region_of(const Rows& rows) {
  std::string region;
  for (const RunRow* row : rows) {
    const std::string here = row->region.empty() ? "not told" : row->region;
    if (!region.empty() && region != here) return "mixed";
    region = here;
  }
  return region.empty() ? "-" : region;
}

std::string region_mark(const Rows& rows) {
  const std::string region = region_of(rows);
  return region == "hull" || region == "mixed" ? " (" + region + ")" : "";
}

bool limits_differ(const Selection& selection, const std::vector<std::string>& meshers) {
  const auto groups = limits_and_meshers(selection, meshers);
  return groups.size() > 1 ||
         (!groups.empty() && groups.front().first.find(" or ") != std::string::npos);
}

std::string limits_caption(const Selection& selection, const std::vector<std::string>& meshers) {
  const auto groups = limits_and_meshers(selection, meshers);
  if (groups.empty()) return "";
  if (groups.size() == 1) return "Limits of each run: " + groups.front().first + ".";
  std::string text = "The limits differ:";
  for (std::size_t i = 0; i < groups.size(); ++i) {
    text += (i == 0 ? " " : "; ") + groups[i].second + ": " + groups[i].first;
  }
  return text + ".";
}

std::size_t style_of(const Selection& selection, const std::string& mesher) {
  const auto found = std::find(selection.meshers.begin(), selection.meshers.end(), mesher);
  return static_cast<std::size_t>(found - selection.meshers.begin());
}

std::string short_name(const std::string& model_name) {
  return std::filesystem::path(model_name).stem().string();
}

std::string failure_kind(const RunRow& row) {
  const std::string name = disposition_name(row.disposition);
  if (row.disposition == Disposition::timeout || row.disposition == Disposition::out_of_memory) {
    return name;
  }
  std::string reason = row.reason;
  const std::string file = std::filesystem::path(row.model_name).filename().string();
  for (const std::string& model : {row.model_name, file, short_name(file)}) {
    if (model.empty()) continue;
    for (std::size_t at = 0; (at = reason.find(model, at)) != std::string::npos; at += 5) {
      reason.replace(at, model.size(), "MODEL");
    }
  }
  static const std::regex kOracle("verify: (\\w+: [\\w -]+):[^]*");
  static const std::regex kNumber("-?\\d+(\\.\\d+)?(e[-+]?\\d+)?");
  std::smatch oracle;
  if (std::regex_match(reason, oracle, kOracle)) return name + ": " + oracle[1].str();
  return name + ": " + std::regex_replace(reason, kNumber, "#");
}

}  // namespace tetproof
