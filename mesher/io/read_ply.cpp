// PLY (Turk), ASCII and binary of both byte orders: any elements and properties; of them the
// vertices' x, y, z, the faces' vertex_indices (vertex_index) and a label of the faces are used.
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "mesher/io/readers.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64, none };
enum class Encoding : std::uint8_t { ascii, little, big };

constexpr std::array<std::size_t, 8> kSize = {1, 1, 2, 2, 4, 4, 4, 8};

Scalar scalar_of(std::string_view name) {
  static constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {
      {{"char", "int8"},
       {"uchar", "uint8"},
       {"short", "int16"},
       {"ushort", "uint16"},
       {"int", "int32"},
       {"uint", "uint32"},
       {"float", "float32"},
       {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Scalar>(i);
  }
  return Scalar::none;
}

struct Property {
  std::string name;
  Scalar count_type = Scalar::none;  // of a list
  Scalar type = Scalar::none;
  bool is_list() const { return count_type != Scalar::none; }
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  Position position;

  std::size_t find(std::initializer_list<std::string_view> names, bool list) const {
    for (std::string_view wanted : names) {
      for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name == wanted && properties[i].is_list() == list) return i;
      }
    }
    return kNotFound;
  }
  // The fewest bytes that one such element takes.
  std::uint64_t least_bytes(Encoding encoding) const {
    std::uint64_t bytes = 0;
    for (const Property& p : properties) {
      const Scalar type = p.is_list() ? p.count_type : p.type;
      bytes += encoding == Encoding::ascii ? 2 : kSize[static_cast<std::size_t>(type)];
    }
    return bytes;
  }
  static constexpr std::size_t kNotFound = std::numeric_limits<std::size_t>::max();
};

class PlyReader {
 public:
  PlyReader(std::string_view data, SurfaceBuilder& builder)
      : data_(data), in_(data, Comments::none), builder_(builder) {}

  void read();

 private:
  Position line() const { return at_line(in_.line()); }
  Position here() const { return encoding_ == Encoding::ascii ? line() : at_byte(offset_); }
  std::uint64_t remaining() const {
    return encoding_ == Encoding::ascii ? in_.remaining() : data_.size() - offset_;
  }

  std::string_view need_word(const char* what);
  void read_header();
  void read_format();
  void read_element();
  void read_property();
  std::size_t body_offset() const;

  double read_scalar(Scalar type);
  std::uint64_t read_list_size(const Property& property);
  void read_values(const Element& element, std::size_t list, std::vector<double>& scalars,
                   std::vector<double>& values);
  void read_vertices(const Element& element);
  void read_faces(const Element& element);
  void skip(const Element& element);

  std::string_view data_;
  TextLines in_;
  std::size_t offset_ = 0;
  Encoding encoding_ = Encoding::ascii;
  SurfaceBuilder& builder_;
  std::vector<Element> elements_;
};

std::string_view PlyReader::need_word(const char* what) {
  std::string_view token;
  if (!in_.next_token(token)) fail(line(), std::string(what) + " is missing");
  return token;
}

void PlyReader::read_format() {
  const std::string_view name = need_word("the format");
  if (name == "ascii") {
    encoding_ = Encoding::ascii;
  } else if (name == "binary_little_endian") {
    encoding_ = Encoding::little;
  } else if (name == "binary_big_endian") {
    encoding_ = Encoding::big;
  } else {
    fail(line(), "unknown format " + in_quotes(name));
  }
}

void PlyReader::read_element() {
  Element element;
  element.name = need_word("the element's name");
  const std::string_view count = need_word("the element's count");
  if (!parse_integer(count, element.count)) fail(line(), "bad count " + in_quotes(count));
  element.position = line();
  elements_.push_back(std::move(element));
}

