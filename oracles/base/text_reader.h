// Reads numbers and words out of a text file, and knows the line for error messages. The oracles'
// own.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tetproof::oracles {

// "file:line: reason"; thrown by the readers, caught at their entry points.
struct ReadError : std::runtime_error {
  // Makes the text one line of at most 1000 bytes, since a file may hold anything.
  explicit ReadError(const std::string& text);
};

// The whole contents of a file, unpacked if it is compressed with gzip. Throws ReadError, also if
// it is empty.
std::string read_whole_file(const std::string& path);

// Throws ReadError (`what` is its beginning) if a packed file of so many bytes holds more than a
// mesh or a surface can: such a file would only take memory before it is rejected. The numbers of
// regular grids, which are packed best, take a 16th of their text.
void check_unpacked(const std::string& what, std::uint64_t packed, std::uint64_t unpacked);

// What a file that may be compressed with gzip is called without that: "part.stl" of "part.stl.gz".
std::string without_gz(const std::string& path);
// The path, with ".gz" after it where only such a file exists.
std::string maybe_with_gz(const std::string& path);

// A word that was returned lasts until the next one is asked for.
class TextReader {
 public:
  // The text must outlive the reader. A comment sign ends its line; '\0' if there are no comments.
  TextReader(std::string name, std::string_view text, char comment = '#');
  // Reads a file as read_whole_file() does, and holds a piece of it at a time. Throws ReadError if
  // it cannot be read, or is empty.
  static TextReader of_file(const std::string& path, char comment = '#');
  TextReader(TextReader&&) noexcept;
  TextReader& operator=(TextReader&&) noexcept;
  ~TextReader();

  // That were passed over so far.
  std::uint64_t comments() const { return comments_; }
  // From here on a comment sign is a character like any other.
  void without_comments() { comment_ = '\0'; }
  // The next word, empty at the end of the text.
  std::string_view word();
  // The next word of this line, empty if there is none.
  std::string_view word_in_line();
  std::string_view required_word(const char* what);
  void skip_line();
  // Nothing but blanks may follow in this line.
  void expect_line_end();
  bool at_end();
  // Nothing but blanks may follow in the text.
  void expect_nothing();
  // The next word must be this one.
  void expect(const std::string& wanted);
  // This last word has to follow, and nothing else.
  void expect_end(const std::string& wanted);
  // A list of a record: its name, a count, and the items.
  template <class Item, class Read>
  void list(const std::string& name, std::vector<Item>& items, const Read& read_item) {
    expect(name);
    read_items(items, read_item);
  }
  // The same without a name. Memory is taken as items are read, as a count may be a lie.
  template <class Item, class Read>
  void read_items(std::vector<Item>& items, const Read& read_item) {
    constexpr std::size_t kFirst = 4096;
    const std::size_t wanted = count();
    items.clear();
    while (items.size() < wanted) {
      if (items.size() == items.capacity()) {
        items.reserve(std::min(wanted, std::max(kFirst, 2 * items.size())));
      }
      read_item(items.emplace_back());
    }
  }

  // The rest of this line is blank; bytes begin after it.
  void begin_bytes();
  // The number that the next bytes are, the least significant first.
  template <class T>
  T bytes() {
    T value;
    read_bytes(reinterpret_cast<char*>(&value), sizeof(T));
    return value;
  }

  double number();  // decimal, the nearest double
  // A positive number, where the one that is there so far is 0.
  void positive_once(double& value);
  float single();  // decimal, the nearest float
  // Hexadecimal, finite, and with no more digits than a double holds.
  double exact_number();
  std::int64_t integer();
  std::int32_t integer32();  // as labels are
  // An index in [first, first + count), less first.
  std::uint32_t index(std::int64_t first, std::uint64_t count);
  // A count of things that take at least two characters each, so that no lie can exhaust memory.
  std::uint64_t count();
  // The same of a number that is known.
  std::uint64_t possible(std::uint64_t count) const;

  [[noreturn]] void fail(const std::string& reason) const;
  std::uint64_t line() const { return line_; }

 private:
  struct Source;  // where the rest of a file comes from

  // Is nothing left? Reads on, and keeps text_ from kept_ on, if it has to.
  bool at_its_end() { return at_ >= text_.size() && !refill(); }
  bool refill();
  void skip_blanks(bool over_lines);
  void read_bytes(char* target, std::size_t count);

  std::string name_;
  std::string_view text_;  // the piece that is there
  char comment_;
  std::uint64_t comments_ = 0;
  std::unique_ptr<Source> source_;  // null: text_ is the whole text
  std::uint64_t size_;              // of the whole text
  std::size_t at_ = 0, kept_ = 0;   // kept_: where the last word begins
  std::uint64_t line_ = 1;
};

}  // namespace tetproof::oracles
