// The arrays of a file in VTK's XML, however they are written: as text, or as bytes, which may be
// in base 64, compressed with zlib, and appended after the grid.
#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesher/base/polling.h"
#include "mesher/io/binary.h"
#include "mesher/io/reading.h"
#include "mesher/io/text.h"
#include "mesher/io/xml.h"

namespace delmesher::io {

// All functions throw ParseError, with a line where there is one.
class VtuArrays {
 public:
  // Finds the arrays of an unstructured grid of one piece. The text must outlive this.
  VtuArrays(std::string_view text, Polling& polling);

  // Calls take(number) with each number of an array, a double or an integer as its type has it: of
  // the points, or of "Cells NAME" and "CellData NAME". False if there is no such array.
  template <class Take>
  bool each_number(const std::string& key, const Take& take) const;

  // The numbers of an array, which must be integers; empty if there is none.
  template <class T>
  std::vector<T> integers(const std::string& key) const;
  template <class T>
  std::vector<T> required_integers(const std::string& key) const {
    if (!arrays_.contains(key)) fail_at_line(1, "there is no array " + in_quotes(key));
    return integers<T>(key);
  }

  // Calls take(name, first, second) with each pair of integers in the field data.
  template <class Take>
  void each_field_of_two(const Take& take) const {
    for (const auto& [name, array] : fields_) {
      std::vector<std::int64_t> values;
      each_number_in(array, false, [&](auto value) {
        if (holds<std::int64_t>(value)) values.push_back(static_cast<std::int64_t>(value));
      });
      if (values.size() == 2) take(name, values[0], values[1]);
    }
  }

  // The line on which an array begins; 1 if there is none.
  std::uint64_t line_of(const std::string& key) const;

 private:
  struct Array {
    std::uint64_t line = 0;
    std::string type;
    std::string_view text;                // between its tags
    bool binary = false;                  // in base 64
    std::optional<std::uint64_t> offset;  // where it begins among the appended bytes
  };
  // Bytes that are there, or that had to be made.
  struct Bytes {
    std::string made;
    std::string_view there;
    bool are_made = false;
    std::string_view all() const { return are_made ? std::string_view(made) : there; }
  };

  [[noreturn]] static void fail_at_line(std::uint64_t line, const std::string& reason) {
    fail(at_line(line), reason);
  }
  void read_file_tag(const XmlTags& tags);
  void read_array_tag(const XmlTags& tags, const std::string& section);
  void find_appended(const XmlTags& tags);
  void divide_appended();

  // Numbers in text are integers unless the array's type or `real` says otherwise.
  template <class Take>
  void each_number_in(const Array& array, bool real, const Take& take) const;
  Bytes bytes_of(const Array& array) const;
  // The bytes of an array with the numbers before them, as they are in the file.
  Bytes stored(const Array& array) const;
  // One of the numbers before the bytes, taken away from them.
  std::uint64_t take_size(const Array& array, std::string_view& bytes) const;
  std::string uncompressed(const Array& array, std::string_view bytes) const;

  template <class T, class Value>
  static bool holds(Value value) {
    if constexpr (std::is_floating_point_v<Value>) {
      const double number = value;
      return std::fabs(number) < 0x1p53 && std::trunc(number) == number &&
             std::in_range<T>(static_cast<std::int64_t>(number));
    } else {
      return std::in_range<T>(value);
    }
  }
  template <class T, class Take>
  void each_binary(const Array& array, const Take& take) const {
    const Bytes bytes = bytes_of(array);
    std::string_view rest = bytes.all();
    if (rest.size() % sizeof(T) != 0) fail_at_line(array.line, "an array of half a number");
    for (; !rest.empty(); rest.remove_prefix(sizeof(T))) {
      polling_.poll(8);
      take(number_from<T>(rest));
    }
  }
  template <class T, class Take>
  void each_in_text(const Array& array, const Take& take) const;

  std::string_view text_;
  Polling& polling_;
  std::map<std::string, Array> arrays_;
  std::vector<std::pair<std::string, Array>> fields_;  // of two integers, by name
  std::string compressor_;
  bool big_endian_ = false, in_latin1_ = false;
  std::size_t header_size_ = sizeof(std::uint32_t);  // of each number before an array's bytes
  std::string_view appended_;                        // after the '_'
  bool appended_in_base64_ = false;
  std::vector<std::uint64_t> offsets_;  // of all appended arrays, of use or not
};

template <class T, class Take>
void VtuArrays::each_in_text(const Array& array, const Take& take) const {
  TextLines lines(array.text, Comments::none);
  std::string_view token;
  while (lines.next_token_anywhere(token)) {
    polling_.poll();
    const std::uint64_t line = array.line + lines.line() - 1;
    T value{};
    if constexpr (std::is_floating_point_v<T>) {
      double number = 0;
      if (parse_double(token, number) == NumberStatus::malformed) {
        fail_at_line(line, "bad number " + in_quotes(token));
      }
      value = static_cast<T>(number);
      // Not rounded twice, as programs read such numbers at once.
      if constexpr (std::is_same_v<T, float>) {
        token.remove_prefix(token.starts_with('+') ? 1 : 0);
        std::from_chars(token.data(), token.data() + token.size(), value);
      }
      if (!std::isfinite(value)) fail_at_line(line, "non-finite number " + in_quotes(token));
    } else if (!parse_integer(token, value)) {
      fail_at_line(line, "bad number " + in_quotes(token));
    }
    take(value);
  }
}

template <class Take>
bool VtuArrays::each_number(const std::string& key, const Take& take) const {
  const auto found = arrays_.find(key);
  if (found == arrays_.end()) return false;
  each_number_in(found->second, key == "Points", take);
  return true;
}

template <class Take>
void VtuArrays::each_number_in(const Array& array, bool real, const Take& take) const {
  if (!array.binary && !array.offset) {
    if (array.type == "Float32") return each_in_text<float>(array, take);
    return real || array.type.starts_with("Float") ? each_in_text<double>(array, take)
                                                   : each_in_text<std::int64_t>(array, take);
  }
  if (array.type == "Float64") return each_binary<double>(array, take);
  if (array.type == "Float32") return each_binary<float>(array, take);
  if (array.type == "Int64") return each_binary<std::int64_t>(array, take);
  if (array.type == "UInt64") return each_binary<std::uint64_t>(array, take);
  if (array.type == "Int32") return each_binary<std::int32_t>(array, take);
  if (array.type == "UInt32") return each_binary<std::uint32_t>(array, take);
  if (array.type == "Int16") return each_binary<std::int16_t>(array, take);
  if (array.type == "UInt16") return each_binary<std::uint16_t>(array, take);
  if (array.type == "Int8") return each_binary<std::int8_t>(array, take);
  if (array.type == "UInt8") return each_binary<std::uint8_t>(array, take);
  fail_at_line(array.line, "an array of type " + in_quotes(array.type));
}

template <class T>
std::vector<T> VtuArrays::integers(const std::string& key) const {
  std::vector<T> values;
  each_number(key, [&](auto value) {
    if (!holds<T>(value)) {
      fail_at_line(line_of(key), "bad number '" + std::to_string(value) + "' in " + in_quotes(key));
    }
    values.push_back(static_cast<T>(value));
  });
  return values;
}

}  // namespace delmesher::io
