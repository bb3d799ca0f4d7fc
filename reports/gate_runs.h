// The runs of the two sides that the gate compares.
#pragma once

#include <functional>
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

// A run, and the parsed texts that are compared.
struct Run {
  RunRow row;  // of several repetitions the one that ended worst, with the least time and memory
  std::vector<std::string> started;
  std::map<std::string, bool> passed;  // by oracle: those asked in all repetitions; passed in all
  nlohmann::json verdict, stats;
  std::vector<Run> others;  // repetitions that made a mesh

  // What an oracle has measured; nothing if it did not.
  std::optional<double> figure(const char* oracle, const char* name) const;
};

// A measure of one run.
using Getter = std::function<std::optional<double>(const Run&)>;

// The least and the largest of all repetitions; nothing if it was not measured in each of them.
std::optional<double> least(const Run& run, const Getter& value);
std::optional<double> most(const Run& run, const Getter& value);

using Runs = std::map<std::string, std::map<std::string, Run>>;  // by mesher, then model

// Rows that are alike in model, mesher, version, flags and limits are repetitions of one run; of
// several runs of a model and a mesher the latest counts.
Runs runs_of(const std::vector<RunRow>& rows);

}  // namespace tetproof
