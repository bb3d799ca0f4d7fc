// What a build without zlib says, which without_zlib.cpp makes of this program.
#include <gtest/gtest.h>

#include <fstream>

#include "mesher/io/inflate.h"
#include "mesher/io/parse_surface.h"
#include "mesher/io/read_mesh.h"
#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

using namespace std::string_literals;

// The text "x", by gzip.
const std::string kGzip = "\x1f\x8b\x08\0\0\0\0\0\0\x03\xab\0\0\x83\x16\xdc\x8c\x01\0\0\0"s;

TEST(WithoutZlib, GzipIsRefused) {
  const std::string path = testing::TempDir() + "without_zlib.stl.gz";
  std::ofstream(path, std::ios::binary) << kGzip;
  const ReadResult surface = read_surface(path);
  EXPECT_EQ(surface.code, ReadCode::unreadable);
  EXPECT_EQ(surface.error, path + ": compressed by gzip: this build of delmesher has no zlib");
  EXPECT_EQ(read_mesh(path).error, surface.error);
}

// An archive of one file, which is stored, or would be compressed.
std::string archive(char method) {
  const std::string name = "3D/3dmodel.model",
                    numbers = "\0\0\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\x10\0"s;
  const std::string head = "\0\0"s + method + numbers;
  return "PK\3\4\0\0"s + head + "\0\0"s + name + "x" + "PK\1\2\0\0\0\0"s + head +
         std::string(16, '\0') + name + "PK\5\6\0\0\0\0\1\0\1\0\x3e\0\0\0\x2f\0\0\0\0\0"s;
}

TEST(WithoutZlib, ModelsOf3mfAreRefused) {
  const ReadResult packed = parse_surface(archive(8), "a.3mf");
  EXPECT_EQ(packed.code, ReadCode::unreadable);
  EXPECT_EQ(
      packed.error,
      "a.3mf: byte 46: '3D/3dmodel.model': compressed by DEFLATE: this build of delmesher has "
      "no zlib");
  EXPECT_EQ(parse_surface(archive(0), "a.3mf").error,
            "a.3mf: checked by CRC-32: this build of delmesher has no zlib");
}

TEST(WithoutZlib, CompressedArraysAreRefused) {
  const std::string head =
      "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" "
      "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid><Piece>\n<Points>\n";
  const std::string array =
      "<DataArray type=\"Float64\" Name=\"Points\" format=\"binary\">"
      "AQAAABgAAAAAAAAACwAAAA==eJxjYMAOAAAYAAE=</DataArray>";
  const MeshReadResult read =
      parse_mesh(head + array + "</Points></Piece></UnstructuredGrid></VTKFile>", "a.vtu");
  EXPECT_EQ(read.code, ReadCode::unreadable);
  EXPECT_EQ(
      read.error,
      "a.vtu:4: an array that cannot be unpacked: compressed by zlib: this build of delmesher "
      "has no zlib");
}

}  // namespace
}  // namespace delmesher::io
