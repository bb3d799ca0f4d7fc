// Compressed data: DEFLATE (RFC 1951), alone as in archives of zip, or wrapped by gzip (RFC 1952)
// or zlib (RFC 1950). zlib unpacks them (inflate.cpp); a build without it rejects them
// (without_zlib.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesher/base/polling.h"

namespace delmesher::io {

enum class Wrapping : std::uint8_t { none, zlib, gzip };

// What the compressed bytes unpack to; of gzip all members, one after the other. All of the bytes
// have to belong to it. Throws ParseError, with the place in `bytes`, if they are damaged, and
// without a place if there would be more than `limit` bytes, or if this build has no zlib.
std::string unpacked(std::string_view bytes, Wrapping wrapping, std::uint64_t limit,
                     Polling& polling);

inline bool is_gzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

// CRC-32 as gzip and zip have it. Throws ParseError if this build has no zlib.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace delmesher::io
