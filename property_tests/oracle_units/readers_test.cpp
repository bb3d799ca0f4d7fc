// The readers of the oracles: text by words, STL, PLY.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "mesher/io/test_zlib.h"
#include "oracles/base/text_reader.h"
#include "oracles/files/mesh_file.h"
#include "oracles/files/polygon.h"
#include "oracles/files/set_names.h"
#include "oracles/files/surface_file.h"
#include "oracles/files/vtu_text.h"
#include "oracles/verdict/edge_sizes.h"
#include "property_tests/little_memory.h"
#include "property_tests/oracle_units/helpers.h"

namespace tetproof {
namespace {

using namespace oracles;  // NOLINT
using delmesher::io::packed_by_zlib;
using delmesher::io::Wrapping;

// The smallest size may be in the middle of an edge.
TEST(SizeFields, LimitAnEdgeWhereItIsNearest) {
  const EdgeSizes sizes({{{0, 0, 0}, 0.125}}, 0.25);
  EXPECT_DOUBLE_EQ(sizes.excess({-1, 0, 0}, {1, 0, 0}), 2 / 0.125);
  EXPECT_DOUBLE_EQ(sizes.excess({-1, 1, 0}, {3, 1, 0}), 4 / 0.375);
  EXPECT_DOUBLE_EQ(sizes.excess({1, 0, 0}, {3, 0, 0}), 2 / 0.375);
}

TEST(Points, AreReadAsTheMesherReadsThem) {
  std::vector<Position> points;
  EXPECT_EQ(read_points(written("points.txt", "x y z\n1,2,3\n4 5 +.5 # here\n"), points), "");
  EXPECT_EQ(points, (std::vector<Position>{{1, 2, 3}, {4, 5, 0.5}}));
  for (const char* text : {"1 2\n", "1 2 3 4\n", "# none\n", "1 2 inf\n"}) {
    EXPECT_NE(read_points(written("points.txt", text), points), "") << text;
  }
}

// What `mesh` takes as a size field, the verification takes, with the same sources.
TEST(SizeFields, AreReadAsTheMesherReadsThem) {
  using Sources = std::vector<std::array<double, 4>>;
  const auto read = [](const std::string& text) {
    std::vector<delmesher::SizeSource> sources;
    const std::string why = read_size_field(written("sizes.txt", text), sources);
    EXPECT_EQ(why, "") << text;
    Sources all;
    for (const auto& [at, size] : sources) all.push_back({at[0], at[1], at[2], size});
    return all;
  };
  const Sources one = {{1, 2, 3, 0.5}}, two = {{1, 2, 3, 0.5}, {4, 5, 6, 1}};
  for (const char* text :
       {"1 2 3 0.5\n4 5 6 1\n", "1 2 3 0.5\r4 5 6 1\r", "1,2,3,0.5\r\n4,5,6,1\r\n",
        "\xef\xbb\xbf"
        "1 2 3 0.5\n4 5 6 1",
        "x y z h\n1 2 3 0.5\n4 5 6 1\n", "+1 +2 +3 +.5\n4 5 6 1 # here\n",
        "View \"a\" {SP(1,2,3){0.5};};View \"b (2) {\" {SP(4,5,6){1};};",
        "View \"a\" { // was (7,8,9){1}\nSP(1,2,3){0.5};\nSP(4,5,6){1, 2};};"}) {
    EXPECT_EQ(read(text), two) << text;
  }
  for (const char* text : {"Viewed y z h\n1 2 3 0.5\n", "View \"a{(1,2,3){4}\" {SP(1,2,3){0.5};};",
                           "View \"a\" // {(9,9,9){9}\n{SP(1,2,3){0.5};};"}) {
    EXPECT_EQ(read(text), one) << text;
  }
  EXPECT_EQ(read("1e-400 2 3 0.5\n"), (Sources{{0, 2, 3, 0.5}}));
}

// In version 2.2 every element has a group, and 0 stands for none; then its entity tells.
TEST(GmshText, AGroupOfZeroIsNone) {
  const auto read = [](const std::string& triangle, const std::string& tetrahedron) {
    return read_mesh(written(
        "zero.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
        "$EndNodes\n$Elements\n2\n1 2 2 " +
            triangle + " 1 3 2\n2 4 2 " + tetrahedron + " 1 2 3 4\n$EndElements\n"));
  };
  const MeshFile none = read("0 6", "0 9"), some = read("5 6", "8 9");
  EXPECT_EQ(none.labels, std::vector<std::int32_t>{6});
  EXPECT_EQ(none.regions, std::vector<std::int64_t>{9});
  EXPECT_EQ(some.labels, std::vector<std::int32_t>{5});
  EXPECT_EQ(some.regions, std::vector<std::int64_t>{8});
}

// The smallest boxes of a triangle and of the tetrahedron on it, then larger and smaller ones.
TEST(GmshText, BoxesAreThoseOfTheElements) {
  const auto differ = [](const std::string& surface, const std::string& volume) {
    return read_mesh(written("boxes.msh",
                             "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 1\n3 " +
                                 surface + " 0 0\n4 " + volume +
                                 " 0 0\n$EndEntities\n$Nodes\n1 4 1 4\n3 4 0 4\n1\n2\n3\n4\n"
                                 "0 0 0\n1 0 0\n0 1 0\n0 0 5\n$EndNodes\n$Elements\n2 2 1 2\n"
                                 "2 3 2 1\n1 1 3 2\n3 4 4 1\n2 1 2 3 4\n$EndElements\n"))
        .boxes_differ;
  };
  EXPECT_FALSE(differ("0 0 0 1 1 0", "0 0 0 1 1 5"));
  EXPECT_TRUE(differ("0 0 0 1 1 5", "0 0 0 1 1 5"));
  EXPECT_TRUE(differ("0 0 0 1 0.5 0", "0 0 0 1 1 5"));
  EXPECT_TRUE(differ("0 0 0 1 1 0", "-1 0 0 1 1 5"));
}

TEST(TextReader, ReadsWordsAndCountsLines) {
  TextReader reader("file", "one two # three\n\n\t four\r\nfive");
  EXPECT_EQ(reader.word(), "one");
  EXPECT_EQ(reader.line(), 1U);
  EXPECT_EQ(reader.word_in_line(), "two");
  EXPECT_EQ(reader.word_in_line(), "");
  EXPECT_EQ(reader.word(), "four");
  EXPECT_EQ(reader.line(), 3U);
  EXPECT_FALSE(reader.at_end());
  EXPECT_EQ(reader.required_word("a word"), "five");
  EXPECT_EQ(reader.line(), 4U);
  EXPECT_TRUE(reader.at_end());
  EXPECT_EQ(reader.word(), "");
  EXPECT_THROW(reader.required_word("a word"), ReadError);
}

// Where something is there twice, other readers may take the other one.
TEST(VtuText, RefusesWhatIsThereTwice) {
  const std::string array =
      "<DataArray type=\"Int32\" Name=\"label\" format=\"ascii\">1 2</DataArray>";
  const std::string points =
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 1 2"
      "</DataArray></Points>";
  const auto text = [&](const std::string& in_piece, const std::string& in_data) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"1\" "
           "NumberOfCells=\"2\">" +
           points + in_piece + "<CellData>" + array + in_data +
           "</CellData></Piece></UnstructuredGrid></VTKFile>\n";
  };
  const auto labels = [](const std::string& contents) {
    return VtuText("file", contents).array("CellData", "label");
  };
  const std::string honest =
      text("", "<DataArray type=\"Int8\" Name=\"other\" format=\"ascii\">3</DataArray>");
  EXPECT_EQ(labels(honest), (std::vector<double>{1, 2}));
  EXPECT_EQ(VtuText("file", honest).array("Points", ""), (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(VtuText("file", honest).array("CellData", "region"), std::vector<double>());
  EXPECT_THROW(labels(text("", array)), ReadError);
  EXPECT_THROW(labels(text(points, "")), ReadError);
  EXPECT_THROW(labels(text("</Piece><Piece>", "")), ReadError);
  EXPECT_THROW(labels(text("", "</CellData><CellData>")), ReadError);
  EXPECT_THROW(labels(honest + "<VTKFile>"), ReadError);
  EXPECT_THROW(labels(honest.substr(0, honest.size() - 4)), ReadError);
}

TEST(TextReader, NumbersBelowDoublesAreZeroThoseAboveAreRefused) {
  const std::string zeros(400, '0');
  for (const std::string& text :
       {std::string("1e-400"), std::string("-1E-400"), "0." + zeros + "1", "0." + zeros + "1e+5",
        std::string("1e-99999999999999999999"), "1" + zeros + "e-900"}) {
    EXPECT_EQ(TextReader("file", text).number(), 0) << text;
  }
  for (const std::string& text :
       {std::string("1e400"), std::string("-1E+400"), "1" + zeros, "1" + zeros + "e-5",
        std::string("1e99999999999999999999"), "0." + zeros + "1e900", std::string("1e-400x"),
        std::string("0x1p3"), std::string("0x1")}) {  // which some readers take for 0
    EXPECT_THROW(TextReader("file", text).number(), ReadError) << text;
  }
  EXPECT_EQ(TextReader("file", "4e-324").number(), 0x1p-1074);
}

// Just above the middle of two floats: as a double it is the middle, which is rounded to even.
TEST(TextReader, FloatsAreNotRoundedTwice) {
  EXPECT_EQ(TextReader("file", "1.000000059604644775390626").single(), 0x1.000002p0F);
  EXPECT_EQ(TextReader("file", "-1.000000059604644775390625").single(), -1.0F);
  EXPECT_EQ(TextReader("file", "+1e-50").single(), 0.0F);
  for (const char* text : {"0x1", "1e39", "-1e39", "1e400"}) {
    EXPECT_THROW(TextReader("file", text).single(), ReadError) << text;
  }
}

TEST(ReadError, IsOneLineOfWhatCanBePrinted) {
  EXPECT_STREQ(ReadError("a\nb\tc\x7f\xc2\x9b \xc3\xa9").what(), "a?b?c??? \xc3\xa9");
  EXPECT_STREQ(ReadError("a\x9b z\xe2\x80\x94").what(), "a? z\xe2\x80\x94");
  std::string long_text = "x";
  for (int i = 0; i < 700; ++i) long_text += "\xc3\xa9";
  EXPECT_EQ(ReadError(long_text).what(), long_text.substr(0, 999) + "...");
}

// Expat is given pieces of 64 MiB.
TEST(VtuText, IsReadByPieces) {
  const std::string comment = "<!--" + std::string((1U << 26U) - 4, 'x') + "-->";
  const std::string text =
      "<VTKFile type=\"UnstructuredGrid\">" + comment +
      "<UnstructuredGrid><Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"><Points><DataArray "
      "type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" "
      "offset=\"0\"/></Points></Piece>"
      "</UnstructuredGrid><AppendedData "
      "encoding=\"base64\">_GAAAAAAAAAAAAPA/AAAAAAAAAEAAAAAAAAAIQA=="
      "</AppendedData></VTKFile>";
  const std::string file = text.substr(0, 9) + "byte_order=\"LittleEndian\" " + text.substr(9);
  EXPECT_EQ(VtuText("file", file).array("Points", ""), (std::vector<double>{1, 2, 3}));
}

TEST(VtuText, ElementsMayBe64Deep) {
  const auto text = [](int depth) {
    std::string begin =
                    "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece "
                    "NumberOfPoints=\"0\" NumberOfCells=\"0\"/></UnstructuredGrid>",
                end = "</VTKFile>";
    for (int i = 1; i < depth; ++i) {
      begin += "<a>";
      end = "</a>" + end;
    }
    return begin + end;
  };
  VtuText("file", text(64));
  EXPECT_THROW(VtuText("file", text(65)), ReadError);
}

TEST(VtuText, NamesAreInArraysOfTwoIntegers) {
  const auto names = [](const std::string& array) {
    const std::string text =
        "<VTKFile type=\"UnstructuredGrid\" "
        "byte_order=\"LittleEndian\"><UnstructuredGrid><FieldData>" +
        array +
        "</FieldData><Piece NumberOfPoints=\"0\" "
        "NumberOfCells=\"0\"/></UnstructuredGrid></VTKFile>";
    return VtuText("file", text).names();
  };
  const SetNames a = {{{2, 5}, "a"}}, none;
  const std::string two = " NumberOfTuples=\"2\" Name=\"a\" ";
  EXPECT_EQ(names("<DataArray type=\"Int64\"" + two + "format=\"ascii\">5 2</DataArray>"), a);
  EXPECT_EQ(names("<DataArray type=\"UInt8\"" + two + "format=\"ascii\">5 2</DataArray>"), a);
  EXPECT_EQ(
      names("<DataArray type=\"Int32\"" + two + "format=\"binary\">CAAAAAUAAAACAAAA</DataArray>"),
      a);
  EXPECT_EQ(names("<DataArray type=\"Int64\"" + two +
                  "format=\"ascii\">1234567890123456789 2</DataArray>"),
            none);
  EXPECT_EQ(names("<DataArray type=\"Float64\"" + two + "format=\"ascii\">5 2</DataArray>"), none);
}

// Two squares side by side, the second with a square hole and in it an island: the area is what is
// left, whichever way the polygons go round.
TEST(Polygons, OfAFacetAreCutWithoutItsHoles) {
  std::vector<Position> vertices;
  std::vector<std::vector<Index>> polygons;
  const auto add = [&](double x, double y, double side, bool turned) {
    const auto at = static_cast<Index>(vertices.size());
    for (const auto& [u, v] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      vertices.push_back({x + side * u, y + side * v, 5});
    }
    polygons.push_back({at, at + 1, at + 2, at + 3});
    if (turned) std::reverse(polygons.back().begin(), polygons.back().end());
  };
  add(0, 0, 8, false);
  add(16, 0, 8, true);
  add(17, 1, 6, false);
  add(18, 2, 2, true);
  const auto triangles = cut_facet(vertices, polygons, {{17.5, 1.5, 5}});
  ASSERT_TRUE(triangles);
  double area = 0;
  for (const auto& [a, b, c] : *triangles) {
    const Position &p = vertices[a], &q = vertices[b], &r = vertices[c];
    area += std::abs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])) / 2;
  }
  EXPECT_EQ(area, 64 + 64 - 36 + 4);
  EXPECT_EQ(triangles->size(), 2U + 8U + 2U);
  EXPECT_FALSE(cut_facet(vertices, polygons, {{12, 4, 5}}));  // around which there is none
}

