#include "oracles/base/vector_store.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace tetproof::oracles {

void VectorStore::push_back(const std::array<mpz_class, 3>& numerators,
                            ExactNumber::Denominator denominator) {
  constexpr std::size_t kDigits = 1 << 13;  // of an ordinary block
  std::size_t digits = 0;
  for (const mpz_class& x : numerators) digits += mpz_size(x.get_mpz_t());
  if (blocks_.empty() || blocks_.back().capacity() - blocks_.back().size() < digits) {
    blocks_.emplace_back().reserve(std::max(kDigits, digits));
  }
  Block& block = blocks_.back();
  Place place{.denominator = std::move(denominator),
              .block = static_cast<std::uint32_t>(blocks_.size() - 1),
              .first = static_cast<std::uint32_t>(block.size()),
              .sizes = {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const mpz_srcptr x = numerators[axis].get_mpz_t();
    const auto size = static_cast<std::int32_t>(mpz_size(x));
    place.sizes[axis] = mpz_sgn(x) < 0 ? -size : size;
    const mp_limb_t* first = mpz_limbs_read(x);
    block.insert(block.end(), first, first + size);
  }
  places_.push_back(std::move(place));
}

void VectorStore::numerators(std::size_t n, std::array<mpz_class, 3>& x) const {
  const Place& place = places_[n];
  const mp_limb_t* digits = blocks_[place.block].data() + place.first;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mpz_t there;
    mpz_set(x[axis].get_mpz_t(), mpz_roinit_n(there, digits, place.sizes[axis]));
    digits += std::abs(place.sizes[axis]);
  }
}

std::array<ExactNumber, 3> VectorStore::operator[](std::size_t n) const {
  std::array<mpz_class, 3> x;
  numerators(n, x);
  return ExactNumber::over(std::move(x), places_[n].denominator);
}

}  // namespace tetproof::oracles
