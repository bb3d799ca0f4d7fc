// The runs of the two sides that the gate compares.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "reports/results.h"

namespace tetproof {

// The better, the larger; 0 if the oracles have come to no verdict.
int verdict_rank(const std::string& verdict);

// Is there a mesh that no oracle has objected to, verified or not?
bool has_mesh(const RunRow& row);

// A run with its repetitions, and the parsed texts that are compared.
struct Run {
  RunRow row;
  std::vector<std::string> started;
  std::map<std::string, bool> passed;  // by oracle
  nlohmann::json verdict, stats;

  // What an oracle has measured; nothing if it did not.
  std::optional<double> figure(const char* oracle, const char* name) const;
};

using Runs = std::map<std::string, std::map<std::string, Run>>;  // by mesher, then model

// Rows that are alike in model, mesher, version, flags and limits are repetitions of one run; of
// several runs of a model and a mesher the latest counts.
Runs runs_of(const std::vector<RunRow>& rows);

}  // namespace tetproof