// Every character of Latin-1 is one of UTF-8.
TEST(Names, ThatAreNoUtf8WereInLatin1) {
  for (int code = 0x80; code < 0x100; ++code) {
    const std::string name = {'a', static_cast<char>(code)};
    const std::string as_utf8 = {'a', static_cast<char>(0xc0 | code / 64),
                                 static_cast<char>(0x80 | code % 64)};
    OracleReport report{"names", "names"};
    compare_names({{{2, 1}, name}}, {{{2, 1}, as_utf8}}, 2, {1}, report);
    EXPECT_EQ(report.violations, 0U) << code;
  }
}

TEST(VtuText, RefusesAMillionElements) {
  std::string text = "<VTKFile type=\"UnstructuredGrid\">";
  for (int i = 0; i < 1000001; ++i) text += "<a/>";
  try {
    VtuText("file", text + "</VTKFile>");
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_STREQ(error.what(), "file:1: more than a million elements");
  }
}

// As the numbers of records are, which another program reads exactly.
TEST(TextReader, ExactNumbersAreHexadecimalAndFitADouble) {
  const auto read = [](const char* text) { return TextReader("file", text).exact_number(); };
  EXPECT_EQ(read("-0x1.8p+3"), -12);
  EXPECT_EQ(read("0X1.FFFFFFFFFFFFFP+1023"), 0x1.fffffffffffffp+1023);
  EXPECT_EQ(read("0x0.0000000000001p-1022"), 0x1p-1074);
  EXPECT_EQ(read("0x001.8000000000000000000000p0"), 1.5);
  EXPECT_EQ(read("0x0fffffffffffff8p-4"), 0xfffffffffffff8p-4);
  EXPECT_EQ(read("0x0p+0"), 0);
  EXPECT_EQ(read("0x80000p-1093"), 0x1p-1074);
  for (const char* text :
       {"14.47", "1", "0.5", "0x", "+0x1p0", "0x-1p0", "0x1.8p", "0x1.8q3", "0xnan", "0xinf", "nan",
        "inf", "0x1p1024", "0x1p-1075", "0x3p-1075", "0x1.00000000000001p0",
        "0x1.000000000000000000000000000001p+3", "0x3ffffffffffffffp0"}) {
    EXPECT_THROW(read(text), ReadError) << text;
  }
}

