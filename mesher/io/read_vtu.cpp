// VTK's XML for unstructured grids, as text ("ascii") or in base 64 ("binary"): points, tetrahedra,
// triangles, and the cell data that write_vtu writes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesher/io/binary.h"

#include "mesher/io/mesh_reading.h"

namespace delmesher::io {
namespace {

class VtuReader {
 public:
  VtuReader(std::string_view text, const std::string& path, Polling& polling, MeshBuilder& builder)
      : text_(text), path_(path), polling_(polling), builder_(builder) {}

  void read() {
    find_arrays();
    if (pieces_ != 1) fail(0, std::to_string(pieces_) + " pieces of a grid, not 1");
    read_points();
    read_cells();
  }

 private:
  enum class Kind : std::uint8_t { vertex = 1, line = 3, triangle = 5, tetrahedron = 10 };

  [[noreturn]] void fail(std::size_t offset, const std::string& reason) const {
    throw FileError{path_ + ":" + std::to_string(line_at(offset)) + ": " + reason};
  }
  std::uint64_t line_at(std::size_t offset) const {
    return 1 + static_cast<std::uint64_t>(std::count(
                   text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
  }

  // The value of an attribute of a tag, empty if it has none.
  static std::string_view attribute(std::string_view tag, std::string_view name) {
    const std::string start = " " + std::string(name) + "=\"";
    const std::size_t begin = tag.find(start);
    if (begin == std::string_view::npos) return {};
    const std::size_t value = begin + start.size(), end = tag.find('"', value);
    return end == std::string_view::npos ? std::string_view() : tag.substr(value, end - value);
  }

  // Where the arrays are: by the element that they are in, and their name.
  void find_arrays() {
    std::string section;
    bool found = false;
    for (std::size_t at = text_.find('<'); at != std::string_view::npos; at = text_.find('<', at)) {
      polling_.poll(64);
      const std::size_t end = text_.find('>', at);
      if (end == std::string_view::npos) fail(at, "an element without an end");
      const std::string_view tag = text_.substr(at + 1, end - at - 1);
      const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
      if (name == "VTKFile") {
        found = true;
        if (attribute(tag, "type") != "UnstructuredGrid") fail(at, "not an unstructured grid");
        if (!attribute(tag, "compressor").empty()) compressed_ = true;
        if (attribute(tag, "byte_order") == "BigEndian") big_endian_ = true;
        if (attribute(tag, "header_type") == "UInt64") header_size_ = sizeof(std::uint64_t);
      } else if (name == "Piece") {
        ++pieces_;
      } else if (name == "Points" || name == "Cells" || name == "CellData" || name == "PointData" ||
                 name == "FieldData") {
        section = name;
      } else if (name == "AppendedData") {
        fail(at, "appended data are not read: save as text (ascii) or in base 64 (binary)");
      } else if (name == "DataArray" && wanted(section, attribute(tag, "Name"))) {
        const bool binary = attribute(tag, "format") == "binary";
        if (!binary && attribute(tag, "format") != "ascii") {
          fail(at, "an array that is neither text (ascii) nor in base 64 (binary)");
        }
        if (binary && (compressed_ || big_endian_)) {
          fail(at, compressed_ ? "compressed data are not read: save as text (ascii)"
                               : "bytes in big-endian order are not read: save as text (ascii)");
        }
        const std::size_t close = text_.find('<', end);
        if (close == std::string_view::npos) fail(at, "an array without an end");
        const std::string key =
            section == "Points" ? section : section + " " + std::string(attribute(tag, "Name"));
        if (!arrays_.try_emplace(key, Array{end + 1, close, binary, attribute(tag, "type")})
                 .second) {
          fail(at, "a second array " + in_quotes(key));
        }
      }
      at = end;
    }
    if (!found) fail(0, "no VTKFile: not a file of VTK");
  }

  static bool wanted(std::string_view section, std::string_view name) {
    if (section == "Cells") return name == "connectivity" || name == "offsets" || name == "types";
    if (section == "CellData") {
      return name == "inside" || name == "label" || name == "facet" || name == "region";
    }
    return section == "Points";
  }

  struct Array {
    std::size_t begin, end;
    bool binary;
    std::string_view type;
  };
  MeshText text_of(const Array& array) const {
    return {text_.substr(array.begin, array.end - array.begin), path_, Comments::none, polling_,
            line_at(array.begin)};
  }

  // Calls take(value) with each number of an array in base 64, as its type has them.
  template <class Take>
  void each_number(const Array& array, const Take& take) const {
    if (array.type == "Float64") return each<double>(array, take);
    if (array.type == "Float32") return each<float>(array, take);
    if (array.type == "Int64") return each<std::int64_t>(array, take);
    if (array.type == "UInt64") return each<std::uint64_t>(array, take);
    if (array.type == "Int32") return each<std::int32_t>(array, take);
    if (array.type == "UInt32") return each<std::uint32_t>(array, take);
    if (array.type == "Int16") return each<std::int16_t>(array, take);
    if (array.type == "UInt16") return each<std::uint16_t>(array, take);
    if (array.type == "Int8") return each<std::int8_t>(array, take);
    if (array.type == "UInt8") return each<std::uint8_t>(array, take);
    fail(array.begin, "an array of type " + in_quotes(array.type));
  }
  template <class T, class Take>
  void each(const Array& array, const Take& take) const {
    const auto decoded = from_base64(text_.substr(array.begin, array.end - array.begin));
    if (!decoded) fail(array.begin, "an array that is not in base 64");
    std::string_view bytes = *decoded;
    if (bytes.size() < header_size_) fail(array.begin, "an array without its size");
    const std::uint64_t size = header_size_ == sizeof(std::uint64_t)
                                   ? number_from<std::uint64_t>(bytes)
                                   : number_from<std::uint32_t>(bytes);
    bytes.remove_prefix(header_size_);
    if (size != bytes.size() || size % sizeof(T) != 0) {
      fail(array.begin, "an array of " + std::to_string(bytes.size()) + " bytes, but " +
                            std::to_string(size) + " were announced");
    }
    for (; !bytes.empty(); bytes.remove_prefix(sizeof(T))) {
      polling_.poll(8);
      take(number_from<T>(bytes));
    }
  }

  template <class T>
  std::vector<T> numbers(const std::string& key, bool optional = false) const {
    const auto found = arrays_.find(key);
    if (found == arrays_.end()) {
      if (!optional) fail(0, "there is no array " + in_quotes(key));
      return {};
    }
    std::vector<T> values;
    if (found->second.binary) {
      each_number(found->second, [&](auto value) {
        using Value = decltype(value);
        if constexpr (std::is_floating_point_v<Value>) {
          fail(found->second.begin, in_quotes(key) + " is no array of integers");
        } else {
          if (!std::in_range<T>(value)) {
            fail(found->second.begin, "bad number '" + std::to_string(value) + "'");
          }
          values.push_back(static_cast<T>(value));
        }
      });
      return values;
    }
    MeshText in = text_of(found->second);
    for (auto token = in.word(); !token.empty(); token = in.word()) {
      values.push_back(in.parsed<T>(token, "number"));
    }
    return values;
  }

  void read_points() {
    const auto found = arrays_.find("Points");
    if (found == arrays_.end()) fail(0, "there are no points");
    if (found->second.binary) return read_binary_points(found->second);
    MeshText in = text_of(found->second);
    std::vector<double> x;
    for (auto token = in.word(); !token.empty(); token = in.word()) {
      x.push_back(in.finite(token));
      if (x.size() < 3) continue;
      if (builder_.vertices() >= kMostVertices) in.fail("too many points");
      builder_.add_vertex({x[0], x[1], x[2]});
      x.clear();
    }
    if (!x.empty()) in.fail("the last point has fewer than 3 coordinates");
  }

  void read_binary_points(const Array& array) {
    std::vector<double> x;
    each_number(array, [&](auto value) {
      x.push_back(static_cast<double>(value));
      if (!std::isfinite(x.back())) fail(array.begin, "non-finite coordinate");
      if (x.size() < 3) return;
      if (builder_.vertices() >= kMostVertices) fail(array.begin, "too many points");
      builder_.add_vertex({x[0], x[1], x[2]});
      x.clear();
    });
    if (!x.empty()) fail(array.begin, "the last point has fewer than 3 coordinates");
  }

  void read_cells() {
    const auto corners = numbers<std::uint64_t>("Cells connectivity");
    const auto offsets = numbers<std::uint64_t>("Cells offsets");
    const auto types = numbers<int>("Cells types");
    const auto inside = numbers<int>("CellData inside", true);
    const auto region = numbers<std::int32_t>("CellData region", true);
    const auto label = numbers<std::int32_t>("CellData label", true);
    const auto facet = numbers<std::int64_t>("CellData facet", true);
    const auto must_fit = [&](std::size_t size, const char* name) {
      if (size != 0 && size != types.size()) {
        fail(0, std::to_string(size) + " values of '" + name + "' for " +
                    std::to_string(types.size()) + " cells");
      }
    };
    if (offsets.size() != types.size()) {
      fail(0, std::to_string(offsets.size()) + " offsets for " + std::to_string(types.size()) +
                  " cells");
    }
    must_fit(inside.size(), "inside");
    must_fit(region.size(), "region");
    must_fit(label.size(), "label");
    must_fit(facet.size(), "facet");
    if (types.size() > kMostCells) fail(0, "too many cells");
    std::uint64_t begin = 0;
    for (std::size_t n = 0; n < types.size(); begin = offsets[n++]) {
      polling_.poll(8);
      const auto corner = [&](std::uint64_t i) {
        const std::uint64_t v = corners[begin + i];
        if (v >= builder_.vertices()) {
          fail(0, "cell " + std::to_string(n) + ": vertex index out of range: " +
                      std::to_string(v) + " of " + std::to_string(builder_.vertices()));
        }
        return static_cast<std::uint32_t>(v);
      };
      const auto kind = static_cast<Kind>(types[n]);
      const std::uint64_t size = kind == Kind::tetrahedron ? 4
                                 : kind == Kind::triangle  ? 3
                                 : kind == Kind::line      ? 2
                                 : kind == Kind::vertex    ? 1
                                                           : 0;
      if (types[n] < 0 || types[n] > 255 || size == 0) {
        fail(0, "cell " + std::to_string(n) + " is of type " + std::to_string(types[n]) +
                    ": a mesh of tetrahedra is expected");
      }
      if (offsets[n] > corners.size() || offsets[n] < begin || offsets[n] - begin != size) {
        fail(0, "cell " + std::to_string(n) + ": bad offset " + std::to_string(offsets[n]));
      }
      if (size == 4) {
        builder_.add_tetrahedron({corner(0), corner(1), corner(2), corner(3)},
                                 region.empty() ? std::nullopt : std::optional(region[n]),
                                 inside.empty() || inside[n] != 0);
      } else if (size == 3) {
        const bool is_facet = !facet.empty() && facet[n] >= 0 && facet[n] <= 0xffffffffLL;
        builder_.add_triangle(
            {corner(0), corner(1), corner(2)}, label.empty() ? 0 : label[n],
            is_facet ? std::optional(static_cast<std::uint32_t>(facet[n])) : std::nullopt);
      }
    }
  }

  std::string_view text_;
  std::string path_;
  Polling& polling_;
  MeshBuilder& builder_;
  std::uint64_t pieces_ = 0;
  bool compressed_ = false, big_endian_ = false;
  std::size_t header_size_ = sizeof(std::uint32_t);  // before each array in base 64
  std::map<std::string, Array> arrays_;
};

}  // namespace

void read_vtu(std::string_view text, const std::string& path, Polling& polling,
              MeshBuilder& builder) {
  VtuReader(text, path, polling, builder).read();
}

}  // namespace delmesher::io
