#include "reports/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace tetproof {
namespace {

constexpr const char* kKinds[] = {"bars", "stacked", "lines", "steps", "points"};

bool is_bars(const Chart& chart) {
  return chart.kind == Chart::Kind::bars || chart.kind == Chart::Kind::stacked_bars;
}

// Digits beyond these do not show in a chart, and the page is large enough.
double rounded(double value) {
  return std::stod(fmt::format("{:.6g}", value));
}

}  // namespace

bool Chart::empty() const {
  return std::all_of(series.begin(), series.end(),
                     [](const Series& s) { return s.values.empty() && s.points.empty(); });
}

std::string to_json(const Chart& chart) {
  using Json = nlohmann::ordered_json;
  Json json = {{"name", chart.name},
               {"title", chart.title},
               {"kind", kKinds[static_cast<std::size_t>(chart.kind)]},
               {"x", chart.x_title},
               {"y", chart.y_title}};
  if (is_bars(chart)) json["categories"] = chart.categories;
  if (chart.log_x) json["logX"] = true;
  if (chart.log_y) json["logY"] = true;
  if (chart.diagonal) json["diagonal"] = true;
  if (chart.flat) json["flat"] = true;
  json["series"] = Json::array();
  for (const Chart::Series& series : chart.series) {
    Json one = {{"label", series.label}, {"style", series.style}};
    Json& data = one["data"] = Json::array();
    for (const auto& value : series.values) data.push_back(value ? Json(rounded(*value)) : Json());
    for (const auto& [x, y] : series.points) data.push_back({rounded(x), rounded(y)});
    if (!series.point_names.empty()) one["names"] = series.point_names;
    json["series"].push_back(std::move(one));
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Table to_table(const Chart& chart) {
  Table table;
  table.name = chart.name;
  table.title = chart.title;
  table.notes = chart.notes;
  if (!is_bars(chart)) {
    table.header = {"series", chart.x_title, chart.y_title, "name"};
    for (const Chart::Series& s : chart.series) {
      for (std::size_t i = 0; i < s.points.size(); ++i) {
        table.rows.push_back({s.label, fmt::format("{:.6g}", s.points[i].first),
                              fmt::format("{:.6g}", s.points[i].second),
                              i < s.point_names.size() ? s.point_names[i] : ""});
      }
    }
    return table;
  }
  table.header = {chart.x_title};
  for (const Chart::Series& s : chart.series) table.header.push_back(s.label);
  for (std::size_t i = 0; i < chart.categories.size(); ++i) {
    std::vector<std::string> row = {chart.categories[i]};
    for (const Chart::Series& s : chart.series) {
      row.push_back(i < s.values.size() && s.values[i] ? fmt::format("{:.4g}", *s.values[i]) : "");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace tetproof
