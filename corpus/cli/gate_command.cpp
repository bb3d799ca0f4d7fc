#include <fmt/core.h>

#include <iterator>

#include "corpus/cli/commands.h"
#include "reports/export.h"
#include "reports/gate.h"

namespace tetproof {
namespace {

std::vector<RunRow> rows_of(const std::vector<std::string>& paths) {
  std::vector<RunRow> rows;
  for (const std::string& path : paths) {
    auto more = read_rows(path);
    std::move(more.begin(), more.end(), std::back_inserter(rows));
  }
  return rows;
}

}  // namespace

int gate_command(const GateArguments& arguments) {
  GateOptions options = arguments.options;
  options.missing_is_bad = !arguments.allow_missing;
  options.fewer_is_bad = !arguments.allow_fewer;
  const GateReport report =
      compare_campaigns(rows_of(arguments.base), rows_of(arguments.fresh), options);
  for (const Finding& f : report.findings) {
    fmt::print("REGRESSION {}: {} {}: {}\n", finding_name(f.kind), f.mesher,
               f.model.empty() ? "(all models)" : f.model, f.text);
  }
  for (const std::string& note : report.notes) fmt::print("note: {}\n", note);
  for (const std::string& difference : report.differences) {
    fmt::print("DIFFERENCE: {}\n", difference);
  }
  fmt::print(
      "{} runs compared, {} with a mesh on both sides, {} verified on both; {}{} regressions\n",
      report.pairs, report.both_ok, report.verified,
      report.differences.empty()
          ? ""
          : fmt::format("{} differences between the sides, see above; ", report.differences.size()),
      report.findings.size());
  if (report.pairs == 0 && report.findings.empty()) {
    throw std::runtime_error("the two have no run of the same model and mesher in common");
  }
  return report.findings.empty() ? 0 : 1;
}

}  // namespace tetproof
