#include <fmt/core.h>

#include <memory>

#include "corpus/cli/commands.h"
#include "reports/report.h"

namespace tetproof {

Command add_report_command(CLI::App& tetproof) {
  struct Options {
    std::vector<std::string> databases;
    std::string folder;
  };
  auto options = std::make_shared<Options>();
  CLI::App* app = tetproof.add_subcommand("report", "Tables of one or more campaigns");
  app->add_option("databases", options->databases, "Results of tetproof run")
      ->required()
      ->check(CLI::ExistingFile);
  app->add_option("-o,--output", options->folder, "Folder of the report")->required();
  return {app, [options] {
            const Selection selection =
                load_runs({options->databases.begin(), options->databases.end()});
            const ReportFiles files = write_report(selection, options->folder);
            fmt::print("{}report: {}\n", files.headline,
                       std::filesystem::absolute(files.markdown).string());
            return 0;
          }};
}

}  // namespace tetproof
