// A lean hash map from 64-bit keys to 32-bit values: open addressing, no iteration, so that nothing
// can depend on its order.
#pragma once

#include <cstdint>
#include <vector>

namespace delmesher {

class KeyTable {
 public:
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  static constexpr std::uint32_t kAbsent = 0xffffffffU;

  explicit KeyTable(std::size_t expected = 0) { allocate(expected); }

  void clear(std::size_t expected = 0) {
    size_ = 0;
    allocate(expected);
  }

  // Inserts or overwrites.
  void set(std::uint64_t key, std::uint32_t value) {
    if (4 * (size_ + 1) > 3 * keys_.size()) grow();
    const std::size_t slot = find_slot(key);
    if (keys_[slot] == kEmpty) {
      keys_[slot] = key;
      ++size_;
    }
    values_[slot] = value;
  }

  // kAbsent if there is no such key.
  std::uint32_t get(std::uint64_t key) const {
    const std::size_t slot = find_slot(key);
    return keys_[slot] == kEmpty ? kAbsent : values_[slot];
  }

 private:
  void allocate(std::size_t expected) {
    std::size_t n = 16;
    while (3 * n < 4 * (expected + 1)) n *= 2;
    keys_.assign(n, kEmpty);
    values_.assign(n, kAbsent);
  }
  std::size_t find_slot(std::uint64_t key) const {
    std::uint64_t h = key * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 32;
    const std::size_t mask = keys_.size() - 1;
    std::size_t slot = h & mask;
    while (keys_[slot] != kEmpty && keys_[slot] != key) slot = (slot + 1) & mask;
    return slot;
  }
  void grow() {
    std::vector<std::uint64_t> keys;
    std::vector<std::uint32_t> values;
    keys.swap(keys_);
    values.swap(values_);
    keys_.assign(2 * keys.size(), kEmpty);
    values_.assign(2 * keys.size(), kAbsent);
    for (std::size_t n = 0; n < keys.size(); ++n) {
      if (keys[n] == kEmpty) continue;
      const std::size_t slot = find_slot(keys[n]);
      keys_[slot] = keys[n];
      values_[slot] = values[n];
    }
  }

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
  std::size_t size_ = 0;
};

// Key of the undirected pair ab.
inline std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? (std::uint64_t{a} << 32) | b : (std::uint64_t{b} << 32) | a;
}

}  // namespace delmesher
