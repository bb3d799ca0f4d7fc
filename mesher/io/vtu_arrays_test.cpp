// One grid in all the ways in which VTK writes arrays; zlib compresses them.
#include "mesher/io/vtu_arrays.h"

#include <gtest/gtest.h>

#include "mesher/io/read_mesh.h"
#include "mesher/io/test_vtu_ways.h"

namespace delmesher::io {
namespace {

class Ways : public testing::TestWithParam<Way> {};

TEST_P(Ways, AreReadAsTheSameGrid) {
  const MeshReadResult read = parse_mesh(grid(GetParam()), "a.vtu");
  ASSERT_TRUE(read.ok()) << read.error;
  EXPECT_EQ(read.mesh.vertices,
            (std::vector<std::array<double, 3>>{
                {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 1e300}, {-0.0, 1e-320, -1.25}}));
  EXPECT_EQ(read.mesh.tetrahedra,
            (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 2, 3}, {0, 2, 1, 4}}));
  EXPECT_EQ(read.mesh.regions, (std::vector<std::int32_t>{3, -4}));
  EXPECT_EQ(read.mesh.boundary_labels, (std::vector<std::int32_t>{-7}));
  EXPECT_EQ(read.names, (LabelNames{{-7, "in < out"}}));
}

// Cut anywhere or with a byte changed: refused in one line, or a grid whose indices are in range.
TEST_P(Ways, AreRefusedInOneLineWhenDamaged) {
  const std::string all = grid(GetParam());
  std::size_t refused = 0;
  for (std::size_t at = 0; at < all.size(); ++at) {
    std::string changed = all;
    changed[at] = static_cast<char>(changed[at] ^ (at % 2 == 0 ? 1 : 64));
    for (const std::string& bytes : {all.substr(0, at), changed}) {
      const MeshReadResult read = parse_mesh(bytes, "a.vtu");
      refused += read.ok() ? 0 : 1;
      EXPECT_EQ(read.ok(), read.error.empty());
      EXPECT_EQ(read.error.find_first_of("\r\n"), std::string::npos);
      for (const auto& t : read.mesh.tetrahedra) {
        for (const std::uint32_t v : t) EXPECT_LT(v, read.mesh.vertices.size());
      }
    }
  }
  EXPECT_GT(refused, all.size());
}

INSTANTIATE_TEST_SUITE_P(Vtu, Ways, testing::ValuesIn(kWays),
                         [](const auto& way) { return std::string(way.param.name); });

std::string error_of(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return parse_mesh(text, "a.vtu").error;
}

TEST(Vtu, SaysWhatIsNotReadAndWhere) {
  const std::string packed = grid(kWays[2]), raw = grid(kWays[4]);
  EXPECT_EQ(error_of(packed, "vtkZLib", "vtkLZ4"),
            "a.vtu:5: data compressed with 'vtkLZ4DataCompressor' are not read: save without "
            "compression, or with zlib");
  EXPECT_EQ(error_of(packed, "LittleEndian", "BigEndian"),
            "a.vtu:5: bytes in big-endian order are not read: save as text (ascii)");
  EXPECT_EQ(error_of(raw, "offset=\"84\"", "offset=\"99999\""),
            "a.vtu:13: the appended data end before the offset of 'Points'");
  EXPECT_EQ(error_of(raw, "offset=\"84\"", "offset=\"83\""),
            "a.vtu:13: an array of 121 bytes, but 30784 were announced");
  EXPECT_EQ(error_of(raw, "offset=\"84\"", ""), "a.vtu:13: an array without its offset");
  EXPECT_EQ(error_of(raw, "\n _", "\n "), "a.vtu:22: appended data do not begin with '_'");
  EXPECT_EQ(error_of(raw, "\"Int16\"", "\"Float64\""), "a.vtu:20: an array of half a number");
  std::string other = grid(kWays[5]);
  other.replace(other.find("Float32", other.find("region") - 30), 7, "Int32  ");
  EXPECT_EQ(parse_mesh(other, "a.vtu").error, "a.vtu:19: an array of type 'Int32  '");
}

