// Meshers of the plane, over the models on which all of them succeed.
#include "reports/measures.h"
#include "reports/statistics.h"
#include "reports/tables.h"

namespace tetproof {

Table plane_table(const Selection& selection) {
  Table table;
  table.name = "plane";
  table.title = "Meshers of the plane";
  table.caption = limits_caption(selection, selection.meshers);
  std::vector<std::string> meshers;
  for (const std::string& mesher : selection.meshers) {
    const Rows rows = selection.ok_runs(mesher);
    if (!rows.empty() && region_of(rows) == "plane") meshers.push_back(mesher);
  }
  if (meshers.empty()) return table;
  const std::string& first = meshers.front();
  table.header = {"Mesher",
                  "Successes",
                  "Least min angle before the last step",
                  "Median min angle",
                  "Median mean min angle",
                  "Median triangles",
                  "Median us per triangle",
                  "Median of the time per triangle over that of " + first};
  const std::vector<std::string> common = selection.common_models(meshers);
  const Value microseconds = meshing_microseconds();
  for (const std::string& mesher : meshers) {
    Rows rows;
    std::vector<double> ratios;
    for (const std::string& model : common) {
      rows.push_back(selection.run(mesher, model));
      const auto own = microseconds(*rows.back()),
                 other = microseconds(*selection.run(first, model));
      if (own && other && *other > 0) ratios.push_back(*own / *other);
    }
    const auto middle = [&](const Value& value) { return median(values_of(rows, value)); };
    const auto before =
        values_of(selection.ok_runs(mesher), of(&RunRow::refined, &MeshColumns::min_face_angle));
    table.rows.push_back({mesher, successes_of(selection, mesher), degrees(minimum(before)),
                          degrees(middle(of(&RunRow::mesh, &MeshColumns::min_face_angle))),
                          degrees(middle(of(&RunRow::mesh, &MeshColumns::mean_min_face_angle))),
                          fixed(middle(of(&RunRow::mesh, &MeshColumns::tetrahedra)), 0),
                          fixed(middle(microseconds), 2), fixed(median(ratios), 2)});
  }
  table.notes = {"Medians over the " + std::to_string(common.size()) +
                 " models on which all of them succeed; times by the meshers' own account."};
  return table;
}

}  // namespace tetproof
