#include "reports/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "reports/measures.h"
#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr std::uint64_t kLargeMesh = 10000;  // tetrahedra, where fixed costs of a process vanish

// Adds a row with one cell per mesher.
template <typename Cell>
void add_row(Table& table, const std::string& label, const std::vector<Rows>& columns, Cell cell) {
  std::vector<std::string> row = {label};
  for (const Rows& rows : columns) row.push_back(cell(rows));
  table.rows.push_back(std::move(row));
}

void add_counts(Table& table, const std::vector<Rows>& columns, Part part) {
  for (const auto& [label, column] : {std::pair("Avg. # vertices", &MeshColumns::vertices),
                                      std::pair("Avg. # tetrahedra", &MeshColumns::tetrahedra)}) {
    const auto value = of(part, column);
    add_row(table, label, columns, [&](const Rows& rows) {
      const std::string number = fixed(mean(values_of(rows, value)), 0);
      return number + (part == &RunRow::mesh ? region_mark(rows) : "");
    });
  }
}

// Rows of the shapes, where any mesh has been measured for them. Returns whether there are any.
bool add_shapes(Table& table, const std::vector<Rows>& columns, Part part) {
  const std::size_t before = table.rows.size();
  for (const ShapeMeasure& shape : kShapes) {
    const bool any = std::any_of(columns.begin(), columns.end(), [&](const Rows& rows) {
      return !values_of(rows, of(part, shape.column)).empty();
    });
    if (!any) continue;
    add_row(table, std::string("Avg. ") + shape.label, columns, [&](const Rows& rows) {
      const auto average = mean(values_of(rows, of(part, shape.column)));
      return fixed(average ? std::optional(shape.factor * *average) : std::nullopt, shape.digits);
    });
  }
  return table.rows.size() > before;
}

std::string with_refined(std::optional<double> value, std::optional<double> refined) {
  return refined ? degrees(value) + " (" + degrees(refined) + ")" : degrees(value);
}

constexpr const char* kRegions =
    "Region: interior counts the tetrahedra inside the model only, hull all of them, down to the "
    "convex hull or an outer box. Sizes compare within one region only.";

// Our experiments in the order of the paper's Table 1, then everybody else.
std::vector<std::string> experiments_first(const Selection& selection) {
  auto meshers = present(selection, {"safe-delmesher-e4", "delmesher-e4", "delmesher"});
  for (const std::string& mesher : selection.meshers) {
    if (std::find(meshers.begin(), meshers.end(), mesher) == meshers.end()) {
      meshers.push_back(mesher);
    }
  }
  return meshers;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

enum class Over : std::uint8_t { common, own };  // models on which all succeed, or each

// The models on which each of these meshers succeeds and has the part.
std::vector<std::string> common_to(const Selection& selection,
                                   const std::vector<std::string>& meshers, Part part) {
  std::vector<std::string> common;
  if (meshers.empty()) return common;
  common = selection.common_models(meshers);
  std::erase_if(common, [&](const auto& model) {
    return std::any_of(meshers.begin(), meshers.end(), [&](const auto& mesher) {
      return !(selection.ok_run(mesher, model)->*part);
    });
  });
  return common;
}

// Says over which models the averages are, and which mesher costs most of them.
std::string common_note(const Selection& selection, const std::vector<std::string>& meshers,
                        Part part, std::size_t common) {
  std::string note =
      fmt::format("Averages over the {} of {} models on which all {} meshers of the table succeed.",
                  common, selection.models.size(), meshers.size());
  std::string worst;
  std::size_t most = common;
  for (const std::string& mesher : meshers) {
    std::vector<std::string> others = meshers;
    std::erase(others, mesher);
    const std::size_t without = common_to(selection, others, part).size();
    if (without > most) {
      most = without;
      worst = mesher;
    }
  }
  if (!worst.empty()) note += fmt::format(" Without {} they would be over {}.", worst, most);
  return note;
}

Table comparison(const Selection& selection, Part part, Over over = Over::common) {
  const std::vector<std::string>& meshers = selection.meshers;
  // A mesher without any success would leave no model to compare the others on.
  std::vector<std::string> taking_part, without;
  for (const std::string& mesher : meshers) {
    const Rows rows = selection.ok_runs(mesher);
    const bool any =
        std::any_of(rows.begin(), rows.end(), [&](const RunRow* row) { return !!(row->*part); });
    (any ? taking_part : without).push_back(mesher);
  }
  Table table;
  table.caption = limits_caption(selection, meshers);
  const std::vector<std::string> common = common_to(selection, taking_part, part);
  std::vector<Rows> columns;
  table.header = {"Measure"};
  for (const std::string& mesher : meshers) {
    table.header.push_back(mesher);
    Rows rows;
    for (const auto& model : over == Over::common ? common : selection.models) {
      const RunRow* row = selection.ok_run(mesher, model);
      if (row != nullptr && row->*part) rows.push_back(row);
    }
    columns.push_back(std::move(rows));
  }
  for (const AngleMeasure& angle : kExtremeAngles) {
    add_row(table, std::string("Avg. ") + angle.label, columns, [&](const Rows& rows) {
      return degrees(mean(values_of(rows, of(part, angle.column))));
    });
  }
  const bool shapes = add_shapes(table, columns, part);
  add_counts(table, columns, part);
  if (part == &RunRow::mesh) add_row(table, "Region", columns, region_of);
  std::vector<std::string> successes = {"Successes (ok of runs)"};
  for (const std::string& mesher : meshers) successes.push_back(successes_of(selection, mesher));
  table.rows.push_back(std::move(successes));
  table.notes.push_back(
      over == Over::own
          ? "Each column is averaged over the models on which that mesher succeeds: the columns "
            "are not over the same models."
          : common_note(selection, taking_part, part, common.size()));
  if (over == Over::common && !without.empty()) {
    table.notes.push_back(
        "Not among the common models, since none of their successes can be compared: " +
        listed(without) + ".");
  }
  if (part == &RunRow::mesh) table.notes.emplace_back(kRegions);
  if (shapes) table.notes.emplace_back(kGammaNote);
  return table;
}

}  // namespace