TEST(TextReader, WhatNoTerminalShowsIsInNoMessage) {
  try {
    TextReader("file", "\x1b[2J\xff 1").expect("word");
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_STREQ(error.what(), "file:1: \"?[2J?\" where word should be");
  }
}

TEST(TextReader, AFileThatDoesNotFitInMemoryIsNotReadInPart) {
  const std::string said = "/dev/null";
  if (!can_be_limited(said)) GTEST_SKIP() << "address space cannot be limited here";
  // Larger than what the C library keeps for a thread.
  constexpr std::size_t kSize = 80 << 20;
  const std::string file = testing::TempDir() + "larger_than_memory";
  std::ofstream(file) << std::string(kSize, 'x');
  const auto read = [&] {
    try {
      return oracles::read_whole_file(file).size() == kSize ? 0 : 1;
    } catch (const std::bad_alloc&) {
      return 5;
    }
  };
  EXPECT_EQ(with_more_memory(2 * kSize, said, read), 0);
  for (const std::size_t mebibytes : {2, 30, 70}) {
    EXPECT_EQ(with_more_memory(mebibytes << 20, said, read), 5) << mebibytes;
  }
  std::remove(file.c_str());
}

// A small file may unpack to 64 MB. No count and no word of it takes memory that is not there.
TEST(TextReader, ALieInACompressedFileExhaustsNoMemory) {
  const std::string said = "/dev/null";
  if (!can_be_limited(said)) GTEST_SKIP() << "address space cannot be limited here";
  const std::string file = testing::TempDir() + "lie.gz";
  const auto pack = [&](const std::string& text) {
    std::ofstream(file, std::ios::binary) << packed_by_zlib(text, Wrapping::gzip);
  };
  const auto read = [&] {
    try {
      std::vector<std::array<int, 16>> items;
      TextReader reader = TextReader::of_file(file);
      reader.list("numbers", items, [&](auto& item) { item[0] = reader.integer32(); });
      return 0;
    } catch (const ReadError&) {
      return 3;
    } catch (const std::bad_alloc&) {
      return 5;
    }
  };
  pack("numbers 3 1 2 3" + std::string(50 << 20, ' '));
  EXPECT_EQ(with_more_memory(40 << 20, said, read), 0);
  pack("numbers 30000000 1 2 3" + std::string(50 << 20, ' '));
  EXPECT_EQ(with_more_memory(40 << 20, said, read), 3);
  pack("numbers 3 1 2 " + std::string(50 << 20, '0') + " 3");
  EXPECT_EQ(with_more_memory(40 << 20, said, read), 3);
  std::remove(file.c_str());
}

