// Numbers about samples, and tests of significance, as reports need them.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace tetproof {

// All of these give nothing for no values.
std::optional<double> mean(const std::vector<double>& values);
std::optional<double> minimum(const std::vector<double>& values);
// For an even number of values the mean of the two in the middle.
std::optional<double> median(std::vector<double> values);
// Linear between the two nearest values, for p from 0 to 1.
std::optional<double> quantile(std::vector<double> values, double p);

struct Interval {
  double low, high;
};

// Wilson's 95 % interval of a proportion.
Interval wilson_interval(std::size_t successes, std::size_t total);

// McNemar's exact test: the two-sided probability that, of the pairs in which only one side
// succeeded, so uneven a share or a more uneven one falls to one side by chance.
double mcnemar_test(std::size_t only_first, std::size_t only_second);

// Wilcoxon's signed-rank test on the differences of pairs, two-sided; zeros are left out, ties
// share ranks. Exact up to 20 differences without ties, else the normal approximation with
// corrections for ties and continuity. 1 if there are no differences.
double wilcoxon_test(const std::vector<double>& differences);

// Holm's adjustment of the probabilities of a family of tests, in the same order.
std::vector<double> holm_adjusted(const std::vector<double>& probabilities);

}  // namespace tetproof
