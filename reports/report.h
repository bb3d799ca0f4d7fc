// Writes a report: one Markdown file and a CSV file per table.
#pragma once

#include <filesystem>
#include <string>

#include "reports/selection.h"

namespace tetproof {

struct ReportFiles {
  std::filesystem::path markdown;
  std::string headline;  // Tables 1 and 2 as Markdown, to be printed
};

// \throw std::runtime_error if the folder cannot be written.
ReportFiles write_report(const Selection& selection, const std::filesystem::path& folder);

}  // namespace tetproof
