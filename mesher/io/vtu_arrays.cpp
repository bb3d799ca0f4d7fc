#include "mesher/io/vtu_arrays.h"

#include <algorithm>

#include "mesher/io/inflate.h"

namespace delmesher::io {
namespace {

constexpr std::string_view kZlib = "vtkZLibDataCompressor";

std::string_view value_of(const XmlTags& tags, std::string_view name) {
  return tags.attribute(name).value_or(std::string_view());
}

bool wanted(std::string_view section, std::string_view name) {
  if (section == "Cells") return name == "connectivity" || name == "offsets" || name == "types";
  if (section == "CellData") {
    return name == "inside" || name == "label" || name == "facet" || name == "region";
  }
  return section == "Points";
}

bool has_two_integers(const XmlTags& tags) {
  const std::string_view type = value_of(tags, "type");
  return (type.starts_with("Int") || type.starts_with("UInt")) &&
         value_of(tags, "NumberOfTuples") == "2";
}

}  // namespace

VtuArrays::VtuArrays(std::string_view text, Polling& polling) : text_(text), polling_(polling) {
  const std::string_view encoding = xml_encoding(text);
  in_latin1_ = equal_ignoring_case(encoding, "ISO-8859-1");
  if (!in_latin1_ && !encoding.empty() && !equal_ignoring_case(encoding, "UTF-8") &&
      !equal_ignoring_case(encoding, "US-ASCII")) {
    fail_at_line(1, "text in " + in_quotes(encoding) + " is not read: save it as UTF-8");
  }
  XmlTags tags(text, polling);
  std::string section;
  std::uint64_t pieces = 0;
  bool found = false;
  while (tags.next()) {
    const std::string_view name = tags.name();
    if (!tags.begins()) continue;
    if (name == "VTKFile") {
      found = true;
      read_file_tag(tags);
    } else if (name == "Piece") {
      ++pieces;
    } else if (name == "Points" || name == "Cells" || name == "CellData" || name == "PointData" ||
               name == "FieldData") {
      section = name;
    } else if (name == "DataArray") {
      read_array_tag(tags, section);
    } else if (name == "AppendedData") {
      find_appended(tags);
      break;  // what follows need not be text
    }
  }
  if (!found) fail_at_line(1, "no VTKFile: not a file of VTK");
  if (pieces != 1) fail_at_line(1, std::to_string(pieces) + " pieces of a grid, not 1");
  divide_appended();
}

void VtuArrays::read_file_tag(const XmlTags& tags) {
  if (value_of(tags, "type") != "UnstructuredGrid") tags.fail("not an unstructured grid");
  compressor_ = value_of(tags, "compressor");
  big_endian_ = value_of(tags, "byte_order") == "BigEndian";
  const std::string_view header = value_of(tags, "header_type");
  if (!header.empty() && header != "UInt32" && header != "UInt64") {
    tags.fail("sizes of arrays as " + in_quotes(header) + " are not read");
  }
  if (header == "UInt64") header_size_ = sizeof(std::uint64_t);
}

void VtuArrays::read_array_tag(const XmlTags& tags, const std::string& section) {
  const std::string_view format = value_of(tags, "format"), name = value_of(tags, "Name");
  if (tags.attribute("TimeStep")) tags.fail("arrays of steps in time are not read");
  Array array;
  array.line = tags.line_at(tags.begin());
  array.type = value_of(tags, "type");
  array.text = tags.ends() ? std::string_view() : tags.text_after();
  array.binary = format == "binary";
  if (format == "appended") {
    std::uint64_t offset = 0;
    if (!parse_integer(value_of(tags, "offset"), offset)) tags.fail("an array without its offset");
    array.offset = offset;
    offsets_.push_back(offset);
  }
  const bool field = section == "FieldData" && has_two_integers(tags);
  if (!field && !wanted(section, name)) return;
  if (format != "ascii" && !array.binary && !array.offset) {
    tags.fail("an array that is neither text (ascii) nor bytes (binary, appended)");
  }
  if (format != "ascii" && big_endian_) {
    tags.fail("bytes in big-endian order are not read: save as text (ascii)");
  }
  if (format != "ascii" && !compressor_.empty() && compressor_ != kZlib) {
    tags.fail("data compressed with " + in_quotes(compressor_) +
              " are not read: save without compression, or with zlib");
  }
  if (field) {
    fields_.emplace_back(xml_text(in_latin1_ ? latin1_in_utf8(name) : name), std::move(array));
    return;
  }
  const std::string key = section == "Points" ? section : section + " " + std::string(name);
  if (!arrays_.try_emplace(key, std::move(array)).second) {
    tags.fail("a second array " + in_quotes(key));
  }
}

void VtuArrays::find_appended(const XmlTags& tags) {
  appended_in_base64_ = value_of(tags, "encoding") == "base64";
  const std::size_t begin = text_.find('_', tags.end());
  if (begin == std::string_view::npos) tags.fail("appended data do not begin with '_'");
  appended_ = text_.substr(begin + 1);
  // Bytes may look like tags; the arrays say themselves how many they have.
  if (appended_in_base64_) appended_ = appended_.substr(0, appended_.find('<'));
}

// Each array reaches to the next one; offsets count from the '_'.
void VtuArrays::divide_appended() {
  std::sort(offsets_.begin(), offsets_.end());
  const auto take = [&](const std::string& key, Array& array) {
    if (!array.offset) return;
    if (*array.offset >= appended_.size()) {
      fail_at_line(array.line, "the appended data end before the offset of " + in_quotes(key));
    }
    const auto next = std::upper_bound(offsets_.begin(), offsets_.end(), *array.offset);
    array.text = appended_.substr(*array.offset);
    if (next != offsets_.end()) array.text = array.text.substr(0, *next - *array.offset);
  };
  for (auto& [key, array] : arrays_) take(key, array);
  for (auto& [name, array] : fields_) take(name, array);
}

std::uint64_t VtuArrays::line_of(const std::string& key) const {
  const auto found = arrays_.find(key);
  return found == arrays_.end() ? 1 : found->second.line;
}

VtuArrays::Bytes VtuArrays::stored(const Array& array) const {
  if (array.offset && !appended_in_base64_) return {{}, array.text, false};
  polling_.poll(array.text.size());
  auto decoded = from_base64(array.text, true);
  if (!decoded) fail_at_line(array.line, "an array that is not in base 64");
  return {std::move(*decoded), {}, true};
}

std::uint64_t VtuArrays::take_size(const Array& array, std::string_view& bytes) const {
  if (bytes.size() < header_size_) fail_at_line(array.line, "an array without its size");
  const std::uint64_t size = header_size_ == sizeof(std::uint64_t)
                                 ? number_from<std::uint64_t>(bytes)
                                 : number_from<std::uint32_t>(bytes);
  bytes.remove_prefix(header_size_);
  return size;
}

VtuArrays::Bytes VtuArrays::bytes_of(const Array& array) const {
  Bytes bytes = stored(array);
  std::string_view rest = bytes.all();
  if (!compressor_.empty()) return {uncompressed(array, rest), {}, true};
  const std::uint64_t size = take_size(array, rest);
  // Between appended arrays there may be something else.
  if (array.offset ? rest.size() < size : rest.size() != size) {
    fail_at_line(array.line, "an array of " + std::to_string(rest.size()) + " bytes, but " +
                                 std::to_string(size) + " were announced");
  }
  rest = rest.substr(0, size);
  if (!bytes.are_made) return {{}, rest, false};
  bytes.made.erase(0, header_size_);
  bytes.made.resize(size);
  return bytes;
}

// First the number of blocks, their size, that of the last one if it is smaller, and the sizes
// that they have here.
std::string VtuArrays::uncompressed(const Array& array, std::string_view bytes) const {
  const std::uint64_t blocks = take_size(array, bytes);
  const std::uint64_t size = take_size(array, bytes), last = take_size(array, bytes);
  if (blocks > bytes.size() / header_size_) fail_at_line(array.line, "an array without its blocks");
  std::string_view sizes = bytes.substr(0, blocks * header_size_);
  bytes.remove_prefix(sizes.size());
  std::string out;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t packed = take_size(array, sizes);
    const std::uint64_t wanted = b + 1 == blocks && last > 0 ? last : size;
    if (packed > bytes.size()) fail_at_line(array.line, "an array that ends in its blocks");
    std::string block;
    try {
      block =
          unpacked(bytes.substr(0, packed), Wrapping::zlib, kMaxFileBytes - out.size(), polling_);
    } catch (const ParseError& error) {
      fail_at_line(array.line, "an array that cannot be unpacked: " + error.reason);
    }
    if (block.size() != wanted) {
      fail_at_line(array.line, "a block of " + std::to_string(block.size()) + " bytes, but " +
                                   std::to_string(wanted) + " were announced");
    }
    out += block;
    bytes.remove_prefix(packed);
  }
  return out;
}

}  // namespace delmesher::io
