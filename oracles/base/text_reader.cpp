#include "oracles/base/text_reader.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>

#include "oracles/base/steps.h"

namespace tetproof::oracles {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 18;
constexpr std::size_t kLongestWord = std::size_t{1} << 20;
constexpr std::string_view kGzip = ".gz";
constexpr std::uint64_t kTimesUnpacked = 64;

// Bytes that a file of that many may unpack to.
std::uint64_t most_unpacked(std::uint64_t packed) {
  constexpr std::uint64_t kAnyway = std::uint64_t{1} << 26;
  return kAnyway + kTimesUnpacked * packed;
}

// The beginning of a word, for a message of one line that a terminal can show.
std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, kLongest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + "\"";
}

// Makes one line of a text that may hold anything: at most 1000 bytes, whole characters if it is
// UTF-8.
std::string one_line(const std::string& text) {
  std::size_t size = std::min<std::size_t>(1000, text.size());
  while (size > 0 && size < text.size() && (text[size] & 0xc0) == 0x80) --size;
  std::string line = size < text.size() ? text.substr(0, size) + "..." : text;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const auto c = static_cast<unsigned char>(line[i]);
    const unsigned before = i > 0 ? static_cast<unsigned char>(line[i - 1]) : 0U;
    // A control character of the second set, alone or as a UTF-8 character.
    const bool control = c >= 0x80 && c < 0xa0 && (before < 0x80 || before == 0xc2);
    if (c < ' ' || c == 0x7f || control) line[i] = '?';
    if (control && before == 0xc2) line[i - 1] = '?';
  }
  return line;
}

// A file in pieces; what is compressed with gzip unpacked, which its first bytes tell. zlib's own
// reader of files would pass over what follows the compressed data.
class FileStream {
 public:
  explicit FileStream(const std::string& path)
      : path_(path), file_(std::fopen(path.c_str(), "rb"), std::fclose) {
    if (file_ == nullptr && errno == ENOMEM) throw std::bad_alloc();
    if (file_ == nullptr) throw ReadError(path + ": cannot be opened");
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(path, unknown);
    if (!unknown) size_ = size;
    packed_.resize(kPiece);
    inflater_.next_in = packed_.data();
    fetch();
    plain_ = !begins_member();
    if (plain_) return;
    constexpr int kGzipOnly = 16;
    if (::inflateInit2(&inflater_, MAX_WBITS + kGzipOnly) != Z_OK) throw std::bad_alloc();
  }
  ~FileStream() {
    if (!plain_) ::inflateEnd(&inflater_);
  }
  FileStream(const FileStream&) = delete;
  FileStream& operator=(const FileStream&) = delete;

  // Fills as much of the piece as there is left, and returns how much that is.
  std::size_t read(char* piece, std::size_t size) {
    inflater_.next_out = reinterpret_cast<Bytef*>(piece);
    inflater_.avail_out = static_cast<uInt>(size);
    while (inflater_.avail_out > 0 && (plain_ ? copy() : unpack())) {
    }
    const std::size_t got = size - inflater_.avail_out;
    given_ += got;
    if (!plain_ && size_) check_unpacked(path_, *size_, given_);
    return got;
  }

  bool is_plain() const { return plain_; }
  // As many bytes as there are in all, or more; not known of what is not a regular file.
  std::optional<std::uint64_t> most_bytes() const {
    if (!size_ || plain_) return size_;
    return most_unpacked(*size_);
  }

 private:
  bool begins_member() const {
    return inflater_.avail_in > 1 && inflater_.next_in[0] == 0x1f && inflater_.next_in[1] == 0x8b;
  }

  // Reads on in the file, after what is left of the last piece; false at the end.
  bool fetch() {
    std::memmove(packed_.data(), inflater_.next_in, inflater_.avail_in);
    const std::size_t left = inflater_.avail_in;
    const std::size_t got = std::fread(packed_.data() + left, 1, kPiece - left, file_.get());
    if (std::ferror(file_.get()) != 0) fail("cannot be read");
    inflater_.next_in = packed_.data();
    inflater_.avail_in = static_cast<uInt>(left + got);
    return got > 0;
  }

