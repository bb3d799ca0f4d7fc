// Numbers of the command line.
#pragma once

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <string>

namespace tetproof {

// A number from `low` to `high`. CLI::Range takes NaN, and a sign before a whole number.
inline CLI::Validator number_in(double low, double high) {
  const std::string wanted = fmt::format("a number from {} to {} is expected", low, high);
  return {[low, high, wanted](std::string& text) {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            const bool is_number = !text.empty() && *end == 0;
            return is_number && value >= low && value <= high ? std::string() : wanted;
          },
          ""};
}

// Limits of runs: from a millisecond to thirty years, from a MiB to a PiB.
inline CLI::Validator seconds_of_a_run() {
  return number_in(1e-3, 1e9);
}
inline CLI::Validator mebibytes_of_a_run() {
  return number_in(1, 1e9);
}

}  // namespace tetproof
