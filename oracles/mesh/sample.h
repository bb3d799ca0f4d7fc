// The elements that are tried by brute force against all vertices: spread evenly, the same in every
// run, and so few that the number of tests is bounded.
#pragma once

#include <algorithm>
#include <vector>

#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

class Sample {
 public:
  Sample(std::size_t elements, std::size_t vertices) {
    constexpr std::size_t kTests = std::size_t{1} << 18;
    const std::size_t wanted =
        std::max<std::size_t>(4, kTests / std::max<std::size_t>(1, vertices));
    step_ = std::max<std::size_t>(1, elements / wanted);
  }
  std::size_t first() const { return step_ / 2; }
  std::size_t step() const { return step_; }

 private:
  std::size_t step_;
};

// The vertices that belong to some tetrahedron, ascending.
std::vector<Index> used_vertices(const TetComplex& complex);

}  // namespace tetproof::oracles
