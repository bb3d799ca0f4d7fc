// Paired comparison of meshers, or of two versions of one, over the models that both were run on.
//
// Laws: swapping the two sides inverts every ratio, negates every difference and leaves every
// probability as it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/measures.h"
#include "reports/table.h"

namespace tetproof {

struct Pairing {
  std::string first, second;                              // meshers
  std::size_t models = 0;                                 // run with both
  std::size_t both = 0, only_first = 0, only_second = 0;  // successes
  double mcnemar = 1;  // the probability by chance of a split that is as uneven
  // The median of second / first over the models on which both succeed; and the probabilities of
  // Wilcoxon's test on the logarithms.
  std::optional<double> time_ratio, size_ratio;  // of tetrahedra inside where the files tell them
  std::string covers;  // where they do not, for one of the two: " (hull / interior)"
  double time_probability = 1, size_probability = 1;
  // Quantiles (10, 50, 90 %) of the difference second - first of the smallest and the average
  // smallest face angle, in degrees.
  std::optional<double> min_angle[3], mean_angle[3];
  double min_angle_probability = 1;
};

Pairing pair_up(const Selection& selection, const std::string& first, const std::string& second);

// Each mesher NAME with NAME@base if there are such, else all pairs of meshers.
std::vector<std::pair<std::string, std::string>> pairs_of(const Selection& selection);
Table pairing_table(const Selection& selection);

}  // namespace tetproof
