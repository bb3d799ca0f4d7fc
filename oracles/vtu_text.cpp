#include "oracles/vtu_text.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "oracles/text_reader.h"

namespace tetproof::oracles {

VtuText::VtuText(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {
  cut_out_appended();
  remove_comments();
  check_elements();
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
  const std::string order = attribute_of_file("byte_order");
  if (!order.empty() && order != "LittleEndian" && order != "BigEndian") {
    fail("no byte order " + order);
  }
  points_ = count("NumberOfPoints");
  cells_ = count("NumberOfCells");
}

// Bytes, which may look like anything: from the first '_' of their element to the last end of one.
void VtuText::cut_out_appended() {
  const std::string kEnd = "</AppendedData>";
  const std::size_t begin = text_.find("<AppendedData");
  if (begin == std::string_view::npos) return;
  const std::size_t close = text_.find('>', begin), end = text_.rfind(kEnd);
  const std::size_t mark = text_.find('_', std::min(close, text_.size()));
  if (mark == std::string_view::npos || end == std::string_view::npos || end < mark) {
    fail("appended data without a beginning or an end");
  }
  const std::string encoding = attribute(text_.substr(begin, close - begin), "encoding");
  if (encoding != "raw" && encoding != "base64") fail("appended data in no known encoding");
  appended_raw_ = encoding == "raw";
  appended_ = text_.substr(mark + 1, end - mark - 1);
  without_appended_.append(text_.substr(0, begin)).append("<AppendedData/>");
  without_appended_.append(text_.substr(end + kEnd.size()));
  text_ = without_appended_;
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

namespace {

// Is that where VTK looks for such an element? It skips what it does not know.
bool may_hold(std::string_view parent, std::string_view element) {
  // What begins like an element that is read would be taken for it.
  for (const std::string_view read : {"VTKFile", "Piece", "Points", "Cells", "CellData",
                                      "FieldData", "DataArray", "AppendedData"}) {
    if (element.starts_with(read) && element != read) return false;
  }
  if (element == "VTKFile") return parent.empty();
  if (element == "UnstructuredGrid" || element == "AppendedData") return parent == "VTKFile";
  if (element == "Piece") return parent == "UnstructuredGrid";
  if (element == "Points" || element == "Cells" || element == "CellData") return parent == "Piece";
  if (element == "FieldData") return parent == "UnstructuredGrid" || parent == "Piece";
  if (element != "DataArray") return !parent.empty();
  return parent == "Points" || parent == "Cells" || parent == "CellData" || parent == "PointData" ||
         parent == "FieldData";
}

}  // namespace

// The elements end in the order in which XML lets them, and are where they are looked for.
void VtuText::check_elements() const {
  std::vector<std::string_view> open;
  for (std::size_t at = text_.find('<'); at != std::string_view::npos; at = text_.find('<', at)) {
    std::size_t end = at + 1;
    for (char quote = 0; end < text_.size() && (quote != 0 || text_[end] != '>'); ++end) {
      const char c = text_[end];
      if (quote == 0 ? c == '"' || c == '\'' : c == quote) quote = quote == 0 ? c : '\0';
      if (c == '<' || (quote != 0 && c == '>')) fail("a tag within a tag");
    }
    if (end == text_.size()) fail("a tag does not end");
    const std::string_view tag = text_.substr(at + 1, end - at - 1);
    const bool first =  // but for the mark of UTF-8
        text_.substr(0, at).find_first_not_of(" \t\r\n\xEF\xBB\xBF") == std::string_view::npos;
    at = end;
    if (first && tag.starts_with("?xml ")) continue;  // how the text is encoded
    const bool closes = tag.starts_with('/');
    const std::size_t begin = closes ? 1 : 0;
    const std::string_view name = tag.substr(begin, tag.find_first_of(" \t\r\n/", begin) - begin);
    if (closes) {
      if (open.empty() || open.back() != name) fail("</" + std::string(name) + "> ends nothing");
      open.pop_back();
      continue;
    }
    attributes(tag);
    if (!may_hold(open.empty() ? "" : open.back(), name)) {
      fail("<" + std::string(name) + "> is at another place than readers look for it");
    }
    if (!tag.ends_with('/')) open.push_back(name);
  }
  if (!open.empty()) fail("<" + std::string(open.back()) + "> does not end");
}

// Of the piece.
std::size_t VtuText::count(const std::string& name) const {
  const std::size_t at = text_.find("<Piece");
  if (at == std::string_view::npos) fail("there is no piece");
  const std::string number = attribute(text_.substr(at, text_.find('>', at) - at), name);
  if (number.empty()) fail("the piece has no " + name);
  return TextReader(path_, number, '\0').index(0, 0xffffffffU);
}

// Of a tag from its element's name on: blanks, name="value" and so on. Some readers take more than
// that, and might find another one.
VtuText::Attributes VtuText::attributes(std::string_view tag) const {
  constexpr std::string_view kBlank = " \t\r\n";
  if (tag.ends_with('/')) tag.remove_suffix(1);
  Attributes found;
  tag.remove_prefix(std::min(tag.find_first_of(kBlank), tag.size()));
  for (std::size_t begin; (begin = tag.find_first_not_of(kBlank)) != std::string_view::npos;) {
    const std::size_t equals = std::min(tag.find("=\"", begin), tag.size());
    const std::size_t end = tag.find('"', std::min(equals + 2, tag.size()));
    const std::string_view name = tag.substr(begin, equals - begin);
    if (begin == 0 || end == std::string_view::npos ||
        name.find_first_of(" \t\r\n\"'=<") != std::string_view::npos) {
      fail("a tag whose attributes are not of the kind name=\"value\"");
    }
    if (!found.emplace(name, tag.substr(equals + 2, end - equals - 2)).second) {
      fail("a tag has " + std::string(name) + " twice");
    }
    tag.remove_prefix(end + 1);
  }
  return found;
}

std::string VtuText::attribute(std::string_view tag, const std::string& name) const {
  const Attributes all = attributes(tag);
  const auto found = all.find(name);
  return found == all.end() ? std::string() : std::string(found->second);
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

// What a character of base 64 means; 64 for '=', which fills up a group, and 65 for any other.
std::uint32_t digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<std::uint32_t>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<std::uint32_t>(c - 'a') + 26;
  if (c >= '0' && c <= '9') return static_cast<std::uint32_t>(c - '0') + 52;
  return c == '+' ? 62 : c == '/' ? 63 : c == '=' ? 64 : 65;
}

// The bytes that a text in base 64 means, or several, one after the other, each filled up to a
// group of four; false if it is none.
bool decode(std::string_view text, std::string& bytes) {
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
    const std::uint32_t digit = digit_of(c);
    padding += digit == 64 ? 1 : 0;
    if (digit > 64 || (padding > 0 && digit < 64) || padding > 2) return false;
    bits = bits << 6U | (digit & 63U);
    if (++digits < 4) continue;
    for (int i = 0; i < 3 - padding; ++i) bytes += static_cast<char>(bits >> (16 - 8 * i) & 255U);
    digits = padding = 0;
  }
  return digits == 0;
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

// Could a number written as text be of that type? Readers make another number of it if not.
bool fits(const std::string& type, double value) {
  if (type == "Float64" || type == "Float32") return true;
  const bool is_signed = type.starts_with("Int"), is_unsigned = type.starts_with("UInt");
  if (!is_signed && !is_unsigned) return false;
  const std::string bits = type.substr(is_signed ? 3 : 4);
  if (bits != "8" && bits != "16" && bits != "32" && bits != "64") return false;
  const double end = std::ldexp(1.0, std::stoi(bits) - (is_signed ? 1 : 0));
  return value == std::trunc(value) && value < end && value >= (is_signed ? -end : 0);
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

std::string VtuText::attribute_of_file(const std::string& name) const {
  const std::string_view head = text_.substr(0, text_.find("<Piece"));
  const std::string_view file = head.substr(head.find("<VTKFile"));
  return attribute(file.substr(0, file.find('>')), name);
}

// Takes one of the numbers before an array's bytes.
std::uint64_t VtuText::size_at(std::string_view& bytes) const {
  const bool wide = attribute_of_file("header_type") == "UInt64";
  const std::size_t width = wide ? 8 : 4;
  if (bytes.size() < width) fail("an array without the number of its bytes");
  const std::uint64_t size =
      wide ? number_at<std::uint64_t>(bytes, 0) : number_at<std::uint32_t>(bytes, 0);
  bytes.remove_prefix(width);
  return size;
}

// First the number of blocks, how large they are, how large the last one is if it is smaller, and
// what they take here.
std::string VtuText::unpacked(std::string_view bytes) const {
  const std::uint64_t blocks = size_at(bytes), size = size_at(bytes), last = size_at(bytes);
  if (blocks > bytes.size() / 4) fail("more blocks of an array than there can be");
  std::vector<std::uint64_t> packed;
  for (std::uint64_t b = 0; b < blocks; ++b) packed.push_back(size_at(bytes));
  std::string all;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t wanted = b + 1 == blocks && last != 0 ? last : size;
    // No block becomes more than 1032 times as large.
    if (packed[b] > bytes.size() || wanted / 1032 > packed[b]) fail("blocks that are not there");
    std::string block(wanted, '\0');
    uLongf got = wanted;
    const int code = ::uncompress(reinterpret_cast<Bytef*>(block.data()), &got,
                                  reinterpret_cast<const Bytef*>(bytes.data()), packed[b]);
    if (code != Z_OK || got != wanted) fail("a block of an array that cannot be unpacked");
    all += block;
    bytes.remove_prefix(packed[b]);
  }
  return all;
}

// Of an array as bytes, from the number of its bytes on; something may follow it if it is appended.
std::vector<double> VtuText::binary_values(const std::string& type, std::string_view bytes,
                                           bool appended) const {
  static_assert(std::endian::native == std::endian::little);
  const std::string compressor = attribute_of_file("compressor");
  if (attribute_of_file("byte_order") != "LittleEndian") fail("bytes in another order");
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    fail("bytes compressed by " + compressor);
  }
  std::string made;
  if (compressor.empty()) {
    const std::uint64_t size = size_at(bytes);
    if (appended ? size > bytes.size() : size != bytes.size()) {
      fail("an array has another number of bytes than announced");
    }
    bytes = bytes.substr(0, size);
  } else {
    made = unpacked(bytes);
    bytes = made;
  }
  const std::vector<double> values = numbers_of(type, bytes);
  if (values.empty() && !bytes.empty()) fail("an array of type " + type + ", or of half a number");
  return values;
}

// From there to the next array, or to the end.
std::string_view VtuText::appended_at(std::uint64_t offset) const {
  if (offset > appended_.size()) fail("an array that is beyond the appended data");
  std::uint64_t end = appended_.size();
  constexpr std::string_view kOffset = " offset=\"";
  for (std::size_t at = text_.find(kOffset); at != std::string_view::npos;
       at = text_.find(kOffset, at + 1)) {
    const std::size_t begin = at + kOffset.size();
    const std::uint64_t other = offset_in(text_.substr(begin, text_.find('"', begin) - begin));
    if (other > offset) end = std::min(end, other);
  }
  return appended_.substr(offset, end - offset);
}

std::uint64_t VtuText::offset_in(std::string_view text) const {
  return static_cast<std::uint64_t>(
      TextReader(path_, text, '\0').index(0, std::uint64_t{1} << 32U));
}

// The text of an array from there to the end of its element.
std::vector<double> VtuText::values(std::string_view tag, std::size_t start) const {
  std::vector<double> values;
  const std::string format = attribute(tag, "format"), type = attribute(tag, "type");
  if (format == "appended") {
    const std::string_view stored = appended_at(offset_in(attribute(tag, "offset")));
    std::string bytes;
    if (!appended_raw_ && !decode(stored, bytes)) fail("an array that is not in base 64");
    return binary_values(type, appended_raw_ ? stored : bytes, true);
  }
  if (tag.ends_with('/')) return values;
  if (format != "ascii" && format != "binary") fail("an array in no known format");
  const std::size_t stop = std::min(text_.find('<', start), text_.size());
  if (!text_.substr(stop).starts_with("</DataArray>")) fail("an array does not end as it should");
  if (format == "binary") {
    std::string bytes;
    if (!decode(text_.substr(start, stop - start), bytes)) fail("an array that is not in base 64");
    return binary_values(type, bytes, false);
  }
  TextReader reader(path_, text_.substr(start, stop - start), '\0');
  while (!reader.at_end()) values.push_back(reader.number());
  if (type == "Float32") {  // which is what readers make of them
    for (double& value : values) value = static_cast<float>(value);
  }
  const bool fit = std::ranges::all_of(values, [&](double value) { return fits(type, value); });
  if (!fit) fail("an array of type " + type + " with a value that is none of these");
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
    if (section == "Cells" && attribute(tag, "type").starts_with("Float")) {
      fail(what + " is of numbers that are no integers");
    }
    result = values(tag, close + 1);
    const std::string tuples = attribute(tag, "NumberOfTuples");
    if (!tuples.empty() && tuples != std::to_string(result.size() / std::stoul(wanted))) {
      fail(what + " has not " + tuples + " tuples");
    }
    const std::size_t size = section == "Points" ? 3 * points_ : cells_;
    if (name != "connectivity" && result.size() != size) {
      fail(what + " has " + std::to_string(result.size()) + " values, not " + std::to_string(size));
    }
  }
  return result;
}

namespace {

// What an attribute's value means.
std::string unescaped(std::string_view value) {
  static const std::map<std::string_view, char> kEntities = {
      {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}};
  std::string text;
  for (std::size_t at = 0; at < value.size(); ++at) {
    const std::size_t end = value[at] == '&' ? value.find(';', at) : std::string_view::npos;
    const auto found = end == std::string_view::npos
                           ? kEntities.end()
                           : kEntities.find(value.substr(at + 1, end - at - 1));
    text += found == kEntities.end() ? value[at] : found->second;
    if (found != kEntities.end()) at = end;
  }
  return text;
}

}  // namespace

// Arrays that tell no name are passed over, whatever they hold.
SetNames VtuText::names() const {
  SetNames names;
  std::size_t end = 0;
  for (std::size_t at = text_.find("<FieldData"); at != std::string_view::npos;
       at = text_.find("<FieldData", end)) {
    end = std::min(text_.find("</FieldData", at), text_.size());
    while ((at = text_.find("<DataArray", at)) < end) {
      const std::size_t close = text_.find('>', at);
      const std::string_view tag = text_.substr(at, close - at);
      at = close;
      const bool plain = text_.substr(text_.find('<', close)).starts_with("</DataArray>");
      if (!plain || tag.ends_with('/') || attribute(tag, "NumberOfTuples") != "2" ||
          !attribute(tag, "type").starts_with("Int") || attribute(tag, "format") != "ascii") {
        continue;
      }
      const std::vector<double> told = values(tag, close + 1);
      if (told.size() != 2 || (told[1] != 2 && told[1] != 3) || std::fabs(told[0]) > 0x1p53) {
        continue;
      }
      std::string& name = names[{static_cast<int>(told[1]), integer(told[0])}];
      name += (name.empty() ? "" : " and ") + unescaped(attribute(tag, "Name"));
    }
  }
  return names;
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
