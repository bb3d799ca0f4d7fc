// Compares a campaign with an earlier one and finds what got worse.
//
// Laws: a campaign against itself has no finding; leaving out models or adding better results gives
// no finding but "missing"; every disposition but ok counts as not ok, refusals and skips included.
#pragma once

#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

// A ratio new/base above its factor is a regression if it is beyond noise as well.
struct GateOptions {
  double time_factor = 1.5;    // of processor seconds
  double memory_factor = 1.3;  // of the peak resident set
  double size_factor = 1.05;   // of tetrahedra
  // Differences below these are noise whatever the ratio.
  double least_seconds = 0.2;
  double least_bytes = 16e6;
  double least_tetrahedra = 50;
  bool missing_is_bad = true;  // a model or mesher of the base that the new campaign lacks
};

enum class FindingKind : std::uint8_t { disposition, verdict, time, memory, size, missing };

struct Finding {
  FindingKind kind;
  std::string mesher, model;  // no model: all models of the mesher together
  std::string text;           // one line, without the two names
};

struct GateReport {
  std::size_t pairs = 0;  // runs found in both
  std::vector<Finding> findings;
  std::vector<std::string> notes;  // what was not compared, and what got better
};

// Rows belong together if model and mesher are the same, whatever versions, flags and limits; of
// several the latest counts. Times and memory are compared relative to the median ratio over the
// pairs of a mesher if the campaigns ran on different machines, so that a slower machine is no
// regression; on the same machine the median itself must stay below the factor too. A single model
// is slower only if its ratio also stands out of the spread of all (4 robust deviations).
GateReport compare_campaigns(const std::vector<RunRow>& base, const std::vector<RunRow>& fresh,
                             const GateOptions& options = {});

const char* finding_name(FindingKind kind);

}  // namespace tetproof
