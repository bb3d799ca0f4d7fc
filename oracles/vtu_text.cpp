#include "oracles/vtu_text.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "oracles/text_reader.h"

namespace tetproof::oracles {
namespace {

std::string attribute(std::string_view tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string_view::npos) return {};
  const std::size_t start = at + name.size() + 3;
  return std::string(tag.substr(start, tag.find('"', start) - start));
}

}  // namespace

VtuText::VtuText(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {
  remove_comments();
  for (const std::string tag : {"<VTKFile", "<Piece", "<Points", "<Cells", "<CellData"}) {
    if (text_.find(tag) != text_.rfind(tag)) fail(tag.substr(1) + " is there twice");
  }
  if (text_.find("<VTKFile type=\"UnstructuredGrid\"") == std::string_view::npos) {
    fail("it does not begin as an unstructured grid does");
  }
  const std::size_t end = text_.find("</VTKFile>");
  if (end == std::string_view::npos) fail("the end is missing");
  const std::size_t after = end + std::string_view("</VTKFile>").size();
  if (text_.find_first_not_of(" \t\r\n", after) != std::string_view::npos) {
    fail("something follows the end");
  }
  points_ = count("NumberOfPoints");
  cells_ = count("NumberOfCells");
}

// What is in them is not there. Marked sections, which could hold arrays as well, are refused.
void VtuText::remove_comments() {
  if (text_.find("<!") == std::string_view::npos) return;
  for (std::size_t at = 0; at < text_.size();) {
    const std::size_t begin = std::min(text_.find("<!", at), text_.size());
    without_comments_.append(text_.substr(at, begin - at));
    if (begin == text_.size()) break;
    const std::size_t end = text_.find("-->", begin);
    if (!text_.substr(begin).starts_with("<!--") || end == std::string_view::npos) {
      fail("a declaration, or a comment without an end");
    }
    at = end + 3;
  }
  text_ = without_comments_;
}

// Of the piece.
std::size_t VtuText::count(const std::string& name) const {
  const std::size_t at = text_.find("<Piece");
  if (at == std::string_view::npos) fail("there is no piece");
  const std::string number = attribute(text_.substr(at, text_.find('>', at) - at), name);
  if (number.empty()) fail("the piece has no " + name);
  return TextReader(path_, number, '\0').index(0, 0xffffffffU);
}

void VtuText::fail(const std::string& reason) const {
  throw ReadError(path_ + ": " + reason);
}

std::int64_t VtuText::integer(double value) const {
  if (!(std::fabs(value) < 0x1p53) || value != std::trunc(value)) fail("a value is no integer");
  return static_cast<std::int64_t>(value);
}

std::int32_t VtuText::integer32(double value) const {
  const std::int64_t whole = integer(value);
  if (whole != static_cast<std::int32_t>(whole)) fail("a value is no integer of 32 bits");
  return static_cast<std::int32_t>(whole);
}

namespace {

// The bytes that a text in base 64 means; false if it is none.
bool decode(std::string_view text, std::string& bytes) {
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z') {
      value = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      value = static_cast<std::uint32_t>(c - 'a') + 26;
    } else if (c >= '0' && c <= '9') {
      value = static_cast<std::uint32_t>(c - '0') + 52;
    } else if (c == '+' || c == '/') {
      value = c == '+' ? 62 : 63;
    } else if (c != '=') {
      return false;
    }
    padding += c == '=' ? 1 : 0;
    if (padding > 0 && c != '=') return false;
    bits = bits << 6U | value;
    if (++digits % 4 != 0) continue;
    for (const unsigned shift : {16U, 8U, 0U}) bytes += static_cast<char>(bits >> shift & 255U);
  }
  if (digits % 4 != 0 || padding > 2) return false;
  bytes.resize(bytes.size() - static_cast<std::size_t>(padding));
  return true;
}

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

template <class T>
std::vector<double> numbers(std::string_view bytes) {
  std::vector<double> values;
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    values.push_back(static_cast<double>(number_at<T>(bytes, at)));
  }
  if (values.size() * sizeof(T) != bytes.size()) values.clear();
  return values;
}

