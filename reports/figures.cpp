#include "reports/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

constexpr std::size_t kHistogramBins = 12;  // of 15 degrees, as in the paper's Figure 13

struct Bins {
  double from, width;
  int count;
};

// A face has a smallest angle of at most 60 degrees and a largest of at least 60; a tetrahedron a
// smallest dihedral of at most 70.53 and a largest of at least that.
constexpr Bins kMinFace = {0, 5, 12}, kMaxFace = {60, 10, 12}, kMinDihedral = {0, 6, 12},
               kMaxDihedral = {70, 10, 11};
constexpr std::array kBinsOfAngles = {kMinFace, kMaxFace, kMinDihedral, kMaxDihedral};

std::vector<std::string> labels(const Bins& bins) {
  std::vector<std::string> text;
  for (int i = 0; i < bins.count; ++i) {
    text.push_back(
        fmt::format("{:g}-{:g}", bins.from + i * bins.width, bins.from + (i + 1) * bins.width));
  }
  return text;
}

// Percentages; values outside fall into the first or last bin.
std::vector<std::optional<double>> histogram(const std::vector<double>& values, const Bins& bins) {
  std::vector<std::optional<double>> percent(static_cast<std::size_t>(bins.count), 0.0);
  for (const double value : values) {
    const int bin = static_cast<int>(std::floor((value - bins.from) / bins.width));
    *percent[static_cast<std::size_t>(std::clamp(bin, 0, bins.count - 1))] +=
        100.0 / static_cast<double>(values.size());
  }
  return percent;
}

// A chart of one value of each model.
Chart model_chart(const Selection& selection, const std::string& label, const Value& value,
                  const Bins& bins, const std::string& figure) {
  Chart chart;
  chart.name = figure + "-" + label;
  std::replace(chart.name.begin(), chart.name.end(), ' ', '-');
  chart.title = label;
  chart.title[0] = static_cast<char>(std::toupper(label[0]));
  chart.y_title = "% of successes";
  chart.categories = labels(bins);
  for (const std::string& mesher : selection.meshers) {
    const auto values = values_of(selection.ok_runs(mesher), value);
    if (values.empty()) continue;
    chart.series.push_back({.label = fmt::format("{} ({})", mesher, values.size()),
                            .values = histogram(values, bins),
                            .style = style_of(selection, mesher)});
  }
  chart.notes = {
      "Percentages of the models on which the mesher succeeded, whose number stands in "
      "brackets. Every tetrahedron of the file counts."};
  return chart;
}

std::vector<Chart> angle_charts_of(const Selection& selection, const AngleMeasure (&angles)[4],
                                   const std::string& figure) {
  std::vector<Chart> charts;
  for (std::size_t i = 0; i < 4; ++i) {
    charts.push_back(model_chart(selection, angles[i].label, of(&RunRow::mesh, angles[i].column),
                                 kBinsOfAngles[i], figure));
    charts.back().x_title = "degrees";
  }
  return charts;
}

// Adds up the histograms in the measured JSON of runs.
std::vector<std::optional<double>> summed_histogram(const Rows& rows, const char* key) {
  std::array<double, kHistogramBins> sums{};
  double total = 0;
  for (const RunRow* row : rows) {
    const auto json = nlohmann::json::parse(row->mesh_json, nullptr, false);
    if (!json.is_object() || !json.contains(key)) continue;
    for (std::size_t i = 0; i < kHistogramBins && i < json.at(key).size(); ++i) {
      sums[i] += json.at(key)[i].get<double>();
      total += json.at(key)[i].get<double>();
    }
  }
  if (total == 0) return {};
  std::vector<std::optional<double>> percent;
  for (const double sum : sums) percent.emplace_back(100 * sum / total);
  return percent;
}

Chart figure_13(const Selection& selection, const std::string& model, const char* key,
                const std::string& what) {
  Chart chart;
  chart.name = std::string("figure13-") + (model.empty() ? "all-" : "") + what;
  std::replace(chart.name.begin(), chart.name.end(), ' ', '-');
  chart.title =
      what + (model.empty() ? ", all models" : ", " + short_name(selection.model_names.at(model)));
  chart.title[0] = static_cast<char>(std::toupper(chart.title[0]));
  chart.x_title = "degrees";
  chart.y_title = "% of angles";
  chart.categories = labels({0, 15, kHistogramBins});
  for (const std::string& mesher : selection.meshers) {
    Rows rows;
    if (model.empty()) {
      rows = selection.ok_runs(mesher);
    } else if (const RunRow* row = selection.ok_run(mesher, model)) {
      rows = {row};
    }
    auto percent = summed_histogram(rows, key);
    if (!percent.empty()) {
      chart.series.push_back(
          {.label = mesher, .values = std::move(percent), .style = style_of(selection, mesher)});
    }
  }
  return chart;
}

// Turns a table of percentages into a stacked chart, one bar per row, one series per column.
Chart stacked(const Table& table, std::size_t first_column, std::size_t last_column) {
  Chart chart;
  chart.name = table.name + "-chart";
  chart.title = table.title;
  chart.kind = Chart::Kind::stacked_bars;
  for (const auto& row : table.rows) chart.categories.push_back(row[0]);
  for (std::size_t column = first_column; column < last_column; ++column) {
    Chart::Series series = {.label = table.header[column], .style = column - first_column};
    bool any = false;
    for (const auto& row : table.rows) {
      const double value = row[column] == "-" ? 0 : std::stod(row[column]);
      any = any || value > 0;
      series.values.emplace_back(value);
    }
    if (any) chart.series.push_back(std::move(series));
  }
  chart.x_title = "mesher";
  chart.y_title = "%";
  chart.flat = true;
  return chart;
}

