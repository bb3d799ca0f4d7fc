#include <fmt/core.h>

#include "corpus/cli/commands.h"
#include "reports/league_page.h"
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
  if (arguments.league.empty() == arguments.folder.empty()) {
    throw UsageError("report: either -o FOLDER or --league PAGE.md is expected");
  }
  if (!arguments.families.empty()) options.families = Families(arguments.families);
  if (!arguments.league.empty()) {
    if (!arguments.league.ends_with(".md")) throw UsageError("--league: PAGE.md is expected");
    write_league(databases, arguments.league,
                 {options.families, arguments.commit, arguments.left_out});
    return 0;
  }
  Selection selection = load_runs(databases, {arguments.base.begin(), arguments.base.end()});
  if (arguments.processor_time) use_processor_time(selection);
  options.model = arguments.model;
  options.views.models = arguments.views;
  options.views.wanted = arguments.show;
  const ReportFiles files = write_report(selection, arguments.folder, options);
  fmt::print("{}report: {}\n", files.headline, std::filesystem::absolute(files.html).string());
  return 0;
}

}  // namespace tetproof