Table table_1(const Selection& selection) {
  Table table;
  table.name = "table1";
  table.title = "Table 1: averages per mesher";
  table.header = {"Measure"};
  std::vector<Rows> columns;
  const auto meshers = experiments_first(selection);
  table.caption = limits_caption(selection, meshers);
  std::vector<std::string> models = {"Models (ok of runs)"};
  for (const std::string& mesher : meshers) {
    table.header.push_back(mesher);
    columns.push_back(selection.ok_runs(mesher));
    models.push_back(successes_of(selection, mesher));
  }
  if (!meshers.empty()) table.rows.push_back(models);
  if (!meshers.empty()) add_row(table, "Region", columns, region_of);
  add_counts(table, columns, &RunRow::mesh);
  for (const AngleMeasure& angle : kExtremeAngles) {
    add_row(table, std::string("Avg. ") + angle.label, columns, [&](const Rows& rows) {
      return with_refined(mean(values_of(rows, of(&RunRow::mesh, angle.column))),
                          mean(values_of(rows, of(&RunRow::refined, angle.column))));
    });
  }
  add_row(table, "Absolute min face angle", columns, [](const Rows& rows) {
    return with_refined(
        minimum(values_of(rows, of(&RunRow::mesh, &MeshColumns::min_face_angle))),
        minimum(values_of(rows, of(&RunRow::refined, &MeshColumns::min_face_angle))));
  });
  add_row(table, "Average time (s)", columns,
          [](const Rows& rows) { return fixed(mean(values_of(rows, wall_seconds())), 2); });
  add_row(table, "Average memory (MB)", columns,
          [](const Rows& rows) { return fixed(mean(values_of(rows, peak_megabytes())), 0); });
  const bool shapes = add_shapes(table, columns, &RunRow::mesh);
  const bool verified = std::any_of(columns.begin(), columns.end(), [](const Rows& rows) {
    return !values_of(rows, verify_seconds()).empty();
  });
  if (verified) {
    add_row(table, "Average time of the oracles (s)", columns,
            [](const Rows& rows) { return fixed(mean(values_of(rows, verify_seconds())), 2); });
  }
  table.notes = {
      "Each column is averaged over the models on which that mesher succeeds (first row): the "
      "columns are not over the same models.",
      "In brackets: at the end of the refinement, before the enriched CDT, by the mesher's own "
      "statistics. All else is measured on the file as written.",
      kRegions,
      "Time is the " + selection.clock +
          " time of the whole process, memory its peak resident set, 1 MB = 10^6 bytes."};
  if (shapes) table.notes.emplace_back(kGammaNote);
  return table;
}

Table table_2(const Selection& selection) {
  Table table = comparison(selection, &RunRow::mesh);
  table.name = "table2";
  table.title = "Table 2: comparison on the common subset";
  if (selection.has("cdt")) {
    table.notes.emplace_back(
        "cdt is our own constrained Delaunay tetrahedrization, not the published program.");
  }
  return table;
}

Table table_2_all(const Selection& selection) {
  Table table = comparison(selection, &RunRow::mesh, Over::own);
  table.name = "table2-all";
  table.title = "Table 2 over all successes of each mesher";
  return table;
}

