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

constexpr std::array<Signature, 9> kSignatures = {
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
     {"%PDF", "a PDF document"}}};

}  // namespace

std::string_view foreign_content(std::string_view bytes) {
  for (const Signature& signature : kSignatures) {
    if (bytes.starts_with(signature.bytes)) return signature.advice;
  }
  const std::size_t first = bytes.substr(0, 4096).find_first_not_of(" \t\r\n");
  const std::string_view text = first == std::string_view::npos ? "" : bytes.substr(first);
  for (const std::string_view tag : {"<!doctype html", "<html"}) {
    if (equal_ignoring_case(text.substr(0, tag.size()), tag)) return kPage;
  }
  return {};
}

}  // namespace delmesher::io
