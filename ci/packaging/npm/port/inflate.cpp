// In place of zlib (mesher/io/inflate.cpp): unpacks RFC 1950, 1951 and 1952.
#include "mesher/io/inflate.h"

#include <array>
#include <vector>

#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

constexpr std::size_t kLongest = 15;  // bits of a code

// A prefix code: codes of one length are consecutive numbers.
class Code {
 public:
  explicit Code(const std::vector<std::uint8_t>& lengths) {
    for (const std::uint8_t length : lengths) ++count_[length];
    count_[0] = 0;
    std::array<std::size_t, kLongest + 2> begin = {};
    for (std::size_t n = 1; n <= kLongest; ++n) begin[n + 1] = begin[n] + count_[n];
    symbols_.resize(begin[kLongest + 1]);
    for (std::size_t s = 0; s < lengths.size(); ++s) {
      if (lengths[s] > 0) symbols_[begin[lengths[s]]++] = static_cast<std::uint16_t>(s);
    }
  }
  // True if no two codes are the same.
  bool is_possible() const {
    std::int32_t left = 1;
    for (std::size_t n = 1; n <= kLongest && left >= 0; ++n) left = 2 * left - count_[n];
    return left >= 0;
  }
  template <class NextBit>
  int next(const NextBit& next_bit) const {
    std::int32_t code = 0, first = 0, index = 0;
    for (std::size_t n = 1; n <= kLongest; ++n) {
      code |= next_bit();
      if (code - first < count_[n]) return symbols_[static_cast<std::size_t>(index + code - first)];
      index += count_[n];
      first = (first + count_[n]) * 2;
      code *= 2;
    }
    return -1;
  }

 private:
  std::array<std::int32_t, kLongest + 1> count_ = {};
  std::vector<std::uint16_t> symbols_;
};

class Inflater {
 public:
  Inflater(std::string_view bytes, std::uint64_t limit, Polling& polling)
      : bytes_(bytes), limit_(limit), polling_(polling) {}

  std::string out;

  void member(Wrapping wrapping) {
    begin_ = out.size();
    if (wrapping == Wrapping::gzip) skip_gzip_header();
    if (wrapping == Wrapping::zlib) skip_zlib_header();
    while (!block()) {
    }
    held_ = hold_ = 0;  // up to the next byte
    const std::string_view made = std::string_view(out).substr(begin_);
    if (wrapping == Wrapping::gzip) {
      if (whole(4) != crc32_of(made)) damaged("incorrect data check");
      if (whole(4) != static_cast<std::uint32_t>(made.size())) damaged("incorrect length check");
    } else if (wrapping == Wrapping::zlib) {
      std::uint32_t a = 1, b = 0;
      for (const char c : made) {
        a = (a + static_cast<std::uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
      }
      std::uint32_t sum = 0;
      for (int n = 0; n < 4; ++n) sum = sum << 8U | byte();
      if (sum != (b << 16U | a)) damaged("incorrect data check");
    }
  }
  std::size_t at() const { return at_; }

 private:
  [[noreturn]] void damaged(const char* reason) const {
    fail(at_byte(at_), std::string("damaged compressed data: ") + reason);
  }
  std::uint32_t byte() {
    if (at_ == bytes_.size()) fail(at_byte(at_), "the compressed data end early");
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }
  std::uint32_t whole(unsigned bytes) {
    std::uint32_t value = 0;
    for (unsigned n = 0; n < bytes; ++n) value |= byte() << (8 * n);
    return value;
  }
  std::uint32_t bits(unsigned count) {
    for (; held_ < count; held_ += 8) hold_ |= byte() << held_;
    const std::uint32_t value = hold_ & ((1U << count) - 1);
    hold_ >>= count;
    held_ -= count;
    if (held_ == 0) hold_ = 0;
    return value;
  }
  std::uint32_t symbol(const Code& code, const char* reason) {
    const int found = code.next([this] { return static_cast<std::int32_t>(bits(1)); });
    if (found < 0) damaged(reason);
    return static_cast<std::uint32_t>(found);
  }
  void put(char c) {
    if (out.size() == limit_) fail({}, "unpacks to more than " + std::to_string(limit_) + " bytes");
    out.push_back(c);
    polling_.poll();
  }

  void skip_zlib_header() {
    const std::uint32_t method = byte(), flags = byte();
    if ((method * 256 + flags) % 31 != 0) damaged("incorrect header check");
    if ((method & 15U) != 8) damaged("unknown compression method");
    if ((flags & 32U) != 0) damaged("a dictionary is needed");
  }
  void skip_gzip_header() {
    if (whole(2) != 0x8b1f) damaged("incorrect header check");
    if (byte() != 8) damaged("unknown compression method");
    const std::uint32_t flags = byte();
    if ((flags & 0xe0U) != 0) damaged("unknown header flags set");
    for (int n = 0; n < 6; ++n) byte();
    if ((flags & 4U) != 0) {
      for (std::uint32_t n = whole(2); n > 0; --n) byte();
    }
    for (const std::uint32_t name : {8U, 16U}) {
      while ((flags & name) != 0 && byte() != 0) {
      }
    }
    if ((flags & 2U) != 0) whole(2);
  }

  // True if it was the last.
  bool block() {
    const bool last = bits(1) != 0;
    const std::uint32_t kind = bits(2);
    if (kind == 3) damaged("invalid block type");
    if (kind == 0) {
      held_ = hold_ = 0;
      const std::uint32_t size = whole(2);
      if ((whole(2) ^ 0xffffU) != size) damaged("invalid stored block lengths");
      for (std::uint32_t n = 0; n < size; ++n) put(static_cast<char>(byte()));
    } else if (kind == 1) {
      std::vector<std::uint8_t> lengths(288, 8);
      for (std::size_t s = 144; s < 256; ++s) lengths[s] = 9;
      for (std::size_t s = 256; s < 280; ++s) lengths[s] = 7;
      codes(Code(lengths), Code(std::vector<std::uint8_t>(30, 5)));
    } else {
      described();
    }
    return last;
  }

  void described() {
    static constexpr std::array<std::uint8_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                            11, 4,  12, 3, 13, 2, 14, 1, 15};
    const std::size_t literals = bits(5) + 257, distances = bits(5) + 1, described = bits(4) + 4;
    if (literals > 286 || distances > 30) damaged("too many length or distance symbols");
    std::vector<std::uint8_t> lengths(19);
    for (std::size_t n = 0; n < described; ++n)
      lengths[kOrder[n]] = static_cast<std::uint8_t>(bits(3));
    const Code code(lengths);
    if (!code.is_possible()) damaged("invalid code lengths set");
    std::vector<std::uint8_t> all;
    while (all.size() < literals + distances) {
      const std::uint32_t length = symbol(code, "invalid code lengths set");
      if (length < 16) {
        all.push_back(static_cast<std::uint8_t>(length));
        continue;
      }
      if (length == 16 && all.empty()) damaged("invalid bit length repeat");
      const std::uint8_t again = length == 16 ? all.back() : std::uint8_t{0};
      const std::size_t times = length == 16   ? 3 + bits(2)
                                : length == 17 ? 3 + bits(3)
                                               : 11 + bits(7);
      if (all.size() + times > literals + distances) damaged("invalid bit length repeat");
      all.insert(all.end(), times, again);
    }
    if (all[256] == 0) damaged("invalid code -- missing end-of-block");
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(literals);
    const Code literal(std::vector<std::uint8_t>(all.begin(), middle));
    const Code distance(std::vector<std::uint8_t>(middle, all.end()));
    if (!literal.is_possible()) damaged("invalid literal/lengths set");
    if (!distance.is_possible()) damaged("invalid distances set");
    codes(literal, distance);
  }

