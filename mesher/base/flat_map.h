// A hash table from 64-bit keys to 32-bit values, in one array: looked up only, never iterated, so
// that nothing depends on the order of its entries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

// Key of the undirected pair ab.
inline std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t{a} << 32U) | b : (std::uint64_t{b} << 32U) | a;
}

class FlatMap {
 public:
  // The value of a key, or `missing`.
  std::uint32_t get(std::uint64_t key, std::uint32_t missing) const {
    if (slots_.empty()) return missing;
    for (std::size_t i = home(key);; i = next(i)) {
      if (slots_[i].key == key) return slots_[i].value;
      if (slots_[i].key == kFree) return missing;
    }
  }

  // The key must not be ~0.
  void set(std::uint64_t key, std::uint32_t value) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    std::size_t i = home(key);
    while (slots_[i].key != key && slots_[i].key != kFree) i = next(i);
    size_ += slots_[i].key == kFree ? 1 : 0;
    slots_[i] = {key, value};
  }

  void erase(std::uint64_t key) {
    if (slots_.empty()) return;
    std::size_t hole = home(key);
    while (slots_[hole].key != key) {
      if (slots_[hole].key == kFree) return;
      hole = next(hole);
    }
    // Entries that would not be found any more across the hole move into it.
    for (std::size_t i = next(hole); slots_[i].key != kFree; i = next(i)) {
      const std::size_t wanted = home(slots_[i].key);
      if (((i - wanted) & (slots_.size() - 1)) < ((i - hole) & (slots_.size() - 1))) continue;
      slots_[hole] = slots_[i];
      hole = i;
    }
    slots_[hole].key = kFree;
    --size_;
  }

  std::size_t size() const { return size_; }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kFree;
    std::uint32_t value = 0;
  };

  // Fibonacci hashing (Knuth): the high bits of the product depend on all bits of the key.
  std::size_t home(std::uint64_t key) const {
    return static_cast<std::size_t>((key * 0x9e3779b97f4a7c15U) >> shift_);
  }
  std::size_t next(std::size_t i) const { return (i + 1) & (slots_.size() - 1); }

  void grow() {
    std::vector<Slot> old(slots_.empty() ? 64 : 2 * slots_.size());
    old.swap(slots_);
    shift_ = 64;
    for (std::size_t n = slots_.size(); n > 1; n /= 2) --shift_;
    size_ = 0;
    for (const Slot& slot : old) {
      if (slot.key != kFree) set(slot.key, slot.value);
    }
  }

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
  int shift_ = 64;
};

}  // namespace delmesher::base
