#include <fmt/core.h>

#include <filesystem>
#include <map>

#include "corpus/cli/commands.h"
#include "corpus/models/files.h"
#include "reports/export.h"

namespace tetproof {

namespace fs = std::filesystem;

int export_command(const ExportArguments& arguments) {
  std::map<RunKey, RunRow> by_key;
  for (const std::string& database : arguments.databases) {
    for (RunRow& row : read_rows(database)) {
      const auto [there, is_new] = by_key.try_emplace(row.key, row);
      if (!is_new && supersedes(row, there->second)) there->second = std::move(row);
    }
  }
  std::vector<RunRow> rows;
  for (auto& [key, row] : by_key) rows.push_back(std::move(row));
  const ExportOptions options = {arguments.brief, arguments.stable};
  const fs::path extension = fs::path(arguments.output).extension();
  const std::size_t count = rows.size();
  if (extension == ".csv") {
    write_whole(arguments.output, rows_to_csv(std::move(rows), options));
  } else if (extension == ".json") {
    write_whole(arguments.output, rows_to_json(std::move(rows), options));
  } else if (extension == ".xml") {
    write_whole(arguments.output, rows_to_junit(std::move(rows)));
  } else {
    throw UsageError("-o: a name that ends in .csv, .json or .xml is expected");
  }
  fmt::print("{} rows in {}\n", count, arguments.output);
  return 0;
}

int merge_command(const MergeArguments& arguments) {
  // All or nothing: what cannot be read leaves the target as it was.
  std::vector<RunRow> rows;
  for (const std::string& path : arguments.databases) {
    if (fs::exists(arguments.output) && fs::equivalent(path, arguments.output)) continue;
    for (RunRow& row : read_rows(path)) rows.push_back(std::move(row));
  }
  ResultsDatabase target(arguments.output, ResultsDatabase::Mode::write);
  std::size_t changed = 0;
  for (const RunRow& row : rows) changed += target.merge(row);
  fmt::print("{} rows read, {} new or newer in {}\n", rows.size(), changed, arguments.output);
  return 0;
}

}  // namespace tetproof
