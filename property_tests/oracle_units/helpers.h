// What the tests of the oracles' pieces share.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "oracles/base/exact_points.h"

namespace tetproof {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline oracles::ExactPoints points_of(const std::vector<oracles::Position>& positions) {
  oracles::ExactPoints points;
  EXPECT_EQ(points.assign(positions), "");
  return points;
}

// The path of a scratch file with this text.
inline std::string written(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

}  // namespace tetproof
