#include "mesher/io/inflate.h"

#include <algorithm>
#include <array>
#include <span>

#include "mesher/io/binary.h"
#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

constexpr std::size_t kLongestCode = 15;

// The bits of a text, those of small value first.
class Bits {
 public:
  Bits(std::string_view bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  // The next `count` bits, at most 32.
  std::uint32_t take(unsigned count) {
    const std::uint32_t value = peek(count);
    drop(count);
    return value;
  }
  // The same, without taking them; beyond the end they are zeros.
  std::uint32_t peek(unsigned count) {
    while (count_ < count) {
      const bool there = at_ < bytes_.size();
      held_ |= std::uint64_t{there ? static_cast<unsigned char>(bytes_[at_]) : 0U} << count_;
      ++at_;
      count_ += 8;
    }
    return static_cast<std::uint32_t>(held_ & ((std::uint64_t{1} << count) - 1));
  }
  void drop(unsigned count) {
    held_ >>= count;
    count_ -= count;
    if (next() > bytes_.size()) fail(at_byte(bytes_.size()), "the compressed data end early");
  }
  void drop_rest_of_byte() { drop(count_ % 8); }
  // The first byte of which no bit has been taken.
  std::size_t next() const { return at_ - count_ / 8; }
  // On a border of bytes: so many of them.
  std::string_view take_bytes(std::size_t count) {
    const std::size_t begin = next();
    if (bytes_.size() - begin < count) {
      fail(at_byte(bytes_.size()), "the compressed data end early");
    }
    at_ = begin + count;
    held_ = count_ = 0;
    return bytes_.substr(begin, count);
  }

 private:
  std::string_view bytes_;
  std::size_t at_;  // the first byte that is not held; also counts those beyond the end
  std::uint64_t held_ = 0;
  unsigned count_ = 0;  // of the bits that are held
};

// A code of Huffman's. Symbols with codes of the same length have consecutive codes in their order.
class Code {
 public:
  // The lengths of the symbols' codes, 0 for those without one. False if there are more codes than
  // fit, or fewer: that is allowed for a single one of length 1, and for none, which `may_be_short`
  // says.
  bool set(std::span<const std::uint8_t> lengths, bool may_be_short) {
    counts_.fill(0);
    for (const std::uint8_t length : lengths) ++counts_[length];
    const std::size_t unused = counts_[0];
    counts_[0] = 0;
    std::int32_t left = 1;
    std::array<std::uint16_t, kLongestCode + 2> begin{};  // of each length, in symbols_
    for (std::size_t length = 1; length <= kLongestCode; ++length) {
      left = 2 * left - counts_[length];
      if (left < 0) return false;
      begin[length + 1] = static_cast<std::uint16_t>(begin[length] + counts_[length]);
    }
    const std::size_t used = lengths.size() - unused;
    const bool is_short = used == 0 || (used == 1 && counts_[1] == 1);
    if (left > 0 && !(may_be_short && is_short)) return false;
    for (std::uint16_t symbol = 0; symbol < lengths.size(); ++symbol) {
      if (lengths[symbol] > 0) symbols_[begin[lengths[symbol]]++] = symbol;
    }
    fill_table();
    return true;
  }

  std::uint32_t decode(Bits& bits) const {
    const Entry entry = table_[bits.peek(kTableBits)];
    if (entry.length > 0) {
      bits.drop(entry.length);
      return entry.symbol;
    }
    return decode_long(bits);
  }

 private:
  static constexpr unsigned kTableBits = 10;
  struct Entry {
    std::uint16_t symbol;
    std::uint8_t length;  // 0: longer than the table's, or none
  };

  // Of the codes that are short enough, whatever bits follow. The first bit of a code is its
  // highest, and the lowest of an index.
  void fill_table() {
    table_.fill({0, 0});
    std::uint32_t code = 0;
    std::size_t next = 0;
    for (unsigned length = 1; length <= kTableBits; ++length) {
      for (std::uint32_t k = 0; k < counts_[length]; ++k, ++code, ++next) {
        std::uint32_t index = 0;
        for (unsigned bit = 0; bit < length; ++bit) {
          index |= (code >> bit & 1U) << (length - 1 - bit);
        }
        for (; index < table_.size(); index += 1U << length) {
          table_[index] = {symbols_[next], static_cast<std::uint8_t>(length)};
        }
      }
      code <<= 1U;
    }
  }

