// What zlib makes of data, for tests.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <optional>
#include <string>

#include "mesher/io/inflate.h"

namespace delmesher::io {

inline int window_bits(Wrapping wrapping) {
  switch (wrapping) {
    case Wrapping::none:
      return -MAX_WBITS;
    case Wrapping::zlib:
      return MAX_WBITS;
    case Wrapping::gzip:
      break;
  }
  return MAX_WBITS + 16;
}

inline void set_input(z_stream& stream, std::string& in) {
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
}

inline void set_output(z_stream& stream, std::string& out) {
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
}

// Empty if zlib does not do it.
inline std::string packed_by_zlib(std::string text, Wrapping wrapping, int level = 6,
                                  int strategy = Z_DEFAULT_STRATEGY, gz_header* header = nullptr) {
  z_stream stream{};
  if (deflateInit2(&stream, level, Z_DEFLATED, window_bits(wrapping), 8, strategy) != Z_OK)
    return {};
  if (header != nullptr) deflateSetHeader(&stream, header);
  std::string out(deflateBound(&stream, text.size()) + 1000, '\0');
  set_input(stream, text);
  set_output(stream, out);
  out.resize(deflate(&stream, Z_FINISH) == Z_STREAM_END ? stream.total_out : 0);
  deflateEnd(&stream);
  return out;
}

// Of gzip all members; nullopt if zlib refuses them, leaves something, or if there are more than
// `most` bytes.
inline std::optional<std::string> unpacked_by_zlib(std::string bytes, Wrapping wrapping,
                                                   std::size_t most) {
  z_stream stream{};
  if (inflateInit2(&stream, window_bits(wrapping)) != Z_OK) return {};
  std::string out(most, '\0');
  set_input(stream, bytes);
  set_output(stream, out);
  int code = inflate(&stream, Z_FINISH);
  std::size_t size = stream.total_out;
  while (code == Z_STREAM_END && stream.avail_in >= 2 && wrapping == Wrapping::gzip &&
         stream.next_in[0] == 0x1f && stream.next_in[1] == 0x8b) {
    inflateReset(&stream);
    code = inflate(&stream, Z_FINISH);
    size += stream.total_out;
  }
  const bool all = code == Z_STREAM_END && stream.avail_in == 0;
  inflateEnd(&stream);
  out.resize(size);
  return all ? std::optional(out) : std::nullopt;
}

}  // namespace delmesher::io
