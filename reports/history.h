// Campaigns one after another, as of the commits of a repository: what became of success, size,
// angles and time, and which campaign changed each.
//
// Laws: a campaign beside itself changes nothing; sums of a mesher are over the models that it
// meshed in every campaign that has it, so that they never change because other models were run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reports/chart.h"
#include "reports/selection.h"
#include "reports/table.h"

namespace tetproof {

struct HistoryStep {
  std::string name;  // of the file, without folders and extension
  Selection runs;
};

// Results files in the order of time. \throw std::runtime_error if one cannot be read.
std::vector<HistoryStep> load_history(const std::vector<std::filesystem::path>& databases);

// A row per mesher and campaign: version, successes, and over the mesher's common models the sum of
// tetrahedra and of processor time, the means of the smallest angles.
Table history_table(const std::vector<HistoryStep>& steps);

// What changed in a model from one campaign to the next, the largest first: another disposition, or
// a measure by more than its limit. At most 100 rows; a note says how many there are.
Table history_changes(const std::vector<HistoryStep>& steps);

// Tetrahedra, or processor time, of each mesher's common models relative to its first campaign.
Chart history_size_chart(const std::vector<HistoryStep>& steps);
Chart history_time_chart(const std::vector<HistoryStep>& steps);

}  // namespace tetproof
