// Numbers and lines of text files, independent of any locale.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace delmesher::io {

enum class NumberStatus : std::uint8_t { ok, malformed, not_finite };

// The double nearest to a decimal number: optional sign (also '+'), digits, fraction, exponent. Too
// small a number becomes a zero (its nearest double); too large a one, inf and nan are not_finite.
NumberStatus parse_double(std::string_view token, double& value);

// A hexadecimal floating-point number as append_hex writes it ("-0x1.8p+3").
NumberStatus parse_hex_double(std::string_view token, double& value);

// A decimal integer, optional sign; false if malformed or out of the type's range. "-0" is 0 of any
// type.
template <typename T>
bool parse_integer(std::string_view token, T& value) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  if (token.starts_with("-0") && token.find_first_not_of('0', 1) == std::string_view::npos) {
    token.remove_prefix(1);
  }
  const char* end = token.data() + token.size();
  const auto [last, error] = std::from_chars(token.data(), end, value);
  return error == std::errc() && last == end;
}

// Appends the shortest decimal that reads back as exactly `value`.
void append_double(std::string& out, double value);
// Appends the exact value in hexadecimal, readable by strtod and Python's float.fromhex.
void append_hex(std::string& out, double value);

// A token made fit for an error message: quoted, printable, at most 40 characters.
std::string in_quotes(std::string_view token);

// Appends a character by its number.
void append_utf8(std::string& out, std::uint32_t code);
// Latin-1 in UTF-8.
std::string latin1_in_utf8(std::string_view text);
// The text itself if it is in UTF-8; else what it is in Latin-1, in UTF-8. Characters that XML
// cannot have (U+FFFE, U+FFFF) count as no UTF-8.
std::string as_utf8(std::string_view text);

bool equal_ignoring_case(std::string_view a, std::string_view b);

// How a '#' starts a comment.
enum class Comments : std::uint8_t { none, anywhere, at_token_start };

// Walks a text line by line and token by token; LF, CR LF and CR end lines, a missing final newline
// and a UTF-8 byte order mark are accepted. The text must outlive it.
class TextLines {
 public:
  TextLines(std::string_view text, Comments comments, char extra_space = ' ');

  // Moves to the next line, blank or not; false at the end of the text.
  bool next_raw_line();
  // Moves to the next line that holds a token.
  bool next_line();
  // Takes the next token of the current line; false at its end.
  bool next_token(std::string_view& token);
  // Takes the next token, on a later line if need be; false at the end of the text.
  bool next_token_anywhere(std::string_view& token);
  // Takes bytes that follow the current line, or the bytes taken last; false if there are not so
  // many.
  bool take_bytes(std::size_t count, std::string_view& bytes);
  // The rest of the current line, trimmed.
  std::string_view rest_of_line() const;

  // Number of the current line, from 1.
  std::uint64_t line() const { return line_ == 0 ? 1 : line_; }
  // Bytes after the current line.
  std::size_t remaining() const { return text_.size() - next_; }
  // Offset of the byte after the current line and its end.
  std::size_t next_offset() const { return next_; }

 private:
  bool is_space(char c) const;

  std::string_view text_;
  Comments comments_;
  char extra_space_;
  std::size_t position_ = 0, end_ = 0, next_ = 0;
  std::uint64_t line_ = 0;
};

}  // namespace delmesher::io