  // These two give some bytes; false if there are no more.
  bool copy() {
    if (inflater_.avail_in == 0 && !fetch()) return false;
    const uInt count = std::min(inflater_.avail_in, inflater_.avail_out);
    std::memcpy(inflater_.next_out, inflater_.next_in, count);
    inflater_.next_in += count;
    inflater_.avail_in -= count;
    inflater_.next_out += count;
    inflater_.avail_out -= count;
    return true;
  }
  bool unpack() {
    if (ended_) {
      if (inflater_.avail_in < 2) fetch();
      if (inflater_.avail_in == 0) return false;
      if (!begins_member()) fail("something follows the compressed data");
      ::inflateReset(&inflater_);
      ended_ = false;
    }
    if (inflater_.avail_in == 0 && !fetch()) fail("is cut");
    const int result = ::inflate(&inflater_, Z_NO_FLUSH);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) fail("cannot be read");
    ended_ = result == Z_STREAM_END;
    return true;
  }
  [[noreturn]] void fail(const char* why) const { throw ReadError(path_ + ": " + why); }

  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::optional<std::uint64_t> size_;
  std::uint64_t given_ = 0;  // bytes so far
  std::vector<Bytef> packed_;
  z_stream inflater_{};  // of a plain file only its places are used
  bool plain_ = true;
  bool ended_ = false;  // nothing of the last member is left
};

}  // namespace

std::string read_whole_file(const std::string& path) {
  FileStream stream(path);
  std::string contents;
  if (stream.is_plain()) contents.reserve(stream.most_bytes().value_or(0) + kPiece);
  for (std::size_t got = kPiece; got == kPiece;) {
    const std::size_t before = contents.size();
    contents.resize(before + kPiece);
    got = stream.read(contents.data() + before, kPiece);
    contents.resize(before + got);
  }
  if (contents.empty()) throw ReadError(path + ": cannot be read, or is empty");
  return contents;
}

void check_unpacked(const std::string& what, std::uint64_t packed, std::uint64_t unpacked) {
  if (unpacked <= most_unpacked(packed)) return;
  throw ReadError(what + ": unpacks to more than " + std::to_string(kTimesUnpacked) +
                  " times its size");
}

std::string without_gz(const std::string& path) {
  return path.ends_with(kGzip) ? path.substr(0, path.size() - kGzip.size()) : path;
}

std::string maybe_with_gz(const std::string& path) {
  std::string packed = path + std::string(kGzip);
  return !std::filesystem::exists(path) && std::filesystem::exists(packed) ? packed : path;
}

ReadError::ReadError(const std::string& text) : std::runtime_error(one_line(text)) {}

struct TextReader::Source {
  explicit Source(const std::string& path) : stream(path) {}
  FileStream stream;
  std::vector<char> piece;
};

TextReader::TextReader(std::string name, std::string_view text, char comment)
    : name_(std::move(name)), text_(text), comment_(comment), size_(text.size()) {}

TextReader::TextReader(TextReader&&) noexcept = default;
TextReader& TextReader::operator=(TextReader&&) noexcept = default;
TextReader::~TextReader() = default;

TextReader TextReader::of_file(const std::string& path, char comment) {
  TextReader reader(path, {}, comment);
  reader.source_ = std::make_unique<Source>(path);
  reader.size_ =
      reader.source_->stream.most_bytes().value_or(std::numeric_limits<std::uint64_t>::max());
  if (!reader.refill()) throw ReadError(path + ": cannot be read, or is empty");
  return reader;
}

bool TextReader::refill() {
  if (source_ == nullptr) return false;
  std::vector<char>& piece = source_->piece;
  const std::size_t left = text_.size() - kept_;
  if (left > 0) std::memmove(piece.data(), piece.data() + kept_, left);
  piece.resize(left + kPiece);
  const std::size_t got = source_->stream.read(piece.data() + left, kPiece);
  text_ = std::string_view(piece.data(), left + got);
  at_ -= kept_;
  kept_ = 0;
  return got > 0;
}

