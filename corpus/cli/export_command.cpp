#include <fmt/core.h>

#include <filesystem>

#include "corpus/cli/commands.h"
#include "corpus/files.h"
#include "reports/export.h"

namespace tetproof {

namespace fs = std::filesystem;

int export_command(const ExportArguments& arguments) {
  std::vector<RunRow> rows;
  for (const std::string& database : arguments.databases) {
    for (RunRow& row : read_rows(database)) rows.push_back(std::move(row));
  }
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
  ResultsDatabase target(arguments.output, ResultsDatabase::Mode::write);
  std::size_t rows = 0, changed = 0;
  for (const std::string& path : arguments.databases) {
    if (fs::exists(arguments.output) && fs::equivalent(path, arguments.output)) continue;
    for (const RunRow& row : read_rows(path)) {
      ++rows;
      changed += target.merge(row);
    }
  }
  fmt::print("{} rows read, {} new or newer in {}\n", rows, changed, arguments.output);
  return 0;
}

}  // namespace tetproof
