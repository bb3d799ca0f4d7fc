// Code that the fuzz targets share: the way from bytes to one property, and the report of a
// finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "mesher/delmesher.h"

namespace tetproof::fuzz {

// Empty if the property holds, else "oracle: violation", in one line. The part before the colon
// names the kind of failure: findings with the same name and place are one finding.
using Finding = std::string;

// Surfaces with more triangles show nothing new but take longer.
inline constexpr std::size_t kLargestSurface = 160;

// The bytes read as an OFF file; nothing if they are none, or if it has no triangle or too many.
std::optional<delmesher::Surface> parse(const std::uint8_t* data, std::size_t size);

// Prints the finding (and the surface, exactly, with the command that replays it) and aborts.
void report(const Finding& finding, const delmesher::Surface* surface = nullptr);

// Runs a property on the surface that the bytes are, if it is certified valid. This function and
// the next three return 0, which libFuzzer wants, or abort with a finding.
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
  // A coordinate; one byte chooses its kind: a small integer, a simple fraction, a neighbour of the
  // last one, the last one again, any finite double.
  double coordinate();
  // From here on coordinates have exponents below this: exact arithmetic is slow where they differ
  // by hundreds of binary digits, and meshes need all sizes in between.
  void narrow(int most_exponent = 32) { most_exponent_ = most_exponent; }
  // From here on a neighbour of the last coordinate is 2^-8 to 2^-39 of it away, no longer an ulp.
  // Features that are near without being next to each other in doubles leave room for a mesh.
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
