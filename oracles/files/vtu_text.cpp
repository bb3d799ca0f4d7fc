#include "oracles/files/vtu_text.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "oracles/base/text_reader.h"

namespace tetproof::oracles {

VtuText::VtuText(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {
  if (text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe")) fail("text in UTF-16");
  std::size_t end;
  file_ = read_xml_until(path_, text, "AppendedData", end);
  if (file_.name != "VTKFile" || file_.value("type") != "UnstructuredGrid") {
    fail("it does not begin as an unstructured grid does");
  }
  check(file_);
  if (at_most_one(file_, "AppendedData") != nullptr) take_appended(text.substr(end));
  const std::string order = file_.value("byte_order");
  if (!order.empty() && order != "LittleEndian" && order != "BigEndian") {
    fail("no byte order " + order);
  }
  const std::string header = file_.value("header_type");
  if (!header.empty() && header != "UInt32" && header != "UInt64") {
    fail("sizes of arrays of type " + header);
  }
  grid_ = &only(file_, "UnstructuredGrid");
  piece_ = &only(*grid_, "Piece");
  for (const char* section : {"Points", "Cells", "CellData"}) at_most_one(*piece_, section);
  points_ = count("NumberOfPoints");
  cells_ = count("NumberOfCells");
}

// Bytes, which may look like anything: from the first '_' of their element to the last end of one.
void VtuText::take_appended(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n", kEnd = "</AppendedData>", kFileEnd = "</VTKFile>";
  const std::string encoding = file_.all("AppendedData").front()->value("encoding");
  if (encoding != "raw" && encoding != "base64") fail("appended data in no known encoding");
  appended_raw_ = encoding == "raw";
  const std::size_t mark = text.find_first_not_of(kBlank), end = text.rfind(kEnd);
  if (end == std::string_view::npos || mark >= end || text[mark] != '_') {
    fail("appended data without a beginning or an end");
  }
  appended_ = text.substr(mark + 1, end - mark - 1);
  std::string_view rest = text.substr(end + kEnd.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlank), rest.size()));
  if (!rest.starts_with(kFileEnd)) fail("the end is missing");
  rest.remove_prefix(kFileEnd.size());
  if (rest.find_first_not_of(kBlank) != std::string_view::npos) fail("something follows the end");
}

namespace {

// Is that where VTK looks for such an element? It skips what it does not know.
bool may_hold(const std::string& parent, const std::string& element) {
  if (element == "UnstructuredGrid" || element == "AppendedData") return parent == "VTKFile";
  if (element == "Piece") return parent == "UnstructuredGrid";
  if (element == "Points" || element == "Cells" || element == "CellData") return parent == "Piece";
  if (element == "FieldData") return parent == "UnstructuredGrid" || parent == "Piece";
  if (parent == "DataArray") return element == "InformationKey";
  if (parent == "Points" || parent == "Cells") return element == "DataArray";
  if (element != "DataArray") return element != "VTKFile";
  return parent == "CellData" || parent == "PointData" || parent == "FieldData";
}

}  // namespace

void VtuText::check(const XmlElement& element) {
  for (const XmlElement& child : element.children) {
    if (!may_hold(element.name, child.name)) {
      fail("<" + child.name + "> is at another place than readers look for it");
    }
    // VTK takes an array of a step in the place of the others.
    if (child.attribute("TimeStep") != nullptr || child.attribute("TimeValues") != nullptr) {
      fail("steps in time");
    }
    if (child.name == "DataArray" && child.value("format") == "appended") {
      offsets_.insert(offset_of(child));
    }
    check(child);
  }
}

const XmlElement& VtuText::only(const XmlElement& parent, const std::string& name) const {
  const XmlElement* found = at_most_one(parent, name);
  if (found == nullptr) fail("there is no " + name);
  return *found;
}

const XmlElement* VtuText::at_most_one(const XmlElement& parent, const std::string& name) const {
  const std::vector<const XmlElement*> found = parent.all(name);
  if (found.size() > 1) fail(name + " is there twice");
  return found.empty() ? nullptr : found.front();
}

// A count of the piece.
std::size_t VtuText::count(const std::string& name) const {
  const std::string* number = piece_->attribute(name);
  if (number == nullptr) fail("the piece has no " + name);
  return TextReader(path_, *number, '\0').index(0, 0xffffffffU);
}

void VtuText::fail(const std::string& reason) const {
  throw ReadError(path_ + ": " + reason);
}

std::int64_t VtuText::integer(double value) const {
  if (!(std::fabs(value) < 0x1p53) || value != std::trunc(value)) fail("a value is not an integer");
  return static_cast<std::int64_t>(value);
}

std::int32_t VtuText::integer32(double value) const {
  const std::int64_t whole = integer(value);
  if (whole != static_cast<std::int32_t>(whole)) fail("a value is not an integer of 32 bits");
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
// group of four; false if it is not one.
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

// Takes one of the numbers before an array's bytes.
std::uint64_t VtuText::size_at(std::string_view& bytes) const {
  const bool wide = file_.value("header_type") == "UInt64";
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
    check_unpacked(path_, text_.size(), all.size() + wanted);
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

// The values of a binary array, which begins with its size in bytes; more may follow if it is
// appended.
std::vector<double> VtuText::binary_values(const std::string& type, std::string_view bytes,
                                           bool appended) const {
  static_assert(std::endian::native == std::endian::little);
  const std::string compressor = file_.value("compressor");
  if (file_.value("byte_order") != "LittleEndian") fail("bytes in another order");
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
  const auto next = offsets_.upper_bound(offset);
  const std::uint64_t end = next == offsets_.end() ? appended_.size() : *next;
  return appended_.substr(offset, end - offset);
}

std::uint64_t VtuText::offset_of(const XmlElement& array) const {
  const std::string text = array.value("offset");
  return static_cast<std::uint64_t>(
      TextReader(path_, text, '\0').index(0, std::uint64_t{1} << 32U));
}

std::vector<double> VtuText::values(const XmlElement& array) const {
  std::vector<double> values;
  const std::string format = array.value("format"), type = array.value("type");
  if (format == "appended") {
    const std::string_view stored = appended_at(offset_of(array));
    std::string bytes;
    if (!appended_raw_ && !decode(stored, bytes)) fail("an array that is not in base 64");
    return binary_values(type, appended_raw_ ? stored : bytes, true);
  }
  std::string_view text = text_.substr(array.begin, array.end - array.begin);
  const std::size_t inner = text.find('<');
  if (inner != std::string_view::npos) {
    // Readers differ in what they take of an array with comments in it, or of its second half.
    if (array.has_text_behind_child || text.find("<!") != std::string_view::npos ||
        text.find("<?") != std::string_view::npos) {
      fail("extra data among or after the values of an array");
    }
    text = text.substr(0, inner);
  }
  if (array.begin == array.end) return values;
  if (format != "ascii" && format != "binary") fail("an array in no known format");
  if (format == "binary") {
    std::string bytes;
    if (!decode(text, bytes)) fail("an array that is not in base 64");
    return binary_values(type, bytes, false);
  }
  if (!fits(type, 0)) fail("an array of type " + type);
  TextReader reader(path_, text, '\0');
  const bool real = type == "Float64", is_single = type == "Float32";
  while (!reader.at_end()) {
    values.push_back(real        ? reader.number()
                     : is_single ? reader.single()
                                 : static_cast<double>(reader.integer()));
  }
  const bool fit = std::ranges::all_of(values, [&](double value) { return fits(type, value); });
  if (!fit) fail("an array of type " + type + " with a value that does not fit it");
  return values;
}

std::vector<double> VtuText::array(const std::string& section, const std::string& name) const {
  std::vector<double> result;
  const XmlElement* arrays = at_most_one(*piece_, section);
  if (arrays == nullptr) return result;
  const std::string wanted = section == "Points" ? "3" : "1";
  const std::string what = "the array " + name + (name.empty() ? "" : " ") + "of " + section;
  bool found = false;
  for (const XmlElement& array : arrays->children) {
    const std::string called = array.value("Name");
    // It could be this one all the same.
    if (!name.empty() && called.empty()) fail("an array of " + section + " without a name");
    if (!name.empty() && called != name) continue;
    if (array.name != "DataArray") fail(what + " is an element " + array.name);
    if (std::exchange(found, true)) fail(what + " is there twice");
    const std::string components = array.value("NumberOfComponents");
    if (components != wanted && !(components.empty() && wanted == "1")) {
      fail(what + " has \"" + components + "\" components, not " + wanted);
    }
    if (section == "Cells" && array.value("type").starts_with("Float")) {
      fail(what + " is of numbers that are not integers");
    }
    result = values(array);
    const std::string tuples = array.value("NumberOfTuples");
    if (!tuples.empty() && tuples != std::to_string(result.size() / std::stoul(wanted))) {
      fail(what + " does not have " + tuples + " tuples");
    }
    const std::size_t size = section == "Points" ? 3 * points_ : cells_;
    if (name != "connectivity" && result.size() != size) {
      fail(what + " has " + std::to_string(result.size()) + " values, not " + std::to_string(size));
    }
  }
  return result;
}

// Names are field arrays of two integers, a number and a dimension; other arrays name nothing.
std::vector<const XmlElement*> VtuText::field_arrays() const {
  std::vector<const XmlElement*> arrays;
  for (const XmlElement* holder : {grid_, piece_}) {
    for (const XmlElement* field : holder->all("FieldData")) {
      for (const XmlElement* array : field->all("DataArray")) arrays.push_back(array);
    }
  }
  return arrays;
}

SetNames VtuText::names() const {
  SetNames names;
  for (const XmlElement* array : field_arrays()) {
    const std::string type = array->value("type");
    if (array->value("NumberOfTuples") != "2" ||
        (!type.starts_with("Int") && !type.starts_with("UInt"))) {
      continue;
    }
    const std::vector<double> told = values(*array);
    if (told.size() != 2 || (told[1] != 2 && told[1] != 3)) continue;
    if (!(std::fabs(told[0]) < 0x1p53)) continue;
    std::string& name = names[{static_cast<int>(told[1]), integer(told[0])}];
    name += (name.empty() ? "" : " and ") + array->value("Name");
  }
  return names;
}

double VtuText::planar_within() const {
  double result = 0;
  for (const XmlElement* array : field_arrays()) {
    if (array->value("Name") != "PlanarWithin") continue;
    const std::vector<double> told = values(*array);
    if (told.size() != 1 || !(told[0] > 0)) fail("PlanarWithin is not a positive number");
    if (std::exchange(result, told[0]) != 0) fail("PlanarWithin is there twice");
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
