// Means of many models that a few of them do not decide.
#pragma once

#include <cstddef>
#include <vector>

namespace tetproof {

inline constexpr std::size_t kFewPairs = 8;  // below, neither spread nor resampling says anything

struct Weighted {
  double value, weight;
};

double mean_of(const std::vector<Weighted>& sample);

// Is the mean of many beyond a limit in the direction of `sign`, and not because of a few of them?
// 99 of 100 resamplings (bootstrap, the same ones in every call) must be beyond `neutral`.
bool all_beyond(const std::vector<Weighted>& sample, double limit, double neutral, int sign);

// 1.4826 times the median distance from the median, a standard deviation if all is normal.
double spread(const std::vector<double>& values);

}  // namespace tetproof