// What unpacks to far more than a mesh could is rejected before it takes the memory.
TEST(TextReader, AFileUnpacksToNoMoreThanAMeshDoes) {
  const std::string file = testing::TempDir() + "many.gz";
  std::ofstream(file, std::ios::binary)
      << packed_by_zlib(std::string(80 << 20, ' '), Wrapping::gzip);
  EXPECT_THROW(oracles::read_whole_file(file), ReadError);
  // So is what is read piece by piece, though none of it is kept.
  TextReader reader = TextReader::of_file(file);
  EXPECT_THROW(reader.at_end(), ReadError);
  EXPECT_NO_THROW(check_unpacked("file", 1000000, (1U << 26) + 64000000));
  EXPECT_THROW(check_unpacked("file", 1000000, (1U << 26) + 64000064), ReadError);
  std::remove(file.c_str());
}

// zlib's own reader of files takes what follows for nothing. Members may follow each other.
TEST(TextReader, AfterWhatIsCompressedNothingFollows) {
  const std::string file = testing::TempDir() + "followed.gz";
  const std::string half = packed_by_zlib("one ", Wrapping::gzip);
  const auto words = [&](const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
    std::string all;
    TextReader reader = TextReader::of_file(file);
    while (!reader.at_end()) all += reader.word();
    return all;
  };
  EXPECT_EQ(words(half), "one");
  EXPECT_EQ(words(half + half), "oneone");
  EXPECT_EQ(words(packed_by_zlib("", Wrapping::gzip) + half), "one");
  for (const std::string& after :
       {std::string("x"), std::string("junk\n"), std::string(1, '\0'), std::string("\x1f"),
        half.substr(0, 2), half.substr(0, half.size() - 1), std::string(300000, ' ')}) {
    EXPECT_THROW(words(half + after), ReadError) << after.size();
  }
  EXPECT_THROW(words(half.substr(0, half.size() - 1)), ReadError);
  std::string spoilt = half;
  spoilt[spoilt.size() - 6] ^= 1;  // its checksum
  EXPECT_THROW(words(spoilt), ReadError);
  std::remove(file.c_str());
}

