// Table 3, the ablation of section 4.4, and Figure 8.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/measures.h"
#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

// An angle of Table 3, with more digits near 0 and near 180, where they matter.
std::string precise(double degrees_value) {
  const double rest = std::min(degrees_value, 180 - degrees_value);
  return rest >= 0.1 || rest == 0 ? fmt::format("{:.2f}", degrees_value)
                                  : fmt::format("{:.6g}", degrees_value);
}

// The ratio of a value without bridge simplification to that with it, over the pairs.
std::string ratio_cell(const std::vector<std::pair<double, double>>& pairs) {
  std::vector<double> ratios;
  for (const auto& [with, without] : pairs) {
    if (with > 0) ratios.push_back(without / with);
  }
  const auto low = quantile(ratios, 0.1), mid = median(ratios), high = quantile(ratios, 0.9);
  return mid ? fmt::format("{:.3f} ({:.3f} to {:.3f})", *mid, *low, *high) : "-";
}

double height_in_name(const std::string& name) {
  return std::strtod(name.c_str() + std::string("figure8-h").size(), nullptr);
}

}  // namespace

Table table_3(const Selection& selection, const std::string& model) {
  Table table;
  const auto name = selection.model_names.find(model);
  table.name = "table3";
  table.title = "Table 3: one model, " +
                (name == selection.model_names.end() ? "none" : short_name(name->second));
  table.header = {"Measure"};
  Rows rows;
  std::vector<std::string> unverified;
  for (const std::string& mesher : selection.meshers) {
    const RunRow* row = selection.ok_run(mesher, model);
    const RunRow* any = selection.run(mesher, model);
    if (any != nullptr && any->disposition == Disposition::unverified) unverified.push_back(mesher);
    if (row == nullptr) continue;
    table.header.push_back(mesher);
    rows.push_back(row);
  }
  const auto add = [&](std::string label, const auto& cell) {
    std::vector<std::string> cells = {std::move(label)};
    for (const RunRow* row : rows) cells.push_back(cell(*row));
    table.rows.push_back(std::move(cells));
  };
  if (rows.empty()) return table;
  table.caption = limits_caption(selection, {table.header.begin() + 1, table.header.end()});
  add("Number of vertices",
      [](const RunRow& r) { return std::to_string(r.mesh->vertices) + region_mark({&r}); });
  add("Number of tetrahedra",
      [](const RunRow& r) { return std::to_string(r.mesh->tetrahedra) + region_mark({&r}); });
  for (const auto& angles : {kExtremeAngles, kAverageAngles}) {
    for (int i = 0; i < 4; ++i) {
      add(angles[i].label, [&](const RunRow& r) { return precise((*r.mesh).*(angles[i].column)); });
    }
  }
  table.notes = {
      "Only meshers that succeed on the model. Averages are over faces and over tetrahedra."};
  bool any_shape = false;
  for (const ShapeMeasure& shape : kShapes) {
    const Value value = of(&RunRow::mesh, shape.column);
    if (values_of(rows, value).empty()) continue;
    any_shape = true;
    add(shape.label, [&](const RunRow& r) {
      const auto told = value(r);
      return fixed(told ? std::optional(shape.factor * *told) : std::nullopt, shape.digits);
    });
  }
  if (any_shape) table.notes.emplace_back(kGammaNote);
  add("Time (s)", [](const RunRow& r) { return fixed(r.wall_seconds, 2); });
  for (const std::string& mesher : unverified) {
    table.notes.push_back("Left out, as its mesh is unverified: " + mesher + ".");
  }
  return table;
}

Table ablation_table(const Selection& selection) {
  const std::string with = "delmesher-e4", without = "delmesher-nobridges";
  Table table;
  table.name = "ablation";
  table.title = "What the simplification of bridges (section 4.4) does";
  table.header = {"Measure", "with", "without", "without/with, median (10 % to 90 %)"};
  const auto common = selection.common_models({with, without});
  if (common.empty()) return table;
  table.caption = limits_caption(selection, {with, without});
  const auto add = [&](const std::string& label, const Value& value, int digits) {
    std::vector<std::pair<double, double>> pairs;
    std::vector<double> firsts, seconds;
    for (const std::string& model : common) {
      const auto a = value(*selection.ok_run(with, model));
      const auto b = value(*selection.ok_run(without, model));
      if (!a || !b) continue;
      pairs.emplace_back(*a, *b);
      firsts.push_back(*a);
      seconds.push_back(*b);
    }
    table.rows.push_back(
        {label, fixed(mean(firsts), digits), fixed(mean(seconds), digits), ratio_cell(pairs)});
  };
  add(
      "Avg. meshing time (s)", [](const RunRow& r) { return r.mesh_seconds; }, 3);
  add("Avg. # tetrahedra", of(&RunRow::mesh, &MeshColumns::tetrahedra), 0);
  add("Avg. # tetrahedra, refined", of(&RunRow::refined, &MeshColumns::tetrahedra), 0);
  add("Avg. shortest edge", of(&RunRow::mesh, &MeshColumns::shortest_edge), 6);
  table.notes = {
      fmt::format("Over the {} models on which both succeed. The shortest edge is that "
                  "of the final mesh as written.",
                  common.size())};
  return table;
}

Table figure_8_table(const Selection& selection) {
  Table table;
  table.name = "figure8";
  table.title = "One wall getting thinner, after Figure 8";
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"h",
                  "Mesher",
                  "Tetrahedra",
                  "Seconds",
                  "Shortest edge L",
                  "V / L^3",
                  "K = tetrahedra L^3 / V"};
  std::vector<std::string> models;
  for (const std::string& model : selection.models) {
    if (short_name(selection.model_names.at(model)).starts_with("figure8-h")) {
      models.push_back(model);
    }
  }
  const auto height = [&](const std::string& model) {
    return height_in_name(short_name(selection.model_names.at(model)));
  };
  std::sort(models.begin(), models.end(),
            [&](const auto& a, const auto& b) { return height(a) > height(b); });
  for (const std::string& mesher : selection.meshers) {
    for (const std::string& model : models) {
      const RunRow* row = selection.ok_run(mesher, model);
      if (row == nullptr || row->mesh->shortest_edge <= 0) continue;
      const double cubes = row->mesh->volume / std::pow(row->mesh->shortest_edge, 3);
      table.rows.push_back(
          {fmt::format("{:g}", height(model)), mesher, std::to_string(row->mesh->tetrahedra),
           fixed(row->wall_seconds, 2), fmt::format("{:.3g}", row->mesh->shortest_edge),
           fmt::format("{:.3g}", cubes),
           fmt::format("{:.2g}", static_cast<double>(row->mesh->tetrahedra) / cubes)});
    }
  }
  table.notes = {
      "Shewchuk's estimate bounds the number of tetrahedra by K V / L^3 with a small "
      "constant K, V the volume meshed and L the shortest edge; it holds if the last "
      "column stays small as h decreases. The models are our own, made by corpus/models/figure8 "
      "after the "
      "paper's figure."};
  return table;
}

}  // namespace tetproof