void TextReader::fail(const std::string& reason) const {
  throw ReadError(name_ + ":" + std::to_string(line_) + ": " + reason);
}

void TextReader::skip_blanks(bool over_lines) {
  for (kept_ = at_; !at_its_end(); kept_ = at_) {
    const char c = text_[at_];
    if (c == '\n') {
      if (!over_lines) return;
      ++line_;
      ++at_;
    } else if (c == comment_ && comment_ != '\0') {
      ++comments_;
      skip_line();
    } else if (c == ' ' || c == '\t' || c == '\r') {
      ++at_;
    } else {
      return;
    }
  }
}

std::string_view TextReader::word() {
  skip_blanks(true);
  return word_in_line();
}

std::string_view TextReader::word_in_line() {
  steps += 2;
  skip_blanks(false);
  while (!at_its_end() && text_[at_] != ' ' && text_[at_] != '\t' && text_[at_] != '\r' &&
         text_[at_] != '\n') {
    ++at_;
    // Every piece of a longer one would be moved each time that one more is read.
    if (at_ - kept_ > kLongestWord) fail("a word of more than a million characters");
  }
  return text_.substr(kept_, at_ - kept_);
}

std::string_view TextReader::required_word(const char* what) {
  const std::string_view found = word();
  if (found.empty()) fail(std::string("the file ends where ") + what + " should be");
  return found;
}

void TextReader::skip_line() {
  while (!at_its_end() && text_[at_] != '\n') kept_ = ++at_;
}

void TextReader::expect_line_end() {
  if (const std::string_view word = word_in_line(); !word.empty()) {
    fail(quoted(word) + " where the line should end");
  }
}

void TextReader::begin_bytes() {
  expect_line_end();
  if (at_its_end()) fail("the file ends where bytes should begin");
  ++at_;
  ++line_;
}

void TextReader::read_bytes(char* target, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    kept_ = at_;
    if (at_its_end()) fail("the file ends within its bytes");
    target[std::endian::native == std::endian::little ? i : count - 1 - i] = text_[at_++];
  }
  kept_ = at_;
}

bool TextReader::at_end() {
  skip_blanks(true);
  return at_its_end();
}

namespace {

// For digits without a sign that are beyond the range of doubles: is the number too small, rather
// than too large? The first digit that is not a zero decides, as doubles reach about as far both
// ways.
bool underflows(std::string_view digits) {
  const std::size_t mark = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, mark);
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = std::min(mantissa.find_first_not_of("0."), mantissa.size());
  const auto place = static_cast<std::int64_t>(point) - static_cast<std::int64_t>(first);
  std::string_view exponent = digits.substr(std::min(mark + 1, digits.size()));
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  std::int64_t power = 0;
  const auto [end, error] =
      std::from_chars(exponent.data(), exponent.data() + exponent.size(), power);
  if (error == std::errc::result_out_of_range) return exponent.starts_with('-');
  return power + place < 0;
}

// Does a double hold all of these hexadecimal digits, with a point and an exponent perhaps?
bool fits_a_double(std::string_view digits) {
  const std::size_t mark = std::min(digits.find_first_of("pP"), digits.size());
  const std::string_view mantissa = digits.substr(0, mark);
  const std::size_t first = mantissa.find_first_not_of("0."),
                    last = mantissa.find_last_not_of("0.");
  if (first == std::string_view::npos) return true;
  const auto value_of = [&](std::size_t at) {
    unsigned value = 0;
    std::from_chars(&mantissa[at], &mantissa[at] + 1, value, 16);
    return value;
  };
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const auto places = static_cast<std::int64_t>(last - first + 1 - (first < point && point < last));
  const int spare = std::countr_zero(value_of(last));
  constexpr int kMost = 53, kLowest = -1074;
  if (4 * places - (4 - std::bit_width(value_of(first))) - spare > kMost) return false;
  std::int64_t exponent = 0;
  const std::string_view power = digits.substr(std::min(mark + 1, digits.size()));
  const std::size_t sign = power.starts_with('+') ? 1 : 0;
  std::from_chars(power.data() + sign, power.data() + power.size(), exponent);
  const auto behind = static_cast<std::int64_t>(last) - static_cast<std::int64_t>(point);
  return exponent - 4 * (behind > 0 ? behind : behind + 1) + spare >= kLowest;
}

}  // namespace