TEST(TextReader, ReadsAFilePieceByPieceAsItReadsTheWhole) {
  std::mt19937 random(7);
  std::string text;
  while (text.size() < 1500000) {
    // Words and comments of many lengths, now and then one that is longer than a piece.
    const std::size_t length = random() % 20000 == 0 ? 300000 : 1 + random() % 40;
    if (random() % 50 == 0) text += '#';
    text.append(length, static_cast<char>('a' + random() % 26));
    text += " \t\r\n\n "[random() % 6];
  }
  const std::string path = testing::TempDir() + "pieces.txt";
  std::ofstream(path, std::ios::binary) << text;
  for (const char comment : {'#', '\0'}) {
    TextReader whole(path, text, comment), pieces = TextReader::of_file(path, comment);
    for (std::size_t i = 0;; ++i) {
      if (i % 7 == 3) {
        whole.skip_line();
        pieces.skip_line();
      }
      const std::string_view wanted = i % 3 == 0 ? whole.word_in_line() : whole.word();
      ASSERT_EQ(i % 3 == 0 ? pieces.word_in_line() : pieces.word(), wanted) << "word " << i;
      ASSERT_EQ(pieces.line(), whole.line());
      if (i % 3 != 0 && wanted.empty()) break;
    }
    EXPECT_TRUE(pieces.at_end());
    EXPECT_GT(whole.line(), 1000U);
  }
  // A count is judged by the whole file, not by the piece.
  std::ofstream(path, std::ios::binary) << "500000 " << std::string(1000000, 'x');
  EXPECT_EQ(TextReader::of_file(path).count(), 500000U);
  std::ofstream(path, std::ios::binary) << "500006 " << std::string(1000000, 'x');
  EXPECT_THROW(TextReader::of_file(path).count(), ReadError);
  EXPECT_THROW(TextReader::of_file(testing::TempDir()), ReadError);
  EXPECT_THROW(TextReader::of_file(path + ".none"), ReadError);
  std::ofstream(path, std::ios::binary | std::ios::trunc).flush();
  EXPECT_THROW(TextReader::of_file(path), ReadError);
}

