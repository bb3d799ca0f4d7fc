// The figures of a report, as data.
//
// Laws: bins are the same for all meshers of a chart; the bars of one mesher in a histogram add up
// to 100 % of the denominator named (its own successes in Figures 10 and 11, as in the paper; its
// own angles in Figure 13).
#pragma once

#include <string>
#include <vector>

#include "reports/chart.h"
#include "reports/measures.h"

namespace tetproof {

// Figure 10: the extreme angles of each model, four charts.
std::vector<Chart> extreme_angle_charts(const Selection& selection);
// Figure 11: the average angles of each model, four charts.
std::vector<Chart> average_angle_charts(const Selection& selection);
// The mean and the 1 % quantile of gamma of each model, two charts; none of old results.
std::vector<Chart> gamma_charts(const Selection& selection);
// Figure 13: all face and all dihedral angles of one model; of all models if `model` is empty.
std::vector<Chart> angle_charts(const Selection& selection, const std::string& model);

// The dispositions of the runs, in % of each mesher's runs.
Chart disposition_chart(const Selection& selection);
// The share of the successes by wall time, and by microseconds per tetrahedron.
Chart time_chart(const Selection& selection);
Chart speed_chart(const Selection& selection);
// The inset of section 8.1: mean share of each phase.
Chart phase_chart(const Selection& selection);
// Survival ("cactus"): how many models are meshed within each time in seconds, and with at most
// each number of tetrahedra.
Chart cactus_chart(const Selection& selection);
Chart size_cactus_chart(const Selection& selection);
// Figure 8: tetrahedra over the thickness of the wall, and the estimate.
Chart figure_8_chart(const Selection& selection);

// The medians of deviation_table(): tetrahedra and time.
Chart deviation_chart(const Selection& selection);

}  // namespace tetproof
