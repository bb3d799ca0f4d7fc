// Reading numbers and words out of a text file, with the line for error messages. The oracles' own.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tetproof::oracles {

// "file:line: reason"; thrown by the readers, caught at their entry points.
struct ReadError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Whole contents of a file; throws ReadError.
std::string read_whole_file(const std::string& path);

class TextReader {
 public:
  // The text must outlive the reader. A comment sign ends its line; '\0' if there are no comments.
  TextReader(std::string name, std::string_view text, char comment = '#');

  // Next word, empty at the end of the text.
  std::string_view word();
  // Next word of this line, empty if there is none.
  std::string_view word_in_line();
  std::string_view required_word(const char* what);
  void skip_line();
  bool at_end();
  // The next word has to be this one.
  void expect(const std::string& wanted);
  // Nothing but this last word has to follow.
  void expect_end(const std::string& wanted);
  // A list of a record: its name, a count, and the items.
  template <class Item, class Read>
  void list(const std::string& name, std::vector<Item>& items, const Read& read_item) {
    expect(name);
    items.resize(count());
    for (Item& item : items) read_item(item);
  }

  double number();  // decimal or hexadecimal ("0x1.8p3"), exact to the nearest
  std::int64_t integer();
  // An index in [first, first + count), less first.
  std::uint32_t index(std::int64_t first, std::uint64_t count);
  // A count of things that take at least two characters each, so that no lie can exhaust memory.
  std::uint64_t count();

  [[noreturn]] void fail(const std::string& reason) const;
  std::uint64_t line() const { return line_; }

 private:
  void skip_blanks(bool over_lines);

  std::string name_;
  std::string_view text_;
  char comment_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 1;
};

}  // namespace tetproof::oracles
