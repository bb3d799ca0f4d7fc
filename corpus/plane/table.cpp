#include <algorithm>
#include <cstdio>
#include <map>

#include "corpus/plane/bench.h"

namespace tetproof::plane_bench {
namespace {

std::string format(const char* pattern, double value) {
  char text[64];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string angle(double degrees) {
  return degrees < 0 ? "-" : degrees >= 0.01 ? format("%.2f", degrees) : format("%.1e", degrees);
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 != 0 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

double per_triangle(const Measurement& m) {
  return m.triangles == 0 ? 0 : 1e6 * m.seconds / static_cast<double>(m.triangles);
}

}  // namespace

std::string table_head() {
  return "| input | vertices | mesher | triangles | min angle before | after | mean min angle | us "
         "per triangle | MB |\n|---|---|---|---|---|---|---|---|---|\n";
}

std::string table_row(const Row& row) {
  const Measurement& m = row.measurement;
  const std::string text =
      "| " + row.input + " | " + std::to_string(row.vertices) + " | " + row.mesher + " | ";
  if (!m.ok) return text + "failed: " + m.reason + " | | | | | |\n";
  return text + std::to_string(m.triangles) + " | " + angle(m.refined_angle) + " | " +
         angle(m.final_angle) + " | " + format("%.2f", m.mean_angle) + " | " +
         format("%.2f", per_triangle(m)) + " | " + format("%.0f", m.peak_megabytes) + " |\n";
}

std::string summary(const std::vector<Row>& rows) {
  std::string text = "\n";
  // Only inputs on which both succeeded, or the harder inputs would count for one mesher alone.
  std::map<std::string, int> successes;
  std::map<std::string, double> first_time;
  for (const Row& row : rows) {
    successes[row.input] += row.measurement.ok;
    if (row.mesher == rows[0].mesher) first_time[row.input] = per_triangle(row.measurement);
  }
  std::map<std::string, std::vector<const Row*>> by_mesher;
  for (const Row& row : rows) by_mesher[row.mesher].push_back(&row);
  text +=
      "| mesher | succeeded | least min angle before | median min angle after | median mean min "
      "angle | median us per triangle | median of the time per triangle over that of " +
      (rows.empty() ? "" : rows[0].mesher) +
      " | median triangles |\n|---|---|---|---|---|---|---|---|\n";
  for (const auto& [mesher, own] : by_mesher) {
    std::size_t ok = 0;
    double before = 180;
    std::vector<double> after, mean, time, ratio, triangles;
    for (const Row* row : own) {
      const Measurement& m = row->measurement;
      if (!m.ok) continue;
      ++ok;
      before = std::min(before, m.refined_angle);
      if (successes[row->input] < static_cast<int>(by_mesher.size())) continue;
      after.push_back(m.final_angle);
      mean.push_back(m.mean_angle);
      time.push_back(per_triangle(m));
      ratio.push_back(per_triangle(m) / first_time[row->input]);
      triangles.push_back(static_cast<double>(m.triangles));
    }
    text += "| " + mesher + " | " + std::to_string(ok) + " of " + std::to_string(own.size()) +
            " | " + (before < 0 || ok == 0 ? "-" : format("%.4f", before)) + " | " +
            angle(median(after)) + " | " + format("%.2f", median(mean)) + " | " +
            format("%.2f", median(time)) + " | " + format("%.2f", median(ratio)) + " | " +
            format("%.0f", median(triangles)) + " |\n";
  }
  return text;
}

}  // namespace tetproof::plane_bench
