#include "reports/resampling.h"

#include <cmath>
#include <random>

#include "reports/statistics.h"

namespace tetproof {
namespace {

constexpr int kResamplings = 2000;
constexpr double kTail = 0.01;  // share of the resamplings that may point elsewhere

// The quantile p of the weighted mean over resamplings of the sample, the same ones in every call.
double resampled_quantile(const std::vector<Weighted>& sample, double p) {
  std::mt19937_64 random(1);
  std::vector<double> means;
  std::vector<Weighted> drawn(sample.size());
  for (int i = 0; i < kResamplings; ++i) {
    for (Weighted& one : drawn) one = sample[random() % sample.size()];
    means.push_back(mean_of(drawn));
  }
  return *quantile(std::move(means), p);
}

}  // namespace

double mean_of(const std::vector<Weighted>& sample) {
  double sum = 0, weights = 0;
  for (const auto& [value, weight] : sample) {
    sum += value * weight;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

bool all_beyond(const std::vector<Weighted>& sample, double limit, double neutral, int sign) {
  if (sample.size() < kFewPairs) return false;
  if (sign * (mean_of(sample) - limit) <= 0) return false;
  return sign * (resampled_quantile(sample, sign > 0 ? kTail : 1 - kTail) - neutral) > 0;
}

double spread(const std::vector<double>& values) {
  if (values.size() < kFewPairs) return 0;
  const double middle = *median(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::fabs(value - middle));
  return 1.4826 * *median(distances);
}

}  // namespace tetproof