// Just above the middle of two floats: as a double it is the middle, which is rounded to even.
TEST(Vtu, FloatsInTextAreNotRoundedTwice) {
  const auto text = [](const char* type) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
           "NumberOfCells=\"1\"><Points><DataArray type=\"" +
           std::string(type) +
           "\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 +1.000000059604644775390626 0 0 0 "
           "0.1 "
           "0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
           "format=\"ascii\">0 1 2 3</DataArray><DataArray type=\"Int64\" Name=\"offsets\" "
           "format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
           "format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>";
  };
  const MeshReadResult single = parse_mesh(text("Float32"), "a.vtu");
  ASSERT_TRUE(single.ok()) << single.error;
  EXPECT_EQ(single.mesh.vertices[1][0], 0x1.000002p0);
  EXPECT_EQ(single.mesh.vertices[2][1], static_cast<double>(0.1F));
  const MeshReadResult wide = parse_mesh(text("Float64"), "a.vtu");
  ASSERT_TRUE(wide.ok()) << wide.error;
  EXPECT_EQ(wide.mesh.vertices[1][0], 0x1.000001p0);
  EXPECT_EQ(wide.mesh.vertices[2][1], 0.1);
  EXPECT_NE(error_of(text("Float32"), "0.1", "1e39").find("non-finite number '1e39'"),
            std::string::npos);
}

TEST(Vtu, WhatOthersReadInAnotherWayIsRefused) {
  const std::string all = grid(kWays[1]);
  EXPECT_EQ(error_of(all, "\"UInt64\"", "\"UInt16\""),
            "a.vtu:3: sizes of arrays as 'UInt16' are not read");
  EXPECT_NE(
      error_of(all, "Name=\"Points\"", "Name=\"Points\" TimeStep=\"0\"").find("steps in time"),
      std::string::npos);
}

TEST(Vtu, NamesAreInTheEncodingThatIsDeclared) {
  const auto name_of = [](const std::string& declared, const std::string& name) {
    std::string text = grid(kWays[0]);
    text.replace(text.find("in &lt; out"), 11, name);
    text.replace(text.find("\"1.0\""), 5, "\"1.0\"" + declared);
    const MeshReadResult read = parse_mesh(text, "a.vtu");
    return read.ok() ? read.names.at(-7) : read.error;
  };
  EXPECT_EQ(name_of("", "\xc3\xbc"), "\xc3\xbc");
  EXPECT_EQ(name_of(" encoding='utf-8'", "\xc3\xbc"), "\xc3\xbc");
  EXPECT_EQ(name_of(" encoding=\"ISO-8859-1\"", "\xc3\xbc&#xfc;"), "\xc3\x83\xc2\xbc\xc3\xbc");
  EXPECT_EQ(name_of(" encoding=\"koi8-r\"", "a"),
            "a.vtu:1: text in 'koi8-r' is not read: save it as UTF-8");
  EXPECT_EQ(name_of("", "&#xfffe;"), "&#xfffe;");
}

TEST(Vtu, ABlockThatIsDamagedIsRefused) {
  const std::string packed = grid(kWays[6]);
  const std::string mark = "offset=\"";
  const std::size_t offset = packed.find(mark, packed.find("Name=\"Points\"")) + mark.size();
  // Four blocks of points, behind seven numbers of four bytes.
  const std::size_t block =
      packed.find("\n _") + 3 + std::stoul(packed.substr(offset)) + std::size_t{7} * 4;
  for (const std::size_t at : {block, block + 5}) {
    std::string changed = packed;
    changed[at] = static_cast<char>(changed[at] ^ 4);
    const std::string error = parse_mesh(changed, "a.vtu").error;
    EXPECT_TRUE(error.starts_with("a.vtu:13: an array that cannot be unpacked: ")) << error;
  }
}

}  // namespace
}  // namespace delmesher::io
