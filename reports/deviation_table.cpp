// Our mesher with surfaces split, and each of its departures from the paper undone alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/figures.h"
#include "reports/measures.h"
#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {
namespace {

constexpr const char* kDefault = "delmesher-split";
constexpr const char* kPaper = "delmesher-e4";

bool is_variant(const std::string& mesher) {
  return mesher == kDefault || mesher == kPaper || mesher.starts_with("delmesher+");
}

// A mesh down to the box has tetrahedra that the default does not have, so the inside counts.
const MeshColumns& compared(const RunRow& row) {
  return row.inside ? *row.inside : *row.mesh;
}

// Over the models on which both are ok.
struct Paired {
  std::vector<double> sizes, times;  // relative to the default
  std::vector<double> face_angles, mean_face_angles, dihedrals, gammas;
  std::uint64_t tetrahedra = 0, default_tetrahedra = 0;
};

Paired paired(const Selection& selection, const std::string& mesher) {
  Paired p;
  for (const RunRow* row : selection.ok_runs(mesher)) {
    const RunRow* base = selection.ok_run(kDefault, row->key.model_sha256);
    if (base == nullptr) continue;
    const MeshColumns &mesh = compared(*row), &other = compared(*base);
    if (other.tetrahedra == 0) continue;
    p.tetrahedra += mesh.tetrahedra;
    p.default_tetrahedra += other.tetrahedra;
    p.sizes.push_back(static_cast<double>(mesh.tetrahedra) / static_cast<double>(other.tetrahedra));
    if (base->cpu_seconds > 0) p.times.push_back(row->cpu_seconds / base->cpu_seconds);
    p.face_angles.push_back(mesh.min_face_angle);
    p.mean_face_angles.push_back(mesh.mean_min_face_angle);
    p.dihedrals.push_back(mesh.min_dihedral);
    if (mesh.mean_gamma) p.gammas.push_back(*mesh.mean_gamma);
  }
  return p;
}

std::string text(const std::optional<double>& value) {
  return fixed(value, 3);
}

}  // namespace

Table deviation_table(const Selection& selection) {
  Table table;
  table.name = "deviations";
  table.title = "Departures from the paper, undone one at a time";
  table.header = {
      "Mesher",         "ok of runs",          "Models with both", "All tetrahedra", "per model",
      "Min face angle", "Mean min face angle", "Min dihedral",     "Mean gamma",     "Time"};
  const bool any = std::any_of(selection.meshers.begin(), selection.meshers.end(),
                               [](const std::string& m) { return m.starts_with("delmesher+"); });
  if (!selection.has(kDefault) || !any) return table;
  for (const std::string& mesher : selection.meshers) {
    if (!is_variant(mesher)) continue;
    const Paired p = paired(selection, mesher);
    const double all = p.default_tetrahedra == 0 ? 0
                                                 : static_cast<double>(p.tetrahedra) /
                                                       static_cast<double>(p.default_tetrahedra);
    table.rows.push_back(
        {mesher,
         fmt::format("{}/{}", selection.ok_runs(mesher).size(), selection.runs.at(mesher).size()),
         std::to_string(p.sizes.size()), fmt::format("{:.3f}", all), text(median(p.sizes)),
         text(mean(p.face_angles)), text(mean(p.mean_face_angles)), text(mean(p.dihedrals)),
         text(mean(p.gammas)), text(median(p.times))});
  }
  table.caption = limits_caption(selection, selection.meshers);
  table.notes = {
      "Over the models on which delmesher-split and the other are both ok, for the tetrahedra "
      "inside. "
      "Tetrahedra and processor time relative to delmesher-split: of all models together, and the "
      "median of the models' ratios. Angles and gamma are means over the models."};
  return table;
}

Chart deviation_chart(const Selection& selection) {
  Chart chart;
  chart.name = "deviations-chart";
  chart.title = "Tetrahedra and time relative to delmesher-split, medians over models";
  chart.kind = Chart::Kind::bars;
  chart.flat = true;
  chart.y_title = "over delmesher-split";
  if (!has_data(deviation_table(selection))) return chart;
  Chart::Series sizes{.label = "tetrahedra", .style = 0}, times{.label = "time", .style = 1};
  for (const std::string& mesher : selection.meshers) {
    if (!is_variant(mesher) || mesher == kDefault) continue;
    const Paired p = paired(selection, mesher);
    chart.categories.push_back(mesher);
    sizes.values.push_back(median(p.sizes));
    times.values.push_back(median(p.times));
  }
  chart.series = {sizes, times};
  return chart;
}

}  // namespace tetproof