// Compressed or not, in one member or in several, a file is read as the same text; a part of one is
// refused.
TEST(TextReader, ReadsWhatIsCompressedWithGzip) {
  std::string text;
  for (std::uint64_t i = 0; i < 300000; ++i) text += std::to_string(i * 7919 % 100003) + ' ';
  const std::string path = testing::TempDir() + "numbers.txt.gz";
  const auto pack = [&](const char* mode, const std::string& part) {
    const gzFile file = gzopen(path.c_str(), mode);
    gzwrite(file, part.data(), static_cast<unsigned>(part.size()));
    gzclose(file);
  };
  pack("wb", text.substr(0, 1000));
  pack("ab", text.substr(1000));
  EXPECT_TRUE(oracles::read_whole_file(path) == text);
  TextReader whole(path, text), pieces = TextReader::of_file(path);
  while (!whole.at_end()) ASSERT_EQ(pieces.integer(), whole.integer());
  EXPECT_TRUE(pieces.at_end());
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_THROW(oracles::read_whole_file(path), ReadError);
  TextReader cut = TextReader::of_file(path);
  EXPECT_THROW(while (!cut.at_end()) cut.integer(), ReadError);
  std::filesystem::remove(path);
  EXPECT_EQ(without_gz("a.b.gz"), "a.b");
  EXPECT_EQ(without_gz("gz"), "gz");
}

TEST(TextReader, ACommentMayEndTheText) {
  TextReader reader("file", "1 # 2");
  EXPECT_EQ(reader.integer(), 1);
  EXPECT_TRUE(reader.at_end());
  TextReader none("file", "a#b", '\0');
  EXPECT_EQ(none.word(), "a#b");
  TextReader skipped("file", "a b c\nd");
  EXPECT_EQ(skipped.word(), "a");
  skipped.skip_line();
  EXPECT_EQ(skipped.word(), "d");
  EXPECT_EQ(skipped.line(), 2U);
}

TEST(TextReader, ReadsNumbersExactlyOrRefuses) {
  const auto number = [](const char* text) { return TextReader("file", text).number(); };
  EXPECT_EQ(number("0.1"), 0.1);
  EXPECT_EQ(number("-2.5e3"), -2500);
  EXPECT_EQ(number("+3"), 3);
  EXPECT_EQ(number("1e-400"), 0);
  for (const char* text :
       {"", "1e400", "--1", "+-1", "1.5x", "x", "-", "1,5", "0x", "0x1.8p3", "-0X1p-2"}) {
    EXPECT_THROW(number(text), ReadError) << text;
  }
  const auto integer = [](const char* text) { return TextReader("file", text).integer(); };
  EXPECT_EQ(integer("-7"), -7);
  EXPECT_EQ(integer("+7"), 7);
  for (const char* text : {"", "1.0", "7x", "99999999999999999999", "+"}) {
    EXPECT_THROW(integer(text), ReadError) << text;
  }
}

