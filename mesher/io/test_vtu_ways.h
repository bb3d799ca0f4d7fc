// One grid in all the ways in which VTK writes arrays; zlib compresses them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <ostream>
#include <string>
#include <string_view>

#include "mesher/io/binary.h"
#include "mesher/io/test_zlib.h"

namespace delmesher::io {

enum class Place : std::uint8_t { in_base64, appended_raw, appended_in_base64 };

struct Way {
  const char* name;
  Place place;
  bool compressed, wide;  // wide: sizes of 8 bytes
};

// For GoogleTest.
inline void PrintTo(const Way& way, std::ostream* stream) {
  *stream << way.name;
}

inline std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t there = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < there ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k > there ? '=' : kDigits[group >> (18 - 6 * k) & 63U];
    }
  }
  return text;
}

class WayWriter {
 public:
  explicit WayWriter(const Way& way) : way_(way) {}

  template <class T>
  void array(const char* type, const char* name, std::initializer_list<T> values,
             const std::string& attributes = "") {
    std::string bytes;
    for (const T value : values) {
      for (const char c : bytes_of(value)) bytes += c;
    }
    const std::string stored = way_.compressed ? compressed(bytes) : plain(bytes);
    text_ += std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" ";
    text_ += attributes;
    if (way_.place == Place::in_base64) {
      text_ += "format=\"binary\">\n  " + stored + "\n</DataArray>\n";
    } else {
      text_ += "format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
      appended_ += stored;
    }
  }
  void text(const std::string& text) { text_ += text; }

  std::string finish() {
    const bool raw = way_.place == Place::appended_raw;
    text_ += "</CellData></Piece></UnstructuredGrid>\n";
    if (way_.place != Place::in_base64) {
      text_ += std::string("<AppendedData encoding=\"") + (raw ? "raw" : "base64") + "\">\n _" +
               appended_ + "\n</AppendedData>\n";
    }
    return text_ + "</VTKFile>\n";
  }

 private:
  std::string size(std::uint64_t n) const {
    std::string bytes;
    for (const char c : bytes_of(n)) bytes += c;
    return bytes.substr(0, way_.wide ? 8 : 4);
  }
  std::string encoded(const std::string& head, const std::string& bytes) const {
    return way_.place == Place::appended_raw ? head + bytes : base64(head) + base64(bytes);
  }
  std::string plain(const std::string& bytes) const {
    const std::string all = size(bytes.size()) + bytes;
    return way_.place == Place::appended_raw ? all : base64(all);
  }
  // In blocks of 32 bytes; the numbers before them are in base 64 of their own.
  std::string compressed(const std::string& bytes) const {
    constexpr std::size_t kBlock = 32;
    const std::size_t blocks = (bytes.size() + kBlock - 1) / kBlock;
    std::string head = size(blocks) + size(kBlock) + size(bytes.size() % kBlock), data;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::string packed = packed_by_zlib(bytes.substr(b * kBlock, kBlock), Wrapping::zlib);
      head += size(packed.size());
      data += packed;
    }
    return encoded(head, data);
  }

  const Way& way_;
  std::string text_, appended_;
};

// Two tetrahedra and a triangle with a name; arrays of no use are among them.
inline std::string grid(const Way& way) {
  WayWriter out(way);
  out.text("<?xml version=\"1.0\"?>\n<!-- <DataArray> > -->\n");
  out.text("<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\"");
  if (way.wide) out.text(" header_type=\"UInt64\"");
  if (way.compressed) out.text(" compressor=\"vtkZLibDataCompressor\"");
  out.text(">\n<UnstructuredGrid><FieldData>\n");
  out.array<std::int32_t>("Int32", "in &lt; out", {-7, 2}, "NumberOfTuples=\"2\" ");
  out.array<std::int32_t>("Int32", "a volume", {3, 3}, "NumberOfTuples=\"2\" ");
  out.array<std::int32_t>("Int32", "cycles", {1, 2, 3}, "NumberOfTuples=\"3\" ");
  out.array<double>("Float64", "times", {1, 2}, "NumberOfTuples=\"2\" ");
  out.text("</FieldData><Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">\n<PointData>\n");
  out.array<float>("Float32", "label", {1, 2, 3, 4, 5});
  out.text("</PointData><Points>\n");
  out.array<double>("Float64", "Points",
                    {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.1, 0.2, 1e300, -0.0, 1e-320, -1.25},
                    "NumberOfComponents=\"3\" ");
  out.text("</Points><Cells>\n");
  out.array<std::int64_t>("Int64", "connectivity", {0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2});
  out.array<std::uint32_t>("UInt32", "offsets", {4, 8, 11});
  out.array<std::uint8_t>("UInt8", "types", {10, 10, 5});
  out.text("</Cells><CellData>\n");
  out.array<float>("Float32", "region", {3, -4, 0});
  out.array<std::int16_t>("Int16", "label", {0, 0, -7});
  return out.finish();
}

inline constexpr Way kWays[] = {
    {"Base64", Place::in_base64, false, false},
    {"Base64Wide", Place::in_base64, false, true},
    {"Base64Compressed", Place::in_base64, true, false},
    {"Base64CompressedWide", Place::in_base64, true, true},
    {"Raw", Place::appended_raw, false, false},
    {"RawWide", Place::appended_raw, false, true},
    {"RawCompressed", Place::appended_raw, true, false},
    {"RawCompressedWide", Place::appended_raw, true, true},
    {"AppendedBase64", Place::appended_in_base64, false, true},
    {"AppendedBase64Compressed", Place::appended_in_base64, true, false}};

}  // namespace delmesher::io
