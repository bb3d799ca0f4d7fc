// What a campaign will cost, from the runs that have been measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "corpus/models/models.h"
#include "reports/results.h"

namespace tetproof {

// Processor seconds with the oracles' time, and memory of the mesher.
struct PlannedCost {
  double seconds = 0;
  std::uint64_t peak_bytes = 0;
};

struct PlannedMesher {
  std::string name;
  std::size_t runs = 0, measured = 0;
  double seconds = 0, longest_run = 0;
  std::uint64_t peak_bytes = 0;
};

struct Plan {
  std::vector<PlannedMesher> meshers;
  double seconds = 0;                         // of all runs
  double longest_shard = 0, longest_run = 0;  // seconds
  std::vector<double> by_model;               // seconds of all meshers, in the order of the models
  std::size_t runs = 0;
  std::uint64_t peak_bytes = 0;
};

// A run that is among the rows costs what it did. Of another one the seconds and the memory per
// byte of its file are the median and the 90 % quantile of the 9 measured models of that mesher
// whose files are nearest in size, its seconds at most `timeout` and the longest time of the
// oracles. \throw std::runtime_error if nothing was measured of a mesher.
Plan plan_of(const std::vector<Model>& models, const std::vector<std::string>& meshers,
             const std::vector<RunRow>& rows, unsigned shards, double timeout);

// What a collection costs of which the planned models are a sample.
struct Extrapolation {
  std::size_t models = 0;
  double seconds = 0, low = 0, high = 0;  // of all runs, and its 95 % interval
  double longest_shard = 0;               // seconds, the median
};

// A collection of so many models, each of which costs what one of the plan's does. The interval is
// that of 1000 resamplings, each of which draws a sample again from the plan's models and the
// collection from that; the longest shard is that of models dealt out evenly. The same in every
// call. \throw std::runtime_error if there are no models or more than the collection has.
Extrapolation extrapolated(const Plan& plan, std::size_t models, unsigned shards);

std::string to_text(const Extrapolation& all, unsigned shards, unsigned jobs);

// The plan in words, for a task that does `jobs` runs at a time.
std::string to_text(const Plan& plan, unsigned shards, unsigned jobs);

}  // namespace tetproof