TEST(TextReader, IndicesAndCountsHaveBounds) {
  const auto index = [](const char* text) { return TextReader("file", text).index(1, 5); };
  EXPECT_EQ(index("1"), 0U);
  EXPECT_EQ(index("5"), 4U);
  EXPECT_THROW(index("0"), ReadError);
  EXPECT_THROW(index("6"), ReadError);
  EXPECT_EQ(TextReader("file", "0").count(), 0U);
  EXPECT_EQ(TextReader("file", "4 a b c").count(), 4U);  // 7 characters: at most 4 things
  EXPECT_THROW(TextReader("file", "5 a b c").count(), ReadError);
  EXPECT_THROW(TextReader("file", "-1").count(), ReadError);
}

TEST(TextReader, ErrorsNameFileAndLine) {
  TextReader reader("name", "1\n2\nx");
  reader.integer();
  reader.integer();
  try {
    reader.integer();
    FAIL();
  } catch (const ReadError& error) {
    EXPECT_EQ(std::string(error.what()), "name:3: \"x\" is not an integer");
  }
}

// Each solid of a text file is a label of its own, from 1; equal corners are one vertex.
// What TetGen 1.5 makes of a tetrahedron with -pQo2; `faces` are those of -pQo2, -pQo2nn or -Qo2.
MeshFile read_ten_nodes(const std::string& faces,
                        const std::string& element = "0 0 2 3 1 4 5 6 7 8 9") {
  written("ten.node",
          "10 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 0.5 0 0.5\n5 0.5 0 0\n"
          "6 0 0.5 0\n7 0 0.5 0.5\n8 0.5 0.5 0\n9 0 0 0.5\n# Generated by pQo2\n");
  written("ten.face", faces);
  return read_mesh(written("ten.ele", "1 10 0\n" + element + "\n"));
}

TEST(TetGen, NodesOfSecondOrderAreOnTheirEdges) {
  const std::vector<std::string> faces = {"2 0 1 6 5 8 7", "1 0 3 5 9 4 8", "2 1 3 8 4 7 9",
                                          "0 2 3 6 7 9 -3"};
  const auto list = [&](const std::string& begin, const std::string& end) {
    std::string text = begin + "\n";
    for (int n = 0; n < 4; ++n) text += std::to_string(n) + " " + faces[n] + end + "\n";
    return text;
  };
  const std::string of_hull = "4 0\n0 2 0 1\n1 1 0 3\n2 2 1 3\n3 0 2 3\n";
  for (const std::string& text : {list("4 1", ""), list("4 1", " 0 0"), of_hull}) {
    const MeshFile mesh = read_ten_nodes(text);
    EXPECT_EQ(mesh.vertices.size(), 4U);
    EXPECT_EQ(mesh.boundary[3], (Face{0, 2, 3}));
    if (text != of_hull) {
      EXPECT_EQ(mesh.labels, (std::vector<std::int32_t>{7, 8, 9, -3}));
    }
    ASSERT_EQ(mesh.edge_nodes.size(), 6U);
    for (const auto& [ends, at] : mesh.edge_nodes) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(at[k], (mesh.vertices[ends[0]][k] + mesh.vertices[ends[1]][k]) / 2);
      }
    }
  }
  EXPECT_THROW(read_ten_nodes("1 1\n0 2 0 1 6 5 9 7\n"), ReadError);  // a node of another edge
  EXPECT_THROW(read_ten_nodes("1 1\n0 2 0 4 6 5 8 7\n"), ReadError);  // a node as a corner
  EXPECT_THROW(read_ten_nodes(of_hull, "0 0 2 3 1 4 5 6 7 8 8"), ReadError);
  EXPECT_THROW(read_ten_nodes(of_hull, "0 0 2 3 1 4 5 6 7 8"), ReadError);
}