  // Bit by bit: of each length the codes are those from `first` on.
  std::uint32_t decode_long(Bits& bits) const {
    const std::uint32_t ahead = bits.peek(kLongestCode);
    std::uint32_t code = 0, first = 0, index = 0;
    for (unsigned length = 1; length <= kLongestCode; ++length) {
      code |= ahead >> (length - 1) & 1U;
      const std::uint32_t count = counts_[length];
      if (code - first < count) {
        bits.drop(length);
        return symbols_[index + code - first];
      }
      index += count;
      first = (first + count) << 1U;
      code <<= 1U;
    }
    bits.drop(kLongestCode);  // says so if they are not there
    fail(at_byte(bits.next()), "damaged compressed data: no such code");
  }

  std::array<std::uint16_t, kLongestCode + 1> counts_{};  // of codes of each length
  std::array<std::uint16_t, 288> symbols_{};              // in the order of their codes
  std::array<Entry, std::size_t{1} << kTableBits> table_{};
};

constexpr std::size_t kLiterals = 288, kDistances = 30, kLengths = 19;
constexpr std::uint32_t kEndOfBlock = 256;

struct Extra {
  std::uint16_t base;
  std::uint8_t bits;
};
constexpr std::array<Extra, 29> kCopyLengths = {
    {{3, 0},  {4, 0},  {5, 0},  {6, 0},   {7, 0},   {8, 0},   {9, 0},   {10, 0},  {11, 1}, {13, 1},
     {15, 1}, {17, 1}, {19, 2}, {23, 2},  {27, 2},  {31, 2},  {35, 3},  {43, 3},  {51, 3}, {59, 3},
     {67, 4}, {83, 4}, {99, 4}, {115, 4}, {131, 5}, {163, 5}, {195, 5}, {227, 5}, {258, 0}}};
constexpr std::array<Extra, kDistances> kCopyDistances = {
    {{1, 0},     {2, 0},     {3, 0},     {4, 0},      {5, 1},      {7, 1},
     {9, 2},     {13, 2},    {17, 3},    {25, 3},     {33, 4},     {49, 4},
     {65, 5},    {97, 5},    {129, 6},   {193, 6},    {257, 7},    {385, 7},
     {513, 8},   {769, 8},   {1025, 9},  {1537, 9},   {2049, 10},  {3073, 10},
     {4097, 11}, {6145, 11}, {8193, 12}, {12289, 12}, {16385, 13}, {24577, 13}}};

class Inflater {
 public:
  Inflater(std::string_view bytes, std::size_t at, std::uint64_t limit, Polling& polling,
           std::string& out)
      : bits_(bytes, at), limit_(limit), polling_(polling), out_(out), begin_(out.size()) {}

  // Where the data end.
  std::size_t run() {
    for (bool last = false; !last;) {
      last = bits_.take(1) != 0;
      switch (bits_.take(2)) {
        case 0:
          stored();
          break;
        case 1:
          use_fixed_codes();
          block();
          break;
        case 2:
          read_codes();
          block();
          break;
        default:
          damaged("a block of unknown type");
      }
    }
    bits_.drop_rest_of_byte();
    return bits_.next();
  }

 private:
  [[noreturn]] void damaged(const char* what) const {
    fail(at_byte(bits_.next()), std::string("damaged compressed data: ") + what);
  }

  void need_room(std::size_t count) const {
    if (limit_ - out_.size() < count) {
      fail({}, "unpacks to more than " + std::to_string(limit_) + " bytes");
    }
  }

  void stored() {
    bits_.drop_rest_of_byte();
    const std::uint32_t size = bits_.take(16), inverted = bits_.take(16);
    if ((size ^ inverted) != 0xffffU) damaged("a block of unclear size");
    need_room(size);
    polling_.poll(size);
    out_.append(bits_.take_bytes(size));
  }

  void use_fixed_codes() {
    std::array<std::uint8_t, kLiterals> lengths;
    std::fill(lengths.begin(), lengths.begin() + 144, 8);
    std::fill(lengths.begin() + 144, lengths.begin() + 256, 9);
    std::fill(lengths.begin() + 256, lengths.begin() + 280, 7);
    std::fill(lengths.begin() + 280, lengths.end(), 8);
    literals_.set(lengths, false);
    std::array<std::uint8_t, 32> distances;
    distances.fill(5);
    distances_.set(distances, false);
  }

