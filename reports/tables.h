// The tables of a report. Every average says over how many models it is taken.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/selection.h"
#include "reports/table.h"

namespace tetproof {

// The paper's Table 1: our experiments over their own successes, angles before the enriched CDT in
// brackets.
Table table_1(const Selection& selection);

// The paper's Table 2: TetGen twice, CDT and our two, over the models on which all succeed.
Table table_2(const Selection& selection);

// Table 2's measures over the tetrahedra inside the model only, with our default run beside them.
Table table_2_inside(const Selection& selection);

// How many runs of each mesher ended how.
Table disposition_table(const Selection& selection);

// How many files of each mesher passed each oracle, with an example of every failure.
Table oracle_table(const Selection& selection);

// Microseconds and bytes per tetrahedron, and paired ratios to TetGen.
Table speed_table(const Selection& selection);

// Every run that is not ok.
Table failure_table(const Selection& selection);

// Every run, for other programs.
Table run_table(const Selection& selection);

// Of an even number of values the mean of the two in the middle; nothing of none.
std::optional<double> median(std::vector<double> values);

struct Interval {
  double low, high;
};

// Wilson's 95 % interval of a proportion.
Interval wilson_interval(std::size_t successes, std::size_t total);

}  // namespace tetproof
