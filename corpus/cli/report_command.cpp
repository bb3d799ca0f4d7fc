#include <fmt/core.h>

#include "corpus/cli/commands.h"
#include "reports/report.h"

namespace tetproof {

int report_command(const ReportArguments& arguments) {
  const Selection selection = load_runs({arguments.databases.begin(), arguments.databases.end()});
  const ReportFiles files = write_report(selection, arguments.folder);
  fmt::print("{}report: {}\n", files.headline, std::filesystem::absolute(files.markdown).string());
  return 0;
}

}  // namespace tetproof
