// Exact vectors in few large blocks. As numbers of their own, each of the three takes a block of
// memory, in which the administration is larger than the number.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cstdint>
#include <vector>

#include "oracles/base/exact_number.h"

namespace tetproof::oracles {

class VectorStore {
 public:
  std::size_t size() const { return places_.size(); }
  void push_back(const std::array<mpz_class, 3>& numerators, ExactNumber::Denominator denominator);
  std::array<ExactNumber, 3> operator[](std::size_t n) const;
  // In memory that is there already.
  void numerators(std::size_t n, std::array<mpz_class, 3>& x) const;

 private:
  struct Place {
    ExactNumber::Denominator denominator;  // of all three
    std::uint32_t block, first;            // of their digits
    std::array<std::int32_t, 3> sizes;     // in digits; negative: of a negative number
  };
  // Has capacity for as many digits as were ever put into it: they do not move.
  using Block = std::vector<mp_limb_t>;

  std::vector<Place> places_;
  std::vector<Block> blocks_;
};

}  // namespace tetproof::oracles
