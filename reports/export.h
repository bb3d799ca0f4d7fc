// The rows of a campaign for other programs: CSV, JSON and JUnit XML; and reading the JSON back.
//
// Laws: rows come in the order of sort_rows(), whatever the order of storing; a `stable` export
// depends on models, meshers and results only, so that two campaigns over the same models, however
// they were interrupted, divided and merged, give the same bytes; JSON read back gives the rows
// written, but for what was left out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

struct ExportOptions {
  // For baselines, what tetproof gate compares: no histograms, findings or ends of streams, of the
  // statistics only parameters and the refined mesh, and not where it ran.
  bool brief = false;
  bool stable = false;  // nor times, memory, host, paths: what differs between equal campaigns
};

std::string rows_to_csv(std::vector<RunRow> rows, const ExportOptions& options = {});
std::string rows_to_json(std::vector<RunRow> rows, const ExportOptions& options = {});

// One suite per mesher, one test case per model. Everything that is not ok is a failure, also a
// refusal: nothing is reported as skipped, so that no failure hides there.
std::string rows_to_junit(std::vector<RunRow> rows);

// \throw std::runtime_error if the text is no export in JSON.
std::vector<RunRow> rows_from_json(const std::string& text);

// Rows of a results file or of an export in JSON, told apart by their first bytes.
// \throw std::runtime_error if the file cannot be read.
std::vector<RunRow> read_rows(const std::filesystem::path& path);

}  // namespace tetproof