std::vector<double> numbers_of(const std::string& type, std::string_view bytes) {
  return type == "Float64"   ? numbers<double>(bytes)
         : type == "Float32" ? numbers<float>(bytes)
         : type == "Int64"   ? numbers<std::int64_t>(bytes)
         : type == "UInt64"  ? numbers<std::uint64_t>(bytes)
         : type == "Int32"   ? numbers<std::int32_t>(bytes)
         : type == "UInt32"  ? numbers<std::uint32_t>(bytes)
         : type == "Int16"   ? numbers<std::int16_t>(bytes)
         : type == "UInt16"  ? numbers<std::uint16_t>(bytes)
         : type == "Int8"    ? numbers<std::int8_t>(bytes)
         : type == "UInt8"   ? numbers<std::uint8_t>(bytes)
                             : std::vector<double>();
}

}  // namespace

// Of an array in base 64: first the number of its bytes.
std::vector<double> VtuText::binary_values(const std::string& type, std::string_view text) const {
  static_assert(std::endian::native == std::endian::little);
  const std::string_view head = text_.substr(0, text_.find("<Piece"));
  const std::string_view file = head.substr(head.find("<VTKFile"));
  const std::string_view tag = file.substr(0, file.find('>'));
  if (attribute(tag, "byte_order") != "LittleEndian" || !attribute(tag, "compressor").empty()) {
    fail("bytes that are compressed, or in another order");
  }
  const std::size_t header = attribute(tag, "header_type") == "UInt64" ? 8 : 4;
  std::string bytes;
  if (!decode(text, bytes)) fail("an array that is not in base 64");
  if (bytes.size() < header) fail("an array without the number of its bytes");
  const std::uint64_t size =
      header == 8 ? number_at<std::uint64_t>(bytes, 0) : number_at<std::uint32_t>(bytes, 0);
  if (size != bytes.size() - header) fail("an array has another number of bytes than announced");
  const std::vector<double> values = numbers_of(type, std::string_view(bytes).substr(header));
  if (values.empty() && size > 0) fail("an array of type " + type + ", or of half a number");
  return values;
}

// The text of an array from there to the end of its element.
std::vector<double> VtuText::values(std::string_view tag, std::size_t start) const {
  std::vector<double> values;
  if (tag.ends_with('/')) return values;
  const std::string format = attribute(tag, "format");
  if (format != "ascii" && format != "binary") fail("arrays are read as text or in base 64 alone");
  const std::size_t stop = std::min(text_.find('<', start), text_.size());
  if (!text_.substr(stop).starts_with("</DataArray>")) fail("an array does not end as it should");
  if (format == "binary") {
    return binary_values(attribute(tag, "type"), text_.substr(start, stop - start));
  }
  TextReader reader(path_, text_.substr(start, stop - start), '\0');
  while (!reader.at_end()) values.push_back(reader.number());
  if (attribute(tag, "type") == "Float32") {  // which is what readers make of them
    for (double& value : values) value = static_cast<float>(value);
  }
  return values;
}

std::vector<double> VtuText::array(const std::string& section, const std::string& name) const {
  std::vector<double> result;
  std::size_t at = text_.find("<" + section);
  if (at == std::string_view::npos) return result;
  const std::size_t end = text_.find("</" + section, at);
  if (end == std::string_view::npos) fail(section + " does not end");
  const std::string wanted = section == "Points" ? "3" : "1";
  const std::string what = "the array " + name + (name.empty() ? "" : " ") + "of " + section;
  bool found = false;
  while ((at = text_.find("<DataArray", at)) < end) {
    const std::size_t close = text_.find('>', at);
    if (close == std::string_view::npos) fail("a tag does not end");
    const std::string_view tag = text_.substr(at, close - at);
    at = close;
    const std::string called = attribute(tag, "Name");
    // It could be this one all the same.
    if (!name.empty() && (called.empty() || called.find('&') != std::string::npos)) {
      fail("an array of " + section + " without a plain name");
    }
    if (!name.empty() && called != name) continue;
    if (std::exchange(found, true)) fail(what + " is there twice");
    const std::string components = attribute(tag, "NumberOfComponents");
    if (components != wanted && !(components.empty() && wanted == "1")) {
      fail(what + " has \"" + components + "\" components, not " + wanted);
    }
    result = values(tag, close + 1);
    const std::size_t size = section == "Points" ? 3 * points_ : cells_;
    if (name != "connectivity" && result.size() != size) {
      fail(what + " has " + std::to_string(result.size()) + " values, not " + std::to_string(size));
    }
  }
  return result;
}

std::vector<double> VtuText::required_array(const std::string& section,
                                            const std::string& name) const {
  std::vector<double> result = array(section, name);
  if (result.empty() && (section == "Points" ? points_ : cells_) > 0) {
    fail("the array " + name + (name.empty() ? "" : " ") + "of " + section + " is missing");
  }
  return result;
}

}  // namespace tetproof::oracles