double TextReader::exact_number() {
  const std::string_view text = required_word("a number");
  std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  const bool hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
  if (hexadecimal) digits.remove_prefix(2);
  double value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::hex);
  if (!hexadecimal || error != std::errc() || end != digits.data() + digits.size() ||
      digits.starts_with('-') || !std::isfinite(value) || !fits_a_double(digits)) {
    fail(quoted(text) + " is not a hexadecimal number that a double holds");
  }
  return text.starts_with('-') ? -value : value;
}

double TextReader::number() {
  const std::string_view text = required_word("a number");
  std::string_view digits = text;
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  // from_chars leaves the value alone if it is out of range. A number that underflows is zero; all
  // others are rejected.
  const bool underflow = error == std::errc::result_out_of_range && underflows(digits);
  if ((error != std::errc() && !underflow) || end != digits.data() + digits.size() ||
      digits.starts_with('-')) {
    fail(quoted(text) + " is not a number");
  }
  return negative ? -value : value;
}

void TextReader::positive_once(double& value) {
  if (value != 0) fail("a number is there twice");
  value = number();
  if (!(value > 0)) fail("a number that is not positive");
}

float TextReader::single() {
  const double nearest = number();
  std::string_view text = text_.substr(kept_, at_ - kept_);  // of that number
  if (text.starts_with('+')) text.remove_prefix(1);
  float value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc()) return value;
  if (std::fabs(nearest) > 1) fail(quoted(text) + " is beyond single precision");
  return static_cast<float>(nearest);
}

void TextReader::expect(const std::string& wanted) {
  const std::string_view word = required_word(wanted.c_str());
  if (word != wanted) {
    fail(quoted(word) + " where " + wanted + " should be");
  }
}

void TextReader::expect_end(const std::string& wanted) {
  expect(wanted);
  expect_nothing();
}

void TextReader::expect_nothing() {
  if (!at_end()) fail("something follows the end");
}

std::int64_t TextReader::integer() {
  const std::string_view text = required_word("an integer");
  const std::string_view digits = text.substr(text.starts_with('+') ? 1 : 0);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool two_signs = digits.size() < text.size() && digits.starts_with('-');
  if (error != std::errc() || end != digits.data() + digits.size() || two_signs) {
    fail(quoted(text) + " is not an integer");
  }
  return value;
}

std::int32_t TextReader::integer32() {
  const std::int64_t value = integer();
  if (value != static_cast<std::int32_t>(value)) {
    fail(std::to_string(value) + " is not an integer of 32 bits");
  }
  return static_cast<std::int32_t>(value);
}

std::uint32_t TextReader::index(std::int64_t first, std::uint64_t count) {
  const std::int64_t value = integer();
  if (value < first || static_cast<std::uint64_t>(value - first) >= count) {
    fail("index " + std::to_string(value) + " is out of range");
  }
  return static_cast<std::uint32_t>(value - first);
}

std::uint64_t TextReader::count() {
  const std::int64_t value = integer();
  if (value < 0) fail("count " + std::to_string(value) + " is negative");
  return possible(static_cast<std::uint64_t>(value));
}

std::uint64_t TextReader::possible(std::uint64_t count) const {
  if (count > size_ / 2 + 1) {
    fail("count " + std::to_string(count) + " is more than the file can hold");
  }
  return count;
}

}  // namespace tetproof::oracles