  // The lengths of the codes are written in a code themselves.
  void read_codes() {
    constexpr std::array<std::uint8_t, kLengths> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                           11, 4,  12, 3, 13, 2, 14, 1, 15};
    const std::size_t literals = bits_.take(5) + 257, distances = bits_.take(5) + 1;
    const std::size_t of_lengths = bits_.take(4) + 4;
    if (literals > 286 || distances > kDistances) damaged("too many codes");
    std::array<std::uint8_t, kLengths> short_lengths{};
    for (std::size_t i = 0; i < of_lengths; ++i) {
      short_lengths[kOrder[i]] = static_cast<std::uint8_t>(bits_.take(3));
    }
    if (!literals_.set(short_lengths, false)) damaged("a code that is none");
    std::array<std::uint8_t, kLiterals + 32> lengths{};
    for (std::size_t i = 0; i < literals + distances;) {
      const std::uint32_t symbol = literals_.decode(bits_);
      std::uint32_t repeated = 1;
      std::uint8_t length = static_cast<std::uint8_t>(symbol);
      if (symbol == 16) {
        if (i == 0) damaged("no length to repeat");
        length = lengths[i - 1];
        repeated = 3 + bits_.take(2);
      } else if (symbol > 16) {
        length = 0;
        repeated = symbol == 17 ? 3 + bits_.take(3) : 11 + bits_.take(7);
      }
      if (repeated > literals + distances - i) damaged("too many lengths");
      for (; repeated > 0; --repeated) lengths[i++] = length;
    }
    if (lengths[kEndOfBlock] == 0) damaged("a block without an end");
    const std::span all(lengths);
    if (!literals_.set(all.first(literals), true) ||
        !distances_.set(all.subspan(literals, distances), true)) {
      damaged("a code that is none");
    }
  }

  void block() {
    for (;;) {
      polling_.poll();
      const std::uint32_t symbol = literals_.decode(bits_);
      if (symbol < kEndOfBlock) {
        need_room(1);
        out_.push_back(static_cast<char>(symbol));
      } else if (symbol == kEndOfBlock) {
        return;
      } else {
        copy(symbol - kEndOfBlock - 1);
      }
    }
  }

  // Repeats bytes that were written before, and, if they are fewer, what this writes itself.
  void copy(std::uint32_t length_symbol) {
    if (length_symbol >= kCopyLengths.size()) damaged("no such length");
    const Extra of_length = kCopyLengths[length_symbol];
    const std::size_t length = of_length.base + bits_.take(of_length.bits);
    const std::uint32_t symbol = distances_.decode(bits_);
    if (symbol >= kDistances) damaged("no such distance");
    const std::size_t distance =
        kCopyDistances[symbol].base + bits_.take(kCopyDistances[symbol].bits);
    const std::size_t to = out_.size();
    if (distance > to - begin_) damaged("a copy of what is before the beginning");
    need_room(length);
    polling_.poll(length / 16);
    out_.resize(to + length);
    char* const target = out_.data() + to;
    for (std::size_t i = 0; i < length; ++i) target[i] = *(target + i - distance);
  }

  Bits bits_;
  std::uint64_t limit_;
  Polling& polling_;
  std::string& out_;
  std::size_t begin_;  // of what this has written
  Code literals_, distances_;
};

std::uint32_t adler32_of(std::string_view bytes) {
  constexpr std::uint32_t kModulus = 65521;
  constexpr std::size_t kWithoutOverflow = 5552;
  std::uint32_t a = 1, b = 0;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), kWithoutOverflow))) {
    for (const char c : bytes.substr(0, kWithoutOverflow)) {
      a += static_cast<unsigned char>(c);
      b += a;
    }
    a %= kModulus;
    b %= kModulus;
  }
  return b << 16U | a;
}

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
  return value;
}

// Takes the parts of a wrapping one after the other.
class Parts {
 public:
  explicit Parts(std::string_view bytes) : bytes_(bytes) {}

  std::size_t at = 0;

