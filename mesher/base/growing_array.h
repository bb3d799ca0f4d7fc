// A vector for the largest arrays of a run: it grows in place where the system can move pages
// instead of copying them (realloc on Linux), so that growing never needs the old and the new
// memory at once, and memory that was reserved but never used is never touched.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "mesher/base/namespaces.h"

namespace delmesher::base {

template <class T>
class GrowingArray {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  GrowingArray() = default;
  GrowingArray(const GrowingArray&) = delete;
  GrowingArray& operator=(const GrowingArray&) = delete;
  GrowingArray(GrowingArray&& other) noexcept { swap(other); }
  GrowingArray& operator=(GrowingArray&& other) noexcept {
    GrowingArray taken(std::move(other));
    swap(taken);
    return *this;
  }
  ~GrowingArray() { std::free(block_); }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return data_; }
  const T* data() const { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  T* begin() { return data_; }
  T* end() { return data_ + size_; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }
  T& back() { return data_[size_ - 1]; }
  const T& back() const { return data_[size_ - 1]; }

  void push_back(const T& value) {
    const T copy = value;  // may be an element
    if (size_ == capacity_) grow(size_ + 1);
    data_[size_++] = copy;
  }
  void pop_back() { --size_; }
  void clear() { size_ = 0; }
  void resize(std::size_t n, const T& value = T()) {
    const T copy = value;
    if (n > capacity_) grow(n);
    for (std::size_t i = size_; i < n; ++i) data_[i] = copy;
    size_ = n;
  }
  void assign(std::size_t n, const T& value) {
    size_ = 0;
    resize(n, value);
  }
  void append(const T* first, const T* last) {
    const auto n = static_cast<std::size_t>(last - first);
    if (size_ + n > capacity_) grow(size_ + n);
    std::copy(first, last, data_ + size_);
    size_ += n;
  }
  void reserve(std::size_t n) {
    if (n > capacity_) reallocate(n);
  }
  void swap(GrowingArray& other) noexcept {
    std::swap(block_, other.block_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }
  // Gives the memory back.
  void release() { GrowingArray().swap(*this); }

 private:
  static constexpr std::size_t kAlignment = alignof(T) > alignof(std::max_align_t) ? alignof(T) : 1;

  void grow(std::size_t least) {
    reallocate(std::max({least, capacity_ + capacity_ / 2, std::size_t{16}}));
  }

  // Over-aligned elements begin at the first aligned address of the block; where moving the block
  // has changed their offset in it, they are shifted.
  void reallocate(std::size_t n) {
    if (n > (SIZE_MAX - kAlignment) / sizeof(T)) throw std::bad_alloc();
    const auto offset = static_cast<std::size_t>(reinterpret_cast<std::uintptr_t>(data_) -
                                                 reinterpret_cast<std::uintptr_t>(block_));
    void* const block = std::realloc(block_, n * sizeof(T) + kAlignment - 1);
    if (block == nullptr) throw std::bad_alloc();
    block_ = block;
    const auto address = reinterpret_cast<std::uintptr_t>(block);
    const std::size_t aligned = (kAlignment - address % kAlignment) % kAlignment;
    auto* const bytes = static_cast<unsigned char*>(block);
    if (aligned != offset && size_ > 0) {
      std::memmove(bytes + aligned, bytes + offset, size_ * sizeof(T));
    }
    data_ = reinterpret_cast<T*>(bytes + aligned);
    capacity_ = n;
  }

  void* block_ = nullptr;
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

}  // namespace delmesher::base
