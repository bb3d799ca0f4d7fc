#include "reports/report.h"

#include <fmt/format.h>

#include <fstream>
#include <stdexcept>

#include "reports/tables.h"

namespace tetproof {
namespace {

void write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path.string() + ": cannot be written");
}

Table mesher_table(const Selection& selection) {
  Table table;
  table.name = "meshers";
  table.title = "Meshers";
  table.header = {"Mesher", "Version", "Flags", "Limits", "Machine"};
  for (const std::string& mesher : selection.meshers) {
    const auto& runs = selection.runs.at(mesher);
    if (runs.empty()) continue;
    const RunRow& row = runs.begin()->second;
    table.rows.push_back({mesher, row.key.version, row.key.flags, row.key.limits, row.host});
  }
  table.notes = selection.notes;
  return table;
}

}  // namespace

ReportFiles write_report(const Selection& selection, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const Table one = table_1(selection), two = table_2(selection);
  const std::vector<Table> tables = {one,
                                     two,
                                     table_2_inside(selection),
                                     disposition_table(selection),
                                     oracle_table(selection),
                                     speed_table(selection),
                                     failure_table(selection),
                                     mesher_table(selection)};
  std::string text = fmt::format("# Meshing campaign\n\n{} models, {} meshers.\n\n",
                                 selection.models.size(), selection.meshers.size());
  for (const Table& table : tables) {
    text += to_markdown(table);
    write_file(folder / (table.name + ".csv"), to_csv(table));
  }
  text += "Every run, one a line: [runs.csv](runs.csv).\n";
  write_file(folder / "runs.csv", to_csv(run_table(selection)));
  write_file(folder / "report.md", text);
  return {folder / "report.md", to_markdown(one) + to_markdown(two)};
}

}  // namespace tetproof