  std::string_view take(std::size_t count) {
    if (bytes_.size() - at < count) fail(at_byte(bytes_.size()), "the compressed data end early");
    at += count;
    return bytes_.substr(at - count, count);
  }
  void skip_text() {  // to a byte 0
    while (take(1)[0] != '\0') {
    }
  }
  [[noreturn]] void damaged(const char* what) const { fail(at_byte(at), what); }

 private:
  std::string_view bytes_;
};

void skip_gzip_header(Parts& parts, std::string_view bytes) {
  enum : unsigned { header_crc = 2, extra = 4, name = 8, comment = 16, reserved = 0xe0 };
  const std::size_t begin = parts.at;
  const std::string_view header = parts.take(10);
  const auto flags = static_cast<unsigned char>(header[3]);
  if (!is_gzip(header) || header[2] != 8 || (flags & reserved) != 0)
    parts.damaged("an unknown kind of gzip");
  if ((flags & extra) != 0) parts.take(number_from<std::uint16_t>(parts.take(2)));
  if ((flags & name) != 0) parts.skip_text();
  if ((flags & comment) != 0) parts.skip_text();
  if ((flags & header_crc) == 0) return;
  const std::uint32_t crc = crc32_of(bytes.substr(begin, parts.at - begin));
  if (number_from<std::uint16_t>(parts.take(2)) != (crc & 0xffffU)) {
    parts.damaged("damaged compressed data: the checksum of the header differs");
  }
}

void unpack_gzip_member(Parts& parts, std::string_view bytes, std::uint64_t limit, Polling& polling,
                        std::string& out) {
  skip_gzip_header(parts, bytes);
  const std::size_t begin = out.size();
  parts.at = Inflater(bytes, parts.at, limit, polling, out).run();
  const std::string_view member = std::string_view(out).substr(begin);
  const bool same_sum = number_from<std::uint32_t>(parts.take(4)) == crc32_of(member);
  const bool same_size =
      number_from<std::uint32_t>(parts.take(4)) == static_cast<std::uint32_t>(member.size());
  if (!same_sum || !same_size) parts.damaged("damaged compressed data: the checksum differs");
}

void unpack_zlib(Parts& parts, std::string_view bytes, std::uint64_t limit, Polling& polling,
                 std::string& out) {
  const std::string_view header = parts.take(2);
  const unsigned first = static_cast<unsigned char>(header[0]);
  const unsigned second = static_cast<unsigned char>(header[1]);
  constexpr unsigned kMethod = 8, kDictionary = 0x20;
  if ((first & 15U) != kMethod || first >> 4U > 7 || (256 * first + second) % 31 != 0 ||
      (second & kDictionary) != 0) {
    parts.damaged("no data compressed with zlib");
  }
  parts.at = Inflater(bytes, parts.at, limit, polling, out).run();
  if (big_endian(parts.take(4)) != adler32_of(out)) {
    parts.damaged("damaged compressed data: the checksum differs");
  }
}

}  // namespace

bool is_gzip(std::string_view bytes) {
  return bytes.starts_with("\x1f\x8b");
}

std::uint32_t crc32_of(std::string_view bytes) {
  static constexpr std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
      table[i] = i;
      for (int bit = 0; bit < 8; ++bit) {
        table[i] = table[i] >> 1U ^ ((table[i] & 1U) != 0 ? 0xedb88320U : 0U);
      }
    }
    return table;
  }();
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes) crc = kTable[(crc ^ static_cast<unsigned char>(c)) & 255U] ^ crc >> 8U;
  return ~crc;
}

std::string unpacked(std::string_view bytes, Wrapping wrapping, std::uint64_t limit,
                     Polling& polling) {
  std::string out;
  Parts parts(bytes);
  switch (wrapping) {
    case Wrapping::none:
      parts.at = Inflater(bytes, 0, limit, polling, out).run();
      break;
    case Wrapping::zlib:
      unpack_zlib(parts, bytes, limit, polling, out);
      break;
    case Wrapping::gzip:
      do unpack_gzip_member(parts, bytes, limit, polling, out);
      while (is_gzip(bytes.substr(parts.at)));
      break;
  }
  if (parts.at < bytes.size()) {
    parts.damaged("the compressed data are followed by something else");
  }
  return out;
}

}  // namespace delmesher::io
