// In place of inflate.cpp where there is no zlib: what is compressed is rejected.
#include <array>

#include "mesher/io/inflate.h"
#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  fail({}, what + ": this build of delmesher has no zlib");
}

}  // namespace

std::string unpacked(std::string_view /*bytes*/, Wrapping wrapping, std::uint64_t /*limit*/,
                     Polling& /*polling*/) {
  static constexpr std::array<const char*, 3> kNames = {"DEFLATE", "zlib", "gzip"};
  refuse(std::string("compressed by ") + kNames[static_cast<std::size_t>(wrapping)]);
}

std::uint32_t crc32_of(std::string_view /*bytes*/) {
  refuse("checked by CRC-32");
}

}  // namespace delmesher::io
