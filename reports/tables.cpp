#include "reports/tables.h"

#include <fmt/format.h>

#include <algorithm>

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

std::string with_refined(std::optional<double> value, std::optional<double> refined) {
  return refined ? degrees(value) + " (" + degrees(refined) + ")" : degrees(value);
}

enum class Over : std::uint8_t { common, own };  // models on which all succeed, or each

Table comparison(const Selection& selection, const std::vector<std::string>& meshers, Part part,
                 Over over = Over::common) {
  Table table;
  std::vector<std::string> common = selection.common_models(meshers);
  std::erase_if(common, [&](const auto& model) {
    return std::any_of(meshers.begin(), meshers.end(), [&](const auto& mesher) {
      return !(selection.ok_run(mesher, model)->*part);
    });
  });
  std::vector<Rows> columns;
  table.header = {"Measure"};
  for (const std::string& mesher : meshers) {
    table.header.push_back(mesher);
    Rows rows;
    for (const auto& model : over == Over::common ? common : selection.models) {
      if (const RunRow* row = selection.ok_run(mesher, model)) rows.push_back(row);
    }
    columns.push_back(std::move(rows));
  }
  for (const AngleMeasure& angle : kExtremeAngles) {
    add_row(table, std::string("Avg. ") + angle.label, columns, [&](const Rows& rows) {
      return degrees(mean(values_of(rows, of(part, angle.column))));
    });
  }
  add_row(table, "Avg. # vertices", columns, [&](const Rows& rows) {
    return fixed(mean(values_of(rows, of(part, &MeshColumns::vertices))), 0);
  });
  add_row(table, "Avg. # tetrahedra", columns, [&](const Rows& rows) {
    return fixed(mean(values_of(rows, of(part, &MeshColumns::tetrahedra))), 0);
  });
  std::vector<std::string> successes = {"Successes (ok of runs)"};
  for (const std::string& mesher : meshers) {
    successes.push_back(
        fmt::format("{}/{}", selection.ok_runs(mesher).size(), run_count(selection, mesher)));
  }
  table.rows.push_back(std::move(successes));
  table.notes.push_back(
      over == Over::own
          ? "Each column is averaged over the models on which that mesher succeeds: the columns "
            "are not over the same models."
          : fmt::format(
                "Averages over the {} of {} models on which all {} meshers of the table succeed.",
                common.size(), selection.models.size(), meshers.size()));
  return table;
}

}  // namespace

Table table_1(const Selection& selection) {
  Table table;
  table.name = "table1";
  table.title = "Table 1: averages per experiment";
  table.header = {"Measure"};
  std::vector<Rows> columns;
  const auto meshers = present(selection, {"safe-delmesher-e4", "delmesher-e4", "delmesher"});
  std::vector<std::string> models = {"Models (ok of runs)"};
  for (const std::string& mesher : meshers) {
    table.header.push_back(mesher);
    columns.push_back(selection.ok_runs(mesher));
    models.push_back(fmt::format("{}/{}", columns.back().size(), run_count(selection, mesher)));
  }
  table.rows.push_back(models);
  add_row(table, "Avg. # tetrahedra", columns, [](const Rows& rows) {
    return fixed(mean(values_of(rows, of(&RunRow::mesh, &MeshColumns::tetrahedra))), 0);
  });
  add_row(table, "Avg. # vertices", columns, [](const Rows& rows) {
    return fixed(mean(values_of(rows, of(&RunRow::mesh, &MeshColumns::vertices))), 0);
  });
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
  table.notes = {
      "Each column is averaged over the models on which that experiment succeeds (first row).",
      "In brackets: at the end of the refinement, before the enriched CDT, by the mesher's own "
      "statistics. All else is measured on the file as written.",
      "The two e4 experiments count every tetrahedron down to the outer box, as the paper does; "
      "delmesher is our default run, which writes and counts the inside of the model only.",
      "Time is the " + selection.clock +
          " time of the whole process, memory its peak resident set, 1 MB = 10^6 bytes."};
  return table;
}

Table table_2(const Selection& selection) {
  Table table = comparison(
      selection,
      present(selection, {"tetgen-T0", "tetgen", "cdt", "safe-delmesher-e4", "delmesher-e4"}),
      &RunRow::mesh);
  table.name = "table2";
  table.title = "Table 2: comparison on the common subset";
  table.notes.push_back(
      "All tetrahedra count, down to the convex hull (TetGen, CDT) or the outer box; cdt is our "
      "own "
      "constrained Delaunay tetrahedrization, not the published program.");
  return table;
}

Table table_2_all(const Selection& selection) {
  Table table = comparison(
      selection,
      present(selection, {"tetgen-T0", "tetgen", "cdt", "safe-delmesher-e4", "delmesher-e4"}),
      &RunRow::mesh, Over::own);
  table.name = "table2-all";
  table.title = "Table 2 over all successes of each mesher";
  return table;
}

Table table_2_inside(const Selection& selection) {
  Table table = comparison(selection,
                           present(selection, {"tetgen-T0", "tetgen", "cdt", "safe-delmesher-e4",
                                               "delmesher-e4", "delmesher"}),
                           &RunRow::inside);
  table.name = "table2-inside";
  table.title = "Table 2 inside the model only";
  table.notes.push_back("Only tetrahedra inside the model count, for every mesher.");
  return table;
}

Table disposition_table(const Selection& selection) {
  Table table;
  table.name = "dispositions";
  table.title = "What became of the runs";
  table.header = {"Mesher", "Runs", "ok", "ok %", "95 % interval"};
  for (std::size_t d = 1; d < kDispositionCount; ++d) {
    table.header.emplace_back(disposition_name(static_cast<Disposition>(d)));
  }
  table.header.push_back("ok with flat tets");
  for (const std::string& mesher : selection.meshers) {
    std::array<std::size_t, kDispositionCount> counts{};
    std::size_t with_flat = 0;
    for (const auto& [model, row] : selection.runs.at(mesher)) {
      ++counts[static_cast<std::size_t>(row.disposition)];
      with_flat += row.disposition == Disposition::ok && row.flat.value_or(0) > 0;
    }
    const std::size_t total = run_count(selection, mesher);
    const Interval interval = wilson_interval(counts[0], total);
    std::vector<std::string> row = {
        mesher, std::to_string(total), std::to_string(counts[0]),
        fixed(100.0 * static_cast<double>(counts[0]) / static_cast<double>(total), 1),
        fixed(100 * interval.low, 1) + " to " + fixed(100 * interval.high, 1)};
    for (std::size_t d = 1; d < kDispositionCount; ++d) row.push_back(std::to_string(counts[d]));
    row.push_back(std::to_string(with_flat));
    table.rows.push_back(std::move(row));
  }
  table.notes = {
      "ok: a mesh was delivered and the oracles have nothing against it. unverified: the oracles "
      "have not finished with it or were not asked, so that nobody vouches for it; not a success.",
      "wrong-result: a mesh was delivered but is unreadable, empty, has inverted "
      "tetrahedra by exact sign, or faces of more than two tetrahedra, or the oracles find it "
      "broken.",
      "Intervals are Wilson's."};
  return table;
}

Table speed_table(const Selection& selection) {
  Table table;
  table.name = "speed";
  table.title = "Microseconds and bytes per tetrahedron";
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
