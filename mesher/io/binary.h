// Numbers as bytes, the least significant first, and bytes as text in base 64 (RFC 4648).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "mesher/io/output.h"

namespace delmesher::io {

template <class T>
std::array<char, sizeof(T)> bytes_of(T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// The number at the beginning of the bytes, of which there are enough.
template <class T>
T number_from(std::string_view bytes) {
  std::array<char, sizeof(T)> own;
  std::memcpy(own.data(), bytes.data(), sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(own.begin(), own.end());
  return std::bit_cast<T>(own);
}

// Writes bytes in base 64; the last ones with finish().
class Base64Writer {
 public:
  explicit Base64Writer(TextSink& out) : out_(out) {}

  template <class T>
  void add(T number) {
    for (const char byte : bytes_of(number)) add_byte(byte);
  }
  void finish();

 private:
  void add_byte(char byte) {
    group_ = group_ << 8U | static_cast<unsigned char>(byte);
    if (++bytes_ == 3) write_group();
  }
  // With padding in place of missing bytes.
  void write_group();

  TextSink& out_;
  std::uint32_t group_ = 0;  // the bytes since the last whole group of three
  int bytes_ = 0;
};

// The bytes that a text in base 64 means, white space before and after it left out; nullopt if it
// is none. `several`: it may be several texts, each with its padding, one after the other.
std::optional<std::string> from_base64(std::string_view text, bool several = false);

}  // namespace delmesher::io