Chart distribution(const Selection& selection, const Value& value) {
  Chart chart;
  chart.kind = Chart::Kind::steps;
  chart.log_x = true;
  chart.y_title = "% of successes";
  for (const std::string& mesher : selection.meshers) {
    auto values = values_of(selection.ok_runs(mesher), value);
    std::sort(values.begin(), values.end());
    Chart::Series series = {.label = fmt::format("{} ({})", mesher, values.size()),
                            .style = style_of(selection, mesher)};
    for (std::size_t i = 0; i < values.size(); ++i) {
      series.points.emplace_back(
          values[i], 100.0 * static_cast<double>(i + 1) / static_cast<double>(values.size()));
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart cactus(const Selection& selection, const Value& value) {
  Chart chart;
  chart.kind = Chart::Kind::steps;
  chart.log_y = true;
  chart.x_title = "models meshed";
  for (const std::string& mesher : selection.meshers) {
    auto values = values_of(selection.ok_runs(mesher), value);
    std::sort(values.begin(), values.end());
    Chart::Series series = {.label = mesher, .style = style_of(selection, mesher)};
    for (std::size_t i = 0; i < values.size(); ++i) {
      series.points.emplace_back(static_cast<double>(i + 1), values[i]);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

std::vector<Chart> extreme_angle_charts(const Selection& selection) {
  return angle_charts_of(selection, kExtremeAngles, "figure10");
}

std::vector<Chart> average_angle_charts(const Selection& selection) {
  return angle_charts_of(selection, kAverageAngles, "figure11");
}

std::vector<Chart> gamma_charts(const Selection& selection) {
  constexpr Bins kGamma = {0, 0.05, 20};
  std::vector<Chart> charts = {
      model_chart(selection, "mean gamma", of(&RunRow::mesh, &MeshColumns::mean_gamma), kGamma,
                  "gamma"),
      model_chart(selection, "quantile of gamma", of(&RunRow::mesh, &MeshColumns::gamma_percent),
                  kGamma, "gamma")};
  charts[1].title = "1 % quantile of gamma";
  for (Chart& chart : charts) chart.x_title = "gamma";
  std::erase_if(charts, [](const Chart& chart) { return chart.series.empty(); });
  return charts;
}

std::vector<Chart> angle_charts(const Selection& selection, const std::string& model) {
  return {figure_13(selection, model, "face_angle_histogram", "face angles"),
          figure_13(selection, model, "dihedral_histogram", "dihedral angles")};
}

Chart disposition_chart(const Selection& selection) {
  Table percent = disposition_table(selection);
  for (auto& row : percent.rows) {
    const double total = std::stod(row[1]);
    row[3] = row[2];  // the count of ok, beside the other dispositions
    for (std::size_t i = 3; i < row.size(); ++i) {
      if (i == 4) continue;
      row[i] = fmt::format("{:.2f}", 100 * std::stod(row[i]) / total);
    }
    row[4] = row[3];
  }
  percent.header[4] = "ok";
  Chart chart = stacked(percent, 4, 4 + kDispositionCount);
  // Green for `ok`, and one style for a disposition in every report.
  static constexpr std::array<std::size_t, kDispositionCount> kStyles = {2, 5, 1, 0, 3, 4, 6, 7};
  for (Chart::Series& series : chart.series) series.style = kStyles.at(series.style);
  return chart;
}

Chart time_chart(const Selection& selection) {
  Chart chart = distribution(selection, wall_seconds());
  chart.name = "time-distribution";
  chart.title = "Meshed within this time";
  chart.x_title = selection.clock + " seconds";
  return chart;
}

Chart speed_chart(const Selection& selection) {
  Chart chart = distribution(selection, process_microseconds());
  chart.name = "speed-distribution";
  chart.title = "Microseconds per tetrahedron";
  chart.x_title = "microseconds per tetrahedron, whole process";
  return chart;
}

Chart phase_chart(const Selection& selection) {
  const Table table = phase_table(selection);
  return stacked(table, 2, table.header.size());
}

Chart cactus_chart(const Selection& selection) {
  Chart chart = cactus(selection, wall_seconds());
  chart.name = "cactus-time";
  chart.title = "Survival: models meshed when each may take so long";
  chart.y_title = selection.clock + " seconds";
  return chart;
}

Chart size_cactus_chart(const Selection& selection) {
  Chart chart = cactus(selection, of_solid(&MeshColumns::tetrahedra));
  chart.name = "cactus-size";
  chart.title = "Survival: models meshed when each may have so many tetrahedra inside";
  chart.y_title = "tetrahedra";
  return chart;
}

Chart figure_8_chart(const Selection& selection) {
  const Table table = figure_8_table(selection);
  Chart chart;
  chart.name = "figure8-chart";
  chart.title = "Tetrahedra as a wall gets thinner, after Figure 8";
  chart.kind = Chart::Kind::lines;
  chart.log_x = chart.log_y = true;
  chart.x_title = "1/h";
  chart.y_title = "tetrahedra";
  for (const auto& row : table.rows) {
    if (chart.series.empty() || chart.series.back().label != row[1]) {
      chart.series.push_back({.label = row[1], .style = style_of(selection, row[1])});
    }
    chart.series.back().points.emplace_back(1 / std::stod(row[0]), std::stod(row[2]));
  }
  return chart;
}

}  // namespace tetproof
