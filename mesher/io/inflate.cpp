#include "mesher/io/inflate.h"

#define ZLIB_CONST  // what is unpacked is not written to
#include <zlib.h>

#include <algorithm>
#include <array>
#include <new>

#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

// Unpacks this much at a time, from this many bytes at most, so that a caller can cancel often.
constexpr std::size_t kPiece = std::size_t{1} << 16;

int window_bits(Wrapping wrapping) {
  if (wrapping == Wrapping::none) return -MAX_WBITS;
  return wrapping == Wrapping::zlib ? MAX_WBITS : MAX_WBITS + 16;
}

// zlib's state between pieces.
class Inflater {
 public:
  Inflater(std::string_view bytes, Wrapping wrapping) : bytes_(bytes) {
    if (inflateInit2(&stream_, window_bits(wrapping)) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  // The next bytes, of which there may be none before the end.
  std::string_view next() {
    const std::size_t given = std::min(bytes_.size() - at_, kPiece);
    stream_.next_in = reinterpret_cast<const Bytef*>(bytes_.data() + at_);
    stream_.avail_in = static_cast<uInt>(given);
    stream_.next_out = reinterpret_cast<Bytef*>(piece_.data());
    stream_.avail_out = static_cast<uInt>(kPiece);
    const int code = inflate(&stream_, Z_NO_FLUSH);
    at_ += given - stream_.avail_in;
    at_end_ = code == Z_STREAM_END;
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    if (code == Z_BUF_ERROR) fail(at_byte(at_), "the compressed data end early");
    if (code != Z_OK && !at_end_) damaged();
    return {piece_.data(), kPiece - stream_.avail_out};
  }
  bool at_end() const { return at_end_; }
  // The place of the first unused byte.
  std::size_t at() const { return at_; }
  // Begins with other data, from there on.
  void begin_anew() { inflateReset(&stream_); }

 private:
  [[noreturn]] void damaged() const {
    const char* reason = stream_.msg != nullptr ? stream_.msg : "a dictionary is needed";
    fail(at_byte(at_), std::string("damaged compressed data: ") + reason);
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool at_end_ = false;
  z_stream stream_{};
  std::array<char, kPiece> piece_;
};

// To the end of the data, of gzip to that of a member.
void unpack(Inflater& inflater, std::uint64_t limit, Polling& polling, std::string& out) {
  do {
    const std::size_t before = inflater.at();
    const std::string_view piece = inflater.next();
    polling.poll(1 + (inflater.at() - before) + piece.size());
    if (limit - out.size() < piece.size()) {
      fail({}, "unpacks to more than " + std::to_string(limit) + " bytes");
    }
    out.append(piece);
  } while (!inflater.at_end());
}

}  // namespace

std::string unpacked(std::string_view bytes, Wrapping wrapping, std::uint64_t limit,
                     Polling& polling) {
  std::string out;
  Inflater inflater(bytes, wrapping);
  unpack(inflater, limit, polling, out);
  while (wrapping == Wrapping::gzip && is_gzip(bytes.substr(inflater.at()))) {
    inflater.begin_anew();
    unpack(inflater, limit, polling, out);
  }
  if (inflater.at() < bytes.size()) {
    fail(at_byte(inflater.at()), "the compressed data are followed by something else");
  }
  return out;
}

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace delmesher::io
