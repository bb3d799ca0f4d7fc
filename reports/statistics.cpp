#include "reports/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace tetproof {
namespace {

constexpr std::size_t kLargestExact = 20;  // differences, for Wilcoxon's test

// The probability that a normal variable is further from 0 than this.
double two_sided(double z) {
  return std::erfc(std::fabs(z) / std::sqrt(2.0));
}

struct Ranks {
  std::vector<double> positive;  // ranks of the positive differences
  std::size_t count = 0;
  double tie_sum = 0;  // sum of t^3 - t over groups of t equal sizes
};

Ranks signed_ranks(std::vector<double> differences) {
  std::erase(differences, 0.0);
  std::sort(differences.begin(), differences.end(),
            [](double a, double b) { return std::fabs(a) < std::fabs(b); });
  Ranks ranks;
  ranks.count = differences.size();
  for (std::size_t i = 0; i < differences.size();) {
    std::size_t end = i;
    while (end < differences.size() && std::fabs(differences[end]) == std::fabs(differences[i])) {
      ++end;
    }
    const double rank = 0.5 * static_cast<double>(i + 1 + end);
    const double ties = static_cast<double>(end - i);
    ranks.tie_sum += ties * ties * ties - ties;
    for (; i < end; ++i) {
      if (differences[i] > 0) ranks.positive.push_back(rank);
    }
  }
  return ranks;
}

// The share of the 2^n sign patterns whose rank sum is at most this, or at least the mirror image.
double exact_signed_rank(std::size_t n, double sum) {
  const std::size_t total = n * (n + 1) / 2;
  std::vector<std::uint64_t> patterns(total + 1, 0);  // by rank sum
  patterns[0] = 1;
  for (std::size_t rank = 1; rank <= n; ++rank) {
    for (std::size_t s = total; s >= rank; --s) patterns[s] += patterns[s - rank];
  }
  const auto low = static_cast<std::size_t>(std::min(sum, static_cast<double>(total) - sum));
  const auto tail = std::accumulate(
      patterns.begin(), patterns.begin() + static_cast<std::ptrdiff_t>(low) + 1, std::uint64_t{0});
  return std::min(1.0, std::ldexp(2.0 * static_cast<double>(tail), -static_cast<int>(n)));
}

}  // namespace

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::optional<double> minimum(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return *std::min_element(values.begin(), values.end());
}

std::optional<double> median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

std::optional<double> quantile(std::vector<double> values, double p) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double place = p * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  const double share = place - static_cast<double>(below);
  if (share == 0) return values[below];  // also where the next one is infinite
  return (1 - share) * values[below] + share * values[above];
}

Interval wilson_interval(std::size_t successes, std::size_t total) {
  if (total == 0) return {0, 1};
  constexpr double kZ = 1.959963984540054;
  const double n = static_cast<double>(total), p = static_cast<double>(successes) / n;
  const double center = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  return {std::max(0.0, center - half), std::min(1.0, center + half)};
}

double mcnemar_test(std::size_t only_first, std::size_t only_second) {
  const std::size_t n = only_first + only_second, low = std::min(only_first, only_second);
  const auto log_factorial = [](std::size_t k) { return std::lgamma(static_cast<double>(k) + 1); };
  double tail = 0;
  for (std::size_t k = 0; k <= low; ++k) {
    tail += std::exp(log_factorial(n) - log_factorial(k) - log_factorial(n - k) -
                     static_cast<double>(n) * std::log(2.0));
  }
  return std::min(1.0, 2 * tail);
}

double wilcoxon_test(const std::vector<double>& differences) {
  const Ranks ranks = signed_ranks(differences);
  if (ranks.count == 0) return 1;
  const double sum = std::accumulate(ranks.positive.begin(), ranks.positive.end(), 0.0);
  if (ranks.count <= kLargestExact && ranks.tie_sum == 0) {
    return exact_signed_rank(ranks.count, sum);
  }
  const double n = static_cast<double>(ranks.count);
  const double expected = n * (n + 1) / 4;
  const double variance = n * (n + 1) * (2 * n + 1) / 24 - ranks.tie_sum / 48;
  const double distance = std::max(0.0, std::fabs(sum - expected) - 0.5);
  return two_sided(distance / std::sqrt(variance));
}

std::vector<double> holm_adjusted(const std::vector<double>& probabilities) {
  std::vector<std::size_t> order(probabilities.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return probabilities[a] < probabilities[b]; });
  std::vector<double> adjusted(probabilities.size());
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double factor = static_cast<double>(order.size() - i);
    largest = std::max(largest, std::min(1.0, factor * probabilities[order[i]]));
    adjusted[order[i]] = largest;
  }
  return adjusted;
}

}  // namespace tetproof
