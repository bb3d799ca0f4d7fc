#include "reports/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

namespace tetproof {
namespace {

std::optional<double> per_tetrahedron(const RunRow& row, std::optional<double> amount) {
  if (!amount || !row.mesh || row.mesh->tetrahedra == 0) return std::nullopt;
  return *amount / static_cast<double>(row.mesh->tetrahedra);
}

}  // namespace

Value wall_seconds() {
  return [](const RunRow& row) { return row.wall_seconds; };
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

std::string short_name(const std::string& model_name) {
  return std::filesystem::path(model_name).stem().string();
}

}  // namespace tetproof
