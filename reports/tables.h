// The tables of a report. Every average says over how many models it is taken. Every comparison of
// meshers says within which limits they ran and how many meshes are unverified. A table without
// data has no rows.
#pragma once

#include <string>
#include <vector>

#include "reports/selection.h"
#include "reports/table.h"

namespace tetproof {

// As the paper's Table 1, but of every mesher: averages over its own successes, angles before the
// enriched CDT in brackets.
Table table_1(const Selection& selection);

// As the paper's Table 2, but of every mesher: averages over the models on which all meshers with
// any success succeed.
Table table_2(const Selection& selection);

// The same over all models on which each mesher succeeds.
Table table_2_all(const Selection& selection);

// Table 2's measures over the tetrahedra inside the model only; no rows if no file distinguishes
// them.
Table table_2_inside(const Selection& selection);

// As the paper's Table 3: one model with all meshers that succeed on it.
Table table_3(const Selection& selection, const std::string& model);

// Section 4.4: delmesher-e4 with and without bridge simplification, over the models on which both
// succeed. No rows if one of them was not run.
Table ablation_table(const Selection& selection);

// As the paper's Figure 8: models named figure8-h*, with the estimate of the number of tetrahedra
// from the volume and the shortest edge. No rows if there are none.
Table figure_8_table(const Selection& selection);

// Rotated copies (NAME@r1.off, NAME@r1s.off; tetproof rotate) beside their models: success, and
// sizes and angles relative to those of the model as given. No rows if there are none.
Table rotated_table(const Selection& selection);

// Exact copies (NAME@t1.off and so on; reports/relations.h, tetproof vary) beside their models: how
// often a mesher ended in another disposition; and each of these pairs. No rows if there are none.
Table vary_table(const Selection& selection);
Table vary_changes_table(const Selection& selection);

// Our mesher's default, delmesher+NAME for each departure from the paper undone alone, and the
// paper's preset (tetproof run --ablation). No rows without the default or without such departures.
Table deviation_table(const Selection& selection);

// How often the limits that our mesher sets itself struck: chamfers up to 90 degrees, the cap
// on slivers, restarts of the constrained tetrahedrization, points taken out again. No rows without
// statistics of them.
Table limit_table(const Selection& selection);

// How often our mesher took the rungs of its ladder. No rows if it took none.
Table ladder_table(const Selection& selection);

// Meshers of the plane: success, angles, triangles, time. No rows if there are none.
Table plane_table(const Selection& selection);

// How long runs took, in the paper's classes and shorter ones.
Table time_table(const Selection& selection);

// The mean share of each phase in the time of our runs, in percent.
Table phase_table(const Selection& selection);

// How many runs of each mesher ended in each disposition.
Table disposition_table(const Selection& selection);

// How many files of each mesher passed each oracle, with an example of every failure.
Table oracle_table(const Selection& selection);

// Microseconds and bytes per tetrahedron, and paired ratios to TetGen.
Table speed_table(const Selection& selection);

// The 25 runs that took longest.
Table slowest_table(const Selection& selection);

// Runs that are not ok, by mesher, disposition and reason without names and numbers.
Table failure_group_table(const Selection& selection);

// Every run that is not ok.
Table failure_table(const Selection& selection);

}  // namespace tetproof