TEST(Stl, SolidsAreLabelsAndCornersAreWelded) {
  const std::string first =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const std::string second =
      "facet normal 0 0 1\nouter loop\nvertex 1 0 -0\nvertex 1 1 0.5\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  const Polyhedron surface = read_surface(written(
      "two_solids.stl", "solid a\n" + first + "endsolid a\nsolid b\n" + second + "endsolid b\n"));
  EXPECT_EQ(surface.labels, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(surface.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}, {1, 3, 2}}));
  ASSERT_EQ(surface.vertices.size(), 4U);
  EXPECT_EQ(surface.vertices[3], (Position{1, 1, 0.5}));
  for (const char* wrong : {"vertex 0 0\n", "vertex 0 0 0\nvertex 0 0 0\n"}) {
    std::string text = "solid a\n" + first;
    text.replace(text.find("vertex 0 0 0\n"), 13, wrong);  // a number less, a corner more
    EXPECT_THROW(read_surface(written("wrong.stl", text)), ReadError);
  }
  std::string two_corners = "solid a\n" + first;
  two_corners.erase(two_corners.find("vertex 0 0 0\n"), 13);
  EXPECT_THROW(read_surface(written("wrong.stl", two_corners)), ReadError);
}

// The same two triangles in binary: 84 bytes, then 50 for each triangle, whose corners begin at its
// byte 12.
TEST(Stl, BinaryFilesHaveTheirCornersWhereTheFormatSays) {
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0.5, 0, 1, 0}};
  std::string bytes(84 + 2 * 50, '\0');
  bytes[80] = 2;
  for (std::size_t t = 0; t < 2; ++t) {
    std::memcpy(&bytes[84 + 50 * t + 12], corners[t], sizeof corners[t]);
  }
  const Polyhedron surface = read_surface(written("binary.stl", bytes));
  EXPECT_EQ(surface.triangles, (std::vector<std::array<Index, 3>>{{0, 1, 2}, {1, 3, 2}}));
  ASSERT_EQ(surface.vertices.size(), 4U);
  EXPECT_EQ(surface.vertices[1], (Position{1, 0, 0}));
  EXPECT_EQ(surface.vertices[3], (Position{1, 1, 0.5}));
}

template <class Value>
void append(std::string& bytes, Value value, bool big) {
  char of_value[sizeof value];
  std::memcpy(of_value, &value, sizeof value);
  if (big) std::reverse(of_value, of_value + sizeof value);
  bytes.append(of_value, sizeof value);
}

// A triangle with one coordinate and one index of this type, in both orders of bytes. (That of this
// machine is little-endian.)
template <class Value>
void expect_binary_ply(const char* type, Value value) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\ncomment no end_header yet\nelement vertex 3\n"
                        "property double x\nproperty " +
                        type + " y\nproperty float z\nelement face 1\nproperty list uchar " + type +
                        " vertex_indices\nproperty int label\nend_header\n";
    for (int v = 0; v < 3; ++v) {
      append(bytes, 0.1 * v, big);
      append(bytes, v == 0 ? value : static_cast<Value>(v), big);
      append(bytes, 0.5F, big);
    }
    append(bytes, std::uint8_t{3}, big);
    for (const int v : {2, 0, 1}) append(bytes, static_cast<Value>(v), big);
    append(bytes, std::int32_t{-7}, big);
    const Polyhedron surface = read_surface(written("binary.ply", bytes));
    EXPECT_EQ(surface.vertices,
              (std::vector<Position>{
                  {0, static_cast<double>(value), 0.5}, {0.1, 1, 0.5}, {0.1 * 2, 2, 0.5}}))
        << type;
    EXPECT_EQ(surface.triangles, (std::vector<std::array<Index, 3>>{{2, 0, 1}})) << type;
    EXPECT_EQ(surface.labels, std::vector<std::int32_t>{-7}) << type;
    EXPECT_THROW(read_surface(written("cut.ply", bytes.substr(0, bytes.size() - 1))), ReadError);
  }
}

TEST(Ply, BinaryFilesHaveEightTypesOfNumbers) {
  for (const char* type : {"double", "float64"}) expect_binary_ply<double>(type, 0.3);
  for (const char* type : {"float", "float32"}) expect_binary_ply<float>(type, 0.3F);
  for (const char* type : {"int", "int32"}) expect_binary_ply<std::int32_t>(type, -2000000000);
  for (const char* type : {"uint", "uint32"}) expect_binary_ply<std::uint32_t>(type, 4000000000U);
  for (const char* type : {"short", "int16"}) expect_binary_ply<std::int16_t>(type, -30000);
  for (const char* type : {"ushort", "uint16"}) expect_binary_ply<std::uint16_t>(type, 60000);
  for (const char* type : {"char", "int8"}) expect_binary_ply<std::int8_t>(type, -100);
  for (const char* type : {"uchar", "uint8"}) expect_binary_ply<std::uint8_t>(type, 200);
}

}  // namespace
}  // namespace tetproof
