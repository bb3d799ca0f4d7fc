// Boxes along the axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

#include "oracles/base/vectors.h"

namespace tetproof::oracles {

// Empty until something is added.
struct Box {
  Position low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void add(const Position& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  void add(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], box.low[axis]);
      high[axis] = std::max(high[axis], box.high[axis]);
    }
  }
  // Infinite for an empty box.
  double diagonal() const { return distance(high, low); }
  // The largest absolute coordinate; infinite for an empty box.
  double largest() const { return std::max({largest(0), largest(1), largest(2)}); }
  double largest(std::size_t axis) const { return std::max(high[axis], -low[axis]); }
  bool operator==(const Box&) const = default;
};

// All comparisons are made: which of them fails first cannot be foretold, and a wrong guess takes
// longer than they do.
inline bool meet(const Box& a, const Box& b) {
  unsigned apart = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    apart |= static_cast<unsigned>(a.low[axis] > b.high[axis]) |
             static_cast<unsigned>(b.low[axis] > a.high[axis]);
  }
  return apart == 0;
}

inline Box box_of(std::span<const Position> points) {
  Box box;
  for (const Position& p : points) box.add(p);
  return box;
}

inline Box box_around(const Position& p, double reach) {
  Box box{p, p};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= reach;
    box.high[axis] += reach;
  }
  return box;
}

}  // namespace tetproof::oracles