void PlyReader::read_property() {
  if (elements_.empty()) fail(line(), "a property before any element");
  Property property;
  std::string_view type = need_word("the property's type");
  if (type == "list") {
    const std::string_view count_type = need_word("the list's count type");
    property.count_type = scalar_of(count_type);
    if (property.count_type >= Scalar::f32) {
      fail(line(), "bad list count type " + in_quotes(count_type));
    }
    type = need_word("the list's type");
  }
  property.type = scalar_of(type);
  if (property.type == Scalar::none) fail(line(), "unknown type " + in_quotes(type));
  property.name = need_word("the property's name");
  elements_.back().properties.push_back(std::move(property));
}

void PlyReader::read_header() {
  std::string_view keyword;
  if (!in_.next_line() || !in_.next_token(keyword) || keyword != "ply") {
    fail(line(), "a PLY file begins with 'ply'");
  }
  bool format = false;
  while (in_.next_line()) {
    in_.next_token(keyword);
    if (keyword == "format") {
      read_format();
      format = true;
    } else if (keyword == "element") {
      read_element();
    } else if (keyword == "property") {
      read_property();
    } else if (keyword == "end_header") {
      if (!format) fail(line(), "the header names no format");
      return;
    } else if (keyword != "comment" && keyword != "obj_info") {
      fail(line(), "unexpected " + in_quotes(keyword) + " in the header");
    }
  }
  fail(line(), "the file ends in the header");
}

// A binary body may begin with the byte of a line feed, so the header's first line shows how its
// lines end.
std::size_t PlyReader::body_offset() const {
  const std::size_t first = data_.find_first_of("\r\n");
  const bool cr_only = data_[first] == '\r' && data_.substr(first, 2) != "\r\n";
  const std::size_t end = in_.next_offset();
  const bool took_line_feed = end >= 2 && data_.substr(end - 2, 2) == "\r\n";
  return cr_only && took_line_feed ? end - 1 : end;
}

double PlyReader::read_scalar(Scalar type) {
  if (encoding_ == Encoding::ascii) {
    std::string_view token;
    if (!in_.next_token_anywhere(token)) fail(line(), "the file ends before its last element");
    double value = 0;
    if (parse_double(token, value) == NumberStatus::malformed) {
      fail(line(), "bad number " + in_quotes(token));
    }
    return value;
  }
  const std::size_t size = kSize[static_cast<std::size_t>(type)];
  if (data_.size() - offset_ < size) {
    fail(at_byte(data_.size()), "the file ends before its last element");
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t at = encoding_ == Encoding::big ? i : size - 1 - i;
    bits = bits << 8 | static_cast<unsigned char>(data_[offset_ + at]);
  }
  offset_ += size;
  switch (type) {
    case Scalar::i8:
      return static_cast<std::int8_t>(bits);
    case Scalar::i16:
      return static_cast<std::int16_t>(bits);
    case Scalar::i32:
      return static_cast<std::int32_t>(bits);
    case Scalar::f32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    case Scalar::f64:
      return std::bit_cast<double>(bits);
    default:
      return static_cast<double>(bits);
  }
}

std::uint64_t PlyReader::read_list_size(const Property& property) {
  const Position position = here();
  const double size = read_scalar(property.count_type);
  if (!(size >= 0) || size != std::floor(size)) fail(position, "bad list length");
  const std::size_t bytes =
      encoding_ == Encoding::ascii ? 2 : kSize[static_cast<std::size_t>(property.type)];
  // The current line's rest is not in remaining(); a list there is bounded by reading it.
  if (encoding_ != Encoding::ascii && size > static_cast<double>(remaining() / bytes)) {
    fail(position, "the file is too short for a list of that length");
  }
  if (size > 4294967295.0) fail(position, "bad list length");
  return static_cast<std::uint64_t>(size);
}

// Reads one element: its scalars by property, and the list property number `list`.
void PlyReader::read_values(const Element& element, std::size_t list, std::vector<double>& scalars,
                            std::vector<double>& values) {
  scalars.resize(element.properties.size());
  values.clear();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const Property& property = element.properties[i];
    if (!property.is_list()) {
      scalars[i] = read_scalar(property.type);
      continue;
    }
    const std::uint64_t size = read_list_size(property);
    for (std::uint64_t k = 0; k < size; ++k) {
      const double value = read_scalar(property.type);
      if (i == list) values.push_back(value);
    }
  }
}

