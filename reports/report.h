// Writes a report: one self-contained HTML file, Markdown, LaTeX, and a CSV file per table and
// figure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/history.h"
#include "reports/league.h"
#include "reports/selection.h"
#include "reports/views.h"

namespace tetproof {

struct ReportOptions {
  // The model of Table 3 and Figure 13, by name; empty: the largest of those on which most succeed.
  std::string model;
  ViewOptions views;
  Families families = {};  // of the models, for the league
  // Campaigns in the order of time, for the section on what changed; the last is the selection.
  std::vector<HistoryStep> history = {};
};

struct ReportFiles {
  std::filesystem::path html, markdown;
  std::string headline;  // successes, warnings, Tables 1 and 2 as Markdown, to be printed
};

// \throw std::runtime_error if the folder cannot be written, or if no model has the name.
ReportFiles write_report(const Selection& selection, const std::filesystem::path& folder,
                         const ReportOptions& options = {});

}  // namespace tetproof
