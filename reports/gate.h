// Compares a campaign with an earlier one and finds the measures that got worse.
//
// Laws: a campaign against itself has no finding; leaving out models or adding better results gives
// no finding but "missing"; every disposition but ok and unverified counts as no mesh, refusals
// included; a measure that only one of the two sides has is named, never passed over.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

// Limits for one model are wide, because any change of the mesher changes every mesh a little.
// Limits for all models of a mesher together are narrow, because such changes cancel out. A limit
// for all models counts from 8 pairs on, and only if 99 of 100 resamplings of the models
// (bootstrap) agree on the direction, so that a few models never decide for all.
struct GateOptions {
  double time_factor = 1.5;     // processor seconds of one model, new/base
  double memory_factor = 1.3;   // peak resident set of one model
  double size_factor = 1.05;    // tetrahedra of one model, more or fewer
  double angle_factor = 0.8;    // smallest face angle, smallest dihedral, 1 % quantile of gamma
  double mean_factor = 0.95;    // a mean of one model: angles (of largest ones, 180 less it), gamma
  double sliver_share = 0.02;   // share of tetrahedra with a small dihedral, new - base
  double deviation_ulps = 0.2;  // surface off by this many ulp more, and 1.5 times as far

  // All models of a mesher together.
  double total_time_factor = 1.07;
  double total_memory_factor = 1.1;
  double total_size_factor = 1.03;
  double total_angle_factor = 0.9;
  double total_mean_factor = 0.98;
  double total_sliver_share = 0.005;

  // Differences of one model below these are noise, whatever the ratio.
  double least_seconds = 0.2;
  double least_bytes = 16e6;
  double least_tetrahedra = 50;
  double least_slivers = 5;  // tetrahedra with a small dihedral

  bool missing_is_bad = true;           // a model or mesher of the base that the new campaign lacks
  bool fewer_is_bad = true;             // fewer tetrahedra, unless declared to be intended
  bool quiet_machine = false;           // times count as if the two sides had been measured in turn
  std::set<std::string> may_be_silent;  // oracles that the new campaign need not have asked
};

enum class FindingKind : std::uint8_t {
  disposition,  // there was a mesh, and is none
  unverified,   // the oracles do not come to a verdict any more
  verdict,      // exact, rounded, deviating: worse
  oracle,       // it passed, and fails or was not asked now
  conformity,   // the written surface is farther off the input, or input vertices moved
  face_angle,   // smallest face angle, refined or final
  dihedral,     // smallest dihedral, refined or final
  slivers,      // share of tetrahedra with a dihedral below 5 or 10 degrees
  mean_angle,
  gamma,  // mean or 1 % quantile of gamma
  size,   // more tetrahedra, or fewer
  time,
  memory,
  missing,
  unmeasured  // the base has a measure, the new side has not
};

struct Finding {
  FindingKind kind;
  std::string mesher, model;  // no model: all models of the mesher together
  std::string text;           // one line with both values, without the two names
};

struct GateReport {
  std::size_t pairs = 0;     // runs found in both
  std::size_t both_ok = 0;   // of these, meshes on both sides
  std::size_t verified = 0;  // of these, verified on both sides
  std::vector<Finding> findings;
  // What makes the two sides incomparable in part, a line each: other flags, versions, limits or
  // settings, and measures that the base lacks. Print them beside the count of findings.
  std::vector<std::string> differences;
  std::vector<std::string> notes;  // measures compared relatively, and improvements
};

// Do the oracles vouch for the mesh of this run?
bool is_verified(const RunRow& row);

// Rows belong together if model and mesher are the same, whatever versions, flags and limits; the
// latest of several counts. Rows of one side that are alike in these as well (from several files)
// are repetitions of one run: the least time and memory count, and the worst of all other measures.
//
// If the campaigns ran on different machines, times and memory are compared relative to the median
// ratio over the pairs of a mesher, so that a slower machine is not a regression. On the same
// machine a single model is slower only if its ratio also stands out of the spread of all (4 robust
// deviations). All models together are slower if the mean of their ratios, each weighted by the
// seconds of the base up to 1 s, is beyond total_time_factor; for short runs that is the ratio of
// the sums. This limit is so narrow only if the two sides were measured in turn (at least base,
// new, base, new), since the state of a machine drifts by more. Otherwise time_factor counts for
// all models as well.
GateReport compare_campaigns(const std::vector<RunRow>& base, const std::vector<RunRow>& fresh,
                             const GateOptions& options = {});

const char* finding_name(FindingKind kind);  // "face-angle", ...

}  // namespace tetproof