  void codes(const Code& literal, const Code& distance) {
    for (;;) {
      const std::uint32_t s = symbol(literal, "invalid literal/length code");
      if (s == 256) return;
      if (s < 256) {
        put(static_cast<char>(s));
        continue;
      }
      if (s > 285) damaged("invalid literal/length code");
      // Four lengths, or two distances, have one more bit each time.
      const std::uint32_t l = s - 257, wide = l < 8 || s == 285 ? 0 : l / 4 - 1;
      const std::uint32_t size = s == 285 ? 258
                                 : l < 8  ? l + 3
                                          : ((4 + l % 4) << wide) + 3 + bits(wide);
      const std::uint32_t d = symbol(distance, "invalid distance code");
      if (d > 29) damaged("invalid distance code");
      const std::uint32_t far = d < 4 ? 0 : d / 2 - 1;
      const std::size_t back = d < 4 ? d + 1 : ((2 + d % 2) << far) + 1 + bits(far);
      if (back > out.size() - begin_) damaged("invalid distance too far back");
      for (std::uint32_t n = 0; n < size; ++n) put(out[out.size() - back]);
    }
  }

  std::string_view bytes_;
  std::uint64_t limit_;
  Polling& polling_;
  std::size_t at_ = 0, begin_ = 0;
  std::uint32_t hold_ = 0, held_ = 0;  // bits that were read and not used
};

}  // namespace

std::string unpacked(std::string_view bytes, Wrapping wrapping, std::uint64_t limit,
                     Polling& polling) {
  Inflater inflater(bytes, limit, polling);
  do {
    inflater.member(wrapping);
  } while (wrapping == Wrapping::gzip && is_gzip(bytes.substr(inflater.at())));
  if (inflater.at() < bytes.size()) {
    fail(at_byte(inflater.at()), "the compressed data are followed by something else");
  }
  return std::move(inflater.out);
}

std::uint32_t crc32_of(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table;
    for (std::uint32_t n = 0; n < 256; ++n) {
      table[n] = n;
      for (int k = 0; k < 8; ++k)
        table[n] = (table[n] & 1U) != 0 ? 0xedb88320U ^ table[n] >> 1U : table[n] >> 1U;
    }
    return table;
  }();
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<std::uint8_t>(c)) & 255U] ^ crc >> 8U;
  return ~crc;
}

}  // namespace delmesher::io