Table table_2_inside(const Selection& selection) {
  Table table = comparison(selection, &RunRow::inside);
  // Without a file that marks its inside the table has no data.
  const bool any = std::any_of(
      selection.meshers.begin(), selection.meshers.end(), [&](const std::string& mesher) {
        return !values_of(selection.ok_runs(mesher), of(&RunRow::inside, &MeshColumns::tetrahedra))
                    .empty();
      });
  if (!any) table.rows.clear();
  table.name = "table2-inside";
  table.title = "Table 2 inside the model only";
  table.notes.push_back("Only tetrahedra inside the model count, for every mesher.");
  return table;
}

Table disposition_table(const Selection& selection) {
  Table table;
  table.name = "dispositions";
  table.title = "What became of the runs";
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"Mesher", "Runs", "ok", "ok %", "95 % interval"};
  append_dispositions(table.header);
  table.header.push_back("ok with flat tets");
  for (const std::string& mesher : selection.meshers) {
    std::size_t ok = 0, with_flat = 0;
    for (const auto& [model, row] : selection.runs.at(mesher)) {
      if (row.disposition != Disposition::ok) continue;
      ++ok;
      with_flat += row.flat.value_or(0) > 0 ? 1 : 0;
    }
    const std::size_t total = run_count(selection, mesher);
    const Interval interval = wilson_interval(ok, total);
    std::vector<std::string> row = {
        mesher, std::to_string(total), std::to_string(ok),
        fixed(100.0 * static_cast<double>(ok) / static_cast<double>(total), 1),
        fixed(100 * interval.low, 1) + " to " + fixed(100 * interval.high, 1)};
    append_dispositions(selection, mesher, row);
    row.push_back(std::to_string(with_flat));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "ok: a mesh was written and the oracles object to nothing. unverified: the oracles have not "
      "finished with it or did not run; not a success.",
      "wrong-result: a mesh was written but is unreadable, empty, has inverted "
      "tetrahedra by exact sign, or faces of more than two tetrahedra, or the oracles find it "
      "broken.",
      "Intervals are Wilson's."};
  return table;
}

Table speed_table(const Selection& selection) {
  Table table;
  table.name = "speed";
  table.title = "Microseconds and bytes per tetrahedron";
  table.caption = limits_caption(selection, selection.meshers);
  table.header = {"Mesher",
                  "Models",
                  "us/tet, median",
                  "us/tet, all tets",
                  "us/tet meshing only, median",
                  "Ratio to tetgen, median (pairs)",
                  "Meshing-only ratio, median (pairs)",
                  "Peak bytes/tet, median",
                  "Peak bytes/tet, large, median (models)"};
  const auto ratio = [&](const std::string& mesher, const Value& value) {
    std::vector<double> ratios;
    for (const std::string& model : selection.common_models({mesher, "tetgen"})) {
      const auto ours = value(*selection.ok_run(mesher, model));
      const auto theirs = value(*selection.ok_run("tetgen", model));
      if (ours && theirs && *theirs > 0) ratios.push_back(*ours / *theirs);
    }
    return fmt::format("{} ({})", fixed(median(ratios), 2), ratios.size());
  };
  for (const std::string& mesher : selection.meshers) {
    const Rows rows = selection.ok_runs(mesher);
    Rows large;
    double seconds = 0, tetrahedra = 0;
    for (const RunRow* row : rows) {
      seconds += row->wall_seconds;
      tetrahedra += static_cast<double>(row->mesh->tetrahedra);
      if (row->mesh->tetrahedra >= kLargeMesh) large.push_back(row);
    }
    const auto total = tetrahedra > 0 ? std::optional(1e6 * seconds / tetrahedra) : std::nullopt;
    table.rows.push_back(
        {mesher, std::to_string(rows.size()),
         fixed(median(values_of(rows, process_microseconds())), 2), fixed(total, 2),
         fixed(median(values_of(rows, meshing_microseconds())), 2),
         ratio(mesher, process_microseconds()), ratio(mesher, meshing_microseconds()),
         fixed(median(values_of(rows, peak_bytes())), 0),
         fmt::format("{} ({})", fixed(median(values_of(large, peak_bytes())), 0), large.size())});
  }
  table.notes = {
      "us/tet: " + selection.clock +
          " time of the whole process over the tetrahedra written; \"all tets\" is total "
          "time over total tetrahedra. Meshing only: without reading, checking and writing, by the "
          "mesher's own account (for TetGen the call of tetrahedralize()).",
      "Ratios are paired per model, over the models on which both succeed. delmesher writes the "
      "inside only but works on the outside too, so its figures per tetrahedron are not those of "
      "the others, which count everything.",
      fmt::format("Peak: largest resident set of the process. Large: at least {} tetrahedra.",
                  kLargeMesh)};
  return table;
}

}  // namespace tetproof
