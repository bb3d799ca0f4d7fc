// Lists of numbered lines, as in the files of TetGen and of Triangle. A missing or malformed item
// is a ParseError at its line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mesher/io/reading.h"
#include "mesher/io/text.h"

namespace delmesher::io {

class NumberedLists {
 public:
  explicit NumberedLists(std::string_view text) : in_(text, Comments::anywhere, ',') {}

  TextLines& lines() { return in_; }
  Position here() const { return at_line(in_.line()); }

  // To the next line that holds something, where `what` is expected.
  void need_line(const char* what);
  // The number on the line of item `i` of a list that counts from `base`, which the first item
  // tells: 0 or 1.
  void need_number_of_item(std::uint64_t i, const std::string& item, const std::string& items);
  std::uint64_t base() const { return base_; }
  void set_base(std::uint64_t base) { base_ = base; }
  // The index, from 0, of an item of such a list of `size`.
  std::uint32_t vertex(std::string_view token, std::uint64_t size) const;
  // Every item takes a line of at least two bytes.
  void check_count(std::uint64_t count, std::uint64_t limit, const char* items) const;

  template <typename T>
  T need_integer(const std::string& what) {
    std::string_view token;
    if (!in_.next_token(token)) fail(here(), what + " is missing");
    return integer<T>(token, what);
  }
  // `fallback` if the line has ended.
  template <typename T>
  T integer_or(T fallback, const std::string& what) {
    std::string_view token;
    return in_.next_token(token) ? integer<T>(token, what) : fallback;
  }

 private:
  template <typename T>
  T integer(std::string_view token, const std::string& what) const {
    T value{};
    if (!parse_integer(token, value)) fail(here(), "bad " + what + " " + in_quotes(token));
    return value;
  }

  TextLines in_;
  std::uint64_t base_ = 0;
};

}  // namespace delmesher::io
