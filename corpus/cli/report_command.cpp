#include <fmt/core.h>

#include "corpus/cli/commands.h"
#include "reports/report.h"

namespace tetproof {

int report_command(const ReportArguments& arguments) {
  ReportOptions options;
  std::vector<std::filesystem::path> databases(arguments.databases.begin(),
                                               arguments.databases.end());
  if (arguments.history) {
    options.history = load_history(databases);
    databases = {databases.back()};
  }
  Selection selection = load_runs(databases, {arguments.base.begin(), arguments.base.end()});
  if (arguments.processor_time) use_processor_time(selection);
  options.model = arguments.model;
  options.views.models = arguments.views;
  options.views.wanted = arguments.show;
  if (!arguments.families.empty()) options.families = Families(arguments.families);
  const ReportFiles files = write_report(selection, arguments.folder, options);
  fmt::print("{}report: {}\n", files.headline, std::filesystem::absolute(files.html).string());
  return 0;
}

}  // namespace tetproof
