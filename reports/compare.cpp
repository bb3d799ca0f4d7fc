#include "reports/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr const char* kBase = "@base";

struct Pairs {
  std::vector<double> log_ratios, differences;
};

Pairs pairs(const Selection& selection, const std::vector<std::string>& models,
            const std::string& first, const std::string& second, const Value& value) {
  Pairs result;
  for (const std::string& model : models) {
    const auto a = value(*selection.ok_run(first, model));
    const auto b = value(*selection.ok_run(second, model));
    if (!a || !b) continue;
    result.differences.push_back(*b - *a);
    if (*a > 0 && *b > 0) result.log_ratios.push_back(std::log(*b / *a));
  }
  return result;
}

std::optional<double> ratio_of(const Pairs& pairs) {
  const auto log_ratio = median(pairs.log_ratios);
  return log_ratio ? std::optional(std::exp(*log_ratio)) : std::nullopt;
}

std::string probability(double p) {
  return p < 0.001 ? "< 0.001" : fmt::format("{:.3f}", p);
}

std::string quantiles(const std::optional<double> (&values)[3]) {
  if (!values[1]) return "-";
  return fmt::format("{:+.2f} ({:+.2f} to {:+.2f})", *values[1], *values[0], *values[2]);
}

}  // namespace

Pairing pair_up(const Selection& selection, const std::string& first, const std::string& second) {
  Pairing p;
  p.first = first;
  p.second = second;
  for (const std::string& model : selection.models) {
    if (selection.run(first, model) == nullptr || selection.run(second, model) == nullptr) continue;
    const bool a = selection.ok_run(first, model) != nullptr;
    const bool b = selection.ok_run(second, model) != nullptr;
    ++p.models;
    p.both += a && b;
    p.only_first += a && !b;
    p.only_second += b && !a;
  }
  p.mcnemar = mcnemar_test(p.only_first, p.only_second);
  const auto common = selection.common_models({first, second});
  const auto of_common = [&](const Value& value) {
    return pairs(selection, common, first, second, value);
  };
  const Pairs times = of_common(wall_seconds());
  const Pairs sizes = of_common(of_solid(&MeshColumns::tetrahedra));
  const Pairs smallest = of_common(of_solid(&MeshColumns::min_face_angle));
  const Pairs average = of_common(of_solid(&MeshColumns::mean_min_face_angle));
  const auto covered_by = [&](const std::string& mesher) {
    Rows whole;
    for (const std::string& model : common) {
      const RunRow* row = selection.ok_run(mesher, model);
      if (!row->inside) whole.push_back(row);
    }
    return region_mark(whole).empty() ? "interior" : region_of(whole);
  };
  const std::string of_first = covered_by(first), of_second = covered_by(second);
  if (of_first != of_second) p.covers = " (" + of_first + " / " + of_second + ")";
  p.time_ratio = ratio_of(times);
  p.size_ratio = ratio_of(sizes);
  p.time_probability = wilcoxon_test(times.log_ratios);
  p.size_probability = wilcoxon_test(sizes.log_ratios);
  p.min_angle_probability = wilcoxon_test(smallest.differences);
  for (int i = 0; i < 3; ++i) {
    p.min_angle[i] = quantile(smallest.differences, 0.1 + 0.4 * i);
    p.mean_angle[i] = quantile(average.differences, 0.1 + 0.4 * i);
  }
  return p;
}

std::vector<std::pair<std::string, std::string>> pairs_of(const Selection& selection) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const std::string& mesher : selection.meshers) {
    if (selection.has(mesher + kBase)) result.emplace_back(mesher + kBase, mesher);
  }
  if (!result.empty()) return result;
  for (std::size_t i = 0; i < selection.meshers.size(); ++i) {
    for (std::size_t j = i + 1; j < selection.meshers.size(); ++j) {
      result.emplace_back(selection.meshers[i], selection.meshers[j]);
    }
  }
  return result;
}

Table pairing_table(const Selection& selection) {
  Table table;
  table.name = "pairs";
  table.title = "Paired comparison";
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"First",      "Second",
                  "Models",     "Both ok",
                  "Only first", "Only second",
                  "p",          "Time ratio",
                  "p",          "Size ratio",
                  "p",          "Min face angle, difference",
                  "p",          "Average min face angle, difference"};
  std::vector<Pairing> all;
  for (const auto& [first, second] : pairs_of(selection)) {
    all.push_back(pair_up(selection, first, second));
  }
  const auto adjusted = [&](double Pairing::*member) {
    std::vector<double> probabilities;
    for (const Pairing& p : all) probabilities.push_back(p.*member);
    return holm_adjusted(probabilities);
  };
  const auto success = adjusted(&Pairing::mcnemar), time = adjusted(&Pairing::time_probability),
             size = adjusted(&Pairing::size_probability),
             angle = adjusted(&Pairing::min_angle_probability);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Pairing& p = all[i];
    table.rows.push_back({p.first, p.second, std::to_string(p.models), std::to_string(p.both),
                          std::to_string(p.only_first), std::to_string(p.only_second),
                          probability(success[i]), fixed(p.time_ratio, 3), probability(time[i]),
                          fixed(p.size_ratio, 3) + p.covers, probability(size[i]),
                          quantiles(p.min_angle), probability(angle[i]), quantiles(p.mean_angle)});
  }
  table.notes = {
      "Ratios are medians of second / first over the models on which both succeed, differences "
      "second - first, median (10 % to 90 %), in degrees.",
      fmt::format("p: the probability of such a result by chance, of success by McNemar's exact "
                  "test, of time, size and angle by Wilcoxon's signed-rank test, adjusted for {} "
                  "pairs by Holm's method.",
                  all.size()),
      "Sizes and angles are of the tetrahedra inside where the file tells them; a mark says "
      "where it does not, and is different for the two."};
  std::string unverified;
  for (const std::string& mesher : selection.meshers) {
    const std::size_t count = unverified_count(selection, mesher);
    if (count > 0)
      unverified += fmt::format("{} {} {}", unverified.empty() ? "" : ",", mesher, count);
  }
  if (!unverified.empty()) {
    table.notes.push_back("Unverified meshes do not count as successes:" + unverified + ".");
  }
  if (all.empty()) table.notes.clear();
  return table;
}

}  // namespace tetproof