void PlyReader::skip(const Element& element) {
  if (element.properties.empty()) return;
  std::vector<double> scalars, values;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    read_values(element, Element::kNotFound, scalars, values);
  }
}

void PlyReader::read_vertices(const Element& element) {
  std::array<std::size_t, 3> axes;
  for (std::size_t k = 0; k < 3; ++k) {
    static constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
    axes[k] = element.find({kNames[k]}, false);
    if (axes[k] == Element::kNotFound) {
      fail(element.position, "the vertices have no property " + in_quotes(kNames[k]));
    }
  }
  std::vector<double> scalars, values;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    const Position position = here();
    read_values(element, Element::kNotFound, scalars, values);
    builder_.add_vertex(scalars[axes[0]], scalars[axes[1]], scalars[axes[2]],
                        encoding_ == Encoding::ascii ? line() : position);
  }
}

void PlyReader::read_faces(const Element& element) {
  const std::size_t list = element.find({"vertex_indices", "vertex_index"}, true);
  if (list == Element::kNotFound) {
    fail(element.position, "the faces have no list 'vertex_indices'");
  }
  const std::size_t label = element.find(
      {"label", "region", "marker", "group", "attribute", "material_index", "physical"}, false);
  if (label != Element::kNotFound) {
    builder_.note("labels from the property " + io::in_quotes(element.properties[label].name));
  }
  std::vector<double> scalars, values;
  std::vector<std::uint32_t> corners;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Position position = here();
    read_values(element, list, scalars, values);
    if (encoding_ == Encoding::ascii) position = line();
    corners.clear();
    for (double value : values) {
      if (!(value >= 0) || value != std::floor(value) ||
          value > static_cast<double>(kMaxVertices)) {
        fail(position, "bad vertex index");
      }
      corners.push_back(static_cast<std::uint32_t>(value));
    }
    std::int32_t number = 0;
    if (label != Element::kNotFound) {
      const double value = scalars[label];
      if (!(value >= -2147483648.0 && value <= 2147483647.0) || value != std::floor(value)) {
        fail(position, "a label that is not a 32-bit integer");
      }
      number = static_cast<std::int32_t>(value);
    }
    builder_.add_polygon(corners, number, position);
  }
}

void PlyReader::read() {
  read_header();
  offset_ = body_offset();
  const Element* vertices = nullptr;
  const Element* faces = nullptr;
  for (const Element& element : elements_) {
    if (element.name == "vertex" && vertices == nullptr) vertices = &element;
    if (element.name == "face" && faces == nullptr) faces = &element;
    if (element.name == "tristrips") fail(element.position, "triangle strips are not supported");
    const std::uint64_t least = element.least_bytes(encoding_);
    if (least > 0 && element.count > remaining() / least + 1) {
      fail(element.position, "the file is too short for " + std::to_string(element.count) +
                                 " elements " + io::in_quotes(element.name));
    }
  }
  if (vertices == nullptr) fail(line(), "no element 'vertex'");
  if (faces == nullptr) fail(line(), "no element 'face'");
  builder_.expect(vertices->count, faces->count, remaining());
  for (const Element& element : elements_) {
    if (&element == vertices) {
      read_vertices(element);
    } else if (&element == faces) {
      read_faces(element);
    } else {
      skip(element);
    }
  }
  std::string_view token;
  const bool more =
      encoding_ == Encoding::ascii ? in_.next_token_anywhere(token) : offset_ < data_.size();
  if (more) builder_.warn("data after the last element ignored");
}

}  // namespace

bool looks_like_ply(std::string_view data) {
  if (data.starts_with("\xEF\xBB\xBF")) data.remove_prefix(3);
  return data.starts_with("ply\n") || data.starts_with("ply\r");
}

void read_ply(std::string_view data, SurfaceBuilder& builder) {
  PlyReader(data, builder).read();
}

}  // namespace delmesher::io
