#include "mesher/io/text.h"

#include <cmath>
#include <limits>

namespace delmesher::io {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Whether a well-formed decimal beyond the range of doubles is too large (and not too small).
bool is_too_large(std::string_view digits) {
  long long leading = 0;  // decimal exponent of the first non-zero digit
  bool fraction = false, found = false;
  std::size_t i = 0;
  for (; i < digits.size() && lower(digits[i]) != 'e'; ++i) {
    if (digits[i] == '.') fraction = true;
    if (!is_digit(digits[i])) continue;
    if (digits[i] != '0') found = true;
    if (!fraction && found) ++leading;
    if (fraction && !found) --leading;
  }
  if (!found) return false;
  bool negative = false;
  long long exponent = 0;
  for (++i; i < digits.size(); ++i) {
    if (digits[i] == '-') negative = true;
    constexpr long long kHuge = 1LL << 60;
    if (is_digit(digits[i]) && exponent < kHuge / 16) exponent = exponent * 10 + (digits[i] - '0');
  }
  return leading + (negative ? -exponent : exponent) > 0;
}

// Bytes of the character at the front by the Unicode standard (table 3-7): no longer than needed,
// no halves of UTF-16 characters. 0 if it is not valid.
std::size_t size_of_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
  };
  const auto in = [&](std::size_t i, unsigned low, unsigned high) {
    return low <= byte(i) && byte(i) <= high;
  };
  const auto follow = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!in(i, 0x80, 0xbf)) return std::size_t{0};
    }
    return end;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (in(0, 0xc2, 0xdf)) return follow(1, 2);
  if (in(0, 0xe0, 0xef)) {
    const bool none = first == 0xef && byte(1) == 0xbf && byte(2) >= 0xbe;  // not in XML
    return none || !in(1, first == 0xe0 ? 0xa0 : 0x80, first == 0xed ? 0x9f : 0xbf) ? 0
                                                                                    : follow(2, 3);
  }
  if (in(0, 0xf0, 0xf4)) {
    return !in(1, first == 0xf0 ? 0x90 : 0x80, first == 0xf4 ? 0x8f : 0xbf) ? 0 : follow(2, 4);
  }
  return 0;
}

NumberStatus finite_or_not(double value) {
  return std::isfinite(value) ? NumberStatus::ok : NumberStatus::not_finite;
}

}  // namespace

void append_utf8(std::string& out, std::uint32_t code) {
  const auto byte = [&](std::uint32_t value) { out += static_cast<char>(value); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xc0U | code >> 6U);
  } else {
    if (code < 0x10000) {
      byte(0xe0U | code >> 12U);
    } else {
      byte(0xf0U | code >> 18U);
      byte(0x80U | (code >> 12U & 0x3fU));
    }
    byte(0x80U | (code >> 6U & 0x3fU));
  }
  byte(0x80U | (code & 0x3fU));
}

std::string latin1_in_utf8(std::string_view text) {
  std::string converted;
  for (const char c : text) append_utf8(converted, static_cast<unsigned char>(c));
  return converted;
}

std::string as_utf8(std::string_view text) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t size = size_of_utf8(rest);
    if (size == 0) return latin1_in_utf8(text);
    rest.remove_prefix(size);
  }
  return std::string(text);
}

NumberStatus parse_double(std::string_view token, double& value) {
  if (!token.empty() && token[0] == '+') {
    token.remove_prefix(1);
    if (!token.empty() && token[0] == '-') return NumberStatus::malformed;
  }
  const char* end = token.data() + token.size();
  const auto [last, error] = std::from_chars(token.data(), end, value);
  if (error == std::errc::invalid_argument || last != end) return NumberStatus::malformed;
  if (error == std::errc::result_out_of_range) {
    const bool negative = token[0] == '-';
    value = is_too_large(token) ? std::numeric_limits<double>::infinity() : 0.0;
    if (negative) value = -value;
  }
  return finite_or_not(value);
}

NumberStatus parse_hex_double(std::string_view token, double& value) {
  const bool negative = !token.empty() && token[0] == '-';
  if (negative) token.remove_prefix(1);
  if (token.size() < 3 || token[0] != '0' || lower(token[1]) != 'x' || token[2] == '-') {
    return NumberStatus::malformed;
  }
  token.remove_prefix(2);
  const char* end = token.data() + token.size();
  const auto [last, error] = std::from_chars(token.data(), end, value, std::chars_format::hex);
  if (error != std::errc() || last != end) return NumberStatus::malformed;
  if (negative) value = -value;
  return finite_or_not(value);
}

void append_double(std::string& out, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  out.append(buffer, result.ptr);
}

void append_hex(std::string& out, double value) {
  char buffer[48];
  if (std::signbit(value)) out += '-';
  out += "0x";
  const auto result =
      std::to_chars(buffer, buffer + sizeof buffer, std::fabs(value), std::chars_format::hex);
  out.append(buffer, result.ptr);
}

std::string in_quotes(std::string_view token) {
  constexpr std::size_t kLongest = 40;
  std::string out = "'";
  for (char c : token.substr(0, kLongest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (token.size() > kLongest ? "...'" : "'");
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (lower(a[i]) != lower(b[i])) return false;
  }
  return true;
}

TextLines::TextLines(std::string_view text, Comments comments, char extra_space)
    : text_(text), comments_(comments), extra_space_(extra_space) {
  if (text.substr(0, 3) == "\xEF\xBB\xBF") next_ = 3;
}

bool TextLines::is_space(char c) const {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f' ||
         c == extra_space_;
}

bool TextLines::next_raw_line() {
  if (next_ >= text_.size()) return false;
  position_ = next_;
  end_ = position_;
  while (end_ < text_.size() && text_[end_] != '\n' && text_[end_] != '\r') ++end_;
  next_ = end_;
  if (next_ < text_.size()) {
    const bool cr_lf = text_[next_] == '\r' && next_ + 1 < text_.size() && text_[next_ + 1] == '\n';
    next_ += cr_lf ? 2 : 1;
  }
  ++line_;
  if (comments_ == Comments::none) return true;
  for (std::size_t i = position_; i < end_; ++i) {
    const bool token_start = i == position_ || is_space(text_[i - 1]);
    if (text_[i] == '#' && (comments_ == Comments::anywhere || token_start)) end_ = i;
  }
  return true;
}

bool TextLines::take_bytes(std::size_t count, std::string_view& bytes) {
  if (text_.size() - next_ < count) return false;
  bytes = text_.substr(next_, count);
  next_ += count;
  position_ = end_ = next_;
  return true;
}

bool TextLines::next_line() {
  while (next_raw_line()) {
    for (std::size_t i = position_; i < end_; ++i) {
      if (!is_space(text_[i])) return true;
    }
  }
  return false;
}

bool TextLines::next_token(std::string_view& token) {
  while (position_ < end_ && is_space(text_[position_])) ++position_;
  if (position_ == end_) return false;
  const std::size_t begin = position_;
  while (position_ < end_ && !is_space(text_[position_])) ++position_;
  token = text_.substr(begin, position_ - begin);
  return true;
}

bool TextLines::next_token_anywhere(std::string_view& token) {
  while (!next_token(token)) {
    if (!next_line()) return false;
  }
  return true;
}

std::string_view TextLines::rest_of_line() const {
  std::size_t begin = position_, end = end_;
  while (begin < end && is_space(text_[begin])) ++begin;
  while (end > begin && is_space(text_[end - 1])) --end;
  return text_.substr(begin, end - begin);
}

}  // namespace delmesher::io
