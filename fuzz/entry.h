// What the fuzz targets have in common: from bytes to one property, and how a finding is told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "mesher/delmesher.h"

namespace tetproof::fuzz {

// Empty if the property holds, else "oracle: what is wrong", in one line. The part before the colon
// names the kind of failure: findings with the same name and place are one finding.
using Finding = std::string;

// Surfaces with more triangles teach nothing new but take longer.
inline constexpr std::size_t kLargestSurface = 160;

// The bytes as an OFF file; null if they are none or if it is too large.
std::optional<delmesher::Surface> parse(const std::uint8_t* data, std::size_t size);

// Prints the finding (and the surface, exactly, with the command that replays it) and aborts.
void report(const Finding& finding, const delmesher::Surface* surface = nullptr);

// Runs a property on the surface that the bytes are, if it is certified valid.
int on_valid_surface(const std::uint8_t* data, std::size_t size,
                     Finding (*property)(const delmesher::Surface&));
// The same on any surface, valid or not.
int on_any_surface(const std::uint8_t* data, std::size_t size,
                   Finding (*property)(const delmesher::Surface&));

class Bytes;
// Runs a property on the bytes, or on them as text.
int on_bytes(const std::uint8_t* data, std::size_t size, Finding (*property)(Bytes));
int on_text(const std::uint8_t* data, std::size_t size, Finding (*property)(const std::string&));

// Numbers out of bytes; zeros when there are none left.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return at_ >= size_; }
  std::size_t left() const { return size_ - at_; }
  std::uint8_t byte() { return empty() ? std::uint8_t{0} : data_[at_++]; }
  // In [0, n); n at most 256.
  std::uint32_t below(std::uint32_t n) { return n == 0 ? 0 : byte() % n; }
  std::uint64_t word() {
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value = value << 8 | byte();
    return value;
  }
  // One byte says of which kind: a small integer, a simple fraction, a neighbour of the last one,
  // the last one again, any finite double.
  double coordinate();
  // Coordinates keep their exponents below this from here on: exact arithmetic takes its time where
  // they differ by hundreds of binary digits, and meshes have as many sizes as there are between.
  void narrow(int most_exponent = 32) { most_exponent_ = most_exponent; }
  // Neighbours of the last one are 2^-8 to 2^-39 of it away from here on, no longer an ulp: what is
  // near without being next to each other in doubles has room for a mesh.
  void spread() { spread_ = true; }
  // In [0, 1], often simple.
  double parameter();

 private:
  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
  double last_ = 1;
  int most_exponent_ = 0;  // 0: any
  bool spread_ = false;
};

}  // namespace tetproof::fuzz
