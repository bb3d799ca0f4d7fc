// Exports the rows of a campaign for other programs as CSV, JSON and JUnit XML, and reads the JSON
// back.
//
// Laws: rows come in the order of sort_rows(), whatever the order of storing; a `stable` export
// depends on models, meshers and results only, so that two campaigns over the same models, however
// they were interrupted, divided and merged, give the same bytes; JSON read back gives the rows
// written, except for the parts that were left out.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

struct ExportOptions {
  // For baselines: only what tetproof gate compares. Histograms, findings, ends of streams and the
  // place of the run are left out, and of the statistics all but the parameters and the refined
  // mesh.
  bool brief = false;
  // Leaves out the values that differ between equal campaigns: times, memory, host, paths.
  bool stable = false;
};

std::string rows_to_csv(std::vector<RunRow> rows, const ExportOptions& options = {});
std::string rows_to_json(std::vector<RunRow> rows, const ExportOptions& options = {});

// One suite per mesher, one test case per model. Every row that is not ok is a failure or an error,
// also a refusal. Nothing is reported as skipped, so that no failure hides there.
std::string rows_to_junit(std::vector<RunRow> rows);

// \throw std::runtime_error if the text is not an export in JSON.
std::vector<RunRow> rows_from_json(const std::string& text);

// Rows of a results file or of an export in JSON, distinguished by their first bytes.
// \throw std::runtime_error if the file cannot be read.
std::vector<RunRow> read_rows(const std::filesystem::path& path);

}  // namespace tetproof
