#include "mesher/io/foreign_content.h"

#include <algorithm>
#include <array>

#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

struct Signature {
  std::string_view bytes, advice;
};

constexpr std::string_view kUtf16 = "text in UTF-16: convert it first (iconv -f UTF-16 -t UTF-8)";
constexpr std::string_view kPage = "a web page: the download did not give the file itself";

constexpr std::array<Signature, 13> kSignatures = {
    {{"BZh", "compressed with bzip2: unpack it first (bunzip2)"},
     {"\xfd"
      "7zXZ",
      "compressed with xz: unpack it first (unxz)"},
     {"\x28\xb5\x2f\xfd", "compressed with zstd: unpack it first (unzstd)"},
     {"PK\x03\x04", "a zip archive: unpack it first (unzip)"},
     {"ISO-10303-21",
      "a STEP file, of curved faces: make triangles of it first (gmsh -2 -o OUT.stl)"},
     {"glTF", "a binary glTF file: export STL, OBJ or PLY"},
     {"\xff\xfe", kUtf16},
     {"\xfe\xff", kUtf16},
     {"%PDF", "a PDF document"},
     {"#VRML", "a VRML file: export STL, OBJ or PLY"},
     {"Kaydara FBX", "an FBX file: export STL, OBJ or PLY"},
     {"version https://git-lfs", "a pointer of Git LFS, not the file itself (git lfs pull)"},
     {"\x1f\x8b", "compressed twice: unpack it first (gunzip)"}}};

// The cards of IGES have 72 columns of text, then a letter and a number.
bool is_iges(std::string_view bytes) {
  return bytes.size() > 80 && bytes.substr(72, 8) == "S      1";
}

// Without its mark: every other byte of plain text is 0.
bool is_utf16(std::string_view bytes) {
  constexpr std::size_t kEnough = 16;
  if (bytes.size() < kEnough) return false;
  const auto zeros_at = [&](std::size_t remainder) {
    for (std::size_t i = 0; i < kEnough; ++i) {
      if ((bytes[i] == 0) != (i % 2 == remainder)) return false;
    }
    return true;
  };
  return zeros_at(0) || zeros_at(1);
}

}  // namespace

std::string_view foreign_content(std::string_view bytes) {
  for (const Signature& signature : kSignatures) {
    if (bytes.starts_with(signature.bytes)) return signature.advice;
  }
  if (is_utf16(bytes)) return kUtf16;
  if (is_iges(bytes)) {
    return "an IGES file, of curved faces: make triangles of it first (gmsh -2 -o OUT.stl)";
  }
  const std::size_t first = bytes.substr(0, 4096).find_first_not_of(" \t\r\n");
  const std::string_view text = first == std::string_view::npos ? "" : bytes.substr(first);
  for (const std::string_view tag : {"<!doctype html", "<html"}) {
    if (equal_ignoring_case(text.substr(0, tag.size()), tag)) return kPage;
  }
  const std::string_view head = text.substr(0, 4096);
  const auto holds = [&](std::string_view words) {
    return head.find(words) != std::string_view::npos;
  };
  if (head.starts_with('<') && holds("<COLLADA")) {
    return "a COLLADA file: export STL, OBJ or PLY";
  }
  if (head.starts_with('<') && holds("<X3D")) return "an X3D file: export STL, OBJ or PLY";
  if (head.starts_with('{') && holds("\"asset\"")) {
    return "a glTF file: export STL, OBJ or PLY";
  }
  return {};
}

}  // namespace delmesher::io
