// Mutation of the files that the readers take: a small surface written in the format from time to
// time, words exchanged for others that a reader has to tell apart, and the bytes as they are.
// Deterministic in the seed. Compiled once per format.
#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "corpus/generators/random.h"
#include "corpus/generators/shapes.h"
#include "mesher/delmesher.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace tetproof::fuzz {
namespace {

using delmesher::Surface;

Surface some_surface(Random& random) {
  const auto corner = [&] {
    return shapes::Point{random.integer(-4, 4) / 4.0, random.integer(-4, 4) / 4.0, random.unit()};
  };
  if (random.chance(0.5)) return shapes::tetrahedron(corner(), corner(), corner(), corner());
  return shapes::box({0, 0, 0}, {1, random.tiny(20), 1});
}

class Writer {
 public:
  Writer(const Surface& surface, Random& random) : surface_(surface), random_(random) {}

  std::string write(std::string_view format) {
    if (format == "obj") return obj();
    if (format == "stl") return random_.chance(0.5) ? stl() : binary_stl();
    if (format == "ply") return ply();
    if (format == "smesh" || format == "poly") return tetgen(format == "poly");
    if (format == "3mf") return model();
    return off();
  }

 private:
  std::string vertices(const char* before, bool numbered, int base) {
    std::string text;
    for (std::size_t v = 0; v < surface_.vertices.size(); ++v) {
      text += before;
      if (numbered) text += std::to_string(static_cast<int>(v) + base);
      for (const double x : surface_.vertices[v]) text += ' ' + std::to_string(x);
      text += '\n';
    }
    return text;
  }
  std::string faces(const char* before, int base) {
    std::string text;
    for (const auto& t : surface_.triangles) {
      text += before;
      for (const auto v : t) text += ' ' + std::to_string(static_cast<int>(v) + base);
      text += '\n';
    }
    return text;
  }
  std::string counts() {
    return std::to_string(surface_.vertices.size()) + ' ' +
           std::to_string(surface_.triangles.size());
  }

  std::string off() { return "OFF\n" + counts() + " 0\n" + vertices("", false, 0) + faces("3", 0); }
  std::string obj() {
    const int backwards = -static_cast<int>(surface_.vertices.size());
    return vertices("v", false, 0) + faces("f", random_.chance(0.5) ? 1 : backwards);
  }
  std::string stl() {
    std::string text = "solid\n";
    for (const auto& t : surface_.triangles) {
      text += "facet normal 0 0 1\nouter loop\n";
      for (const auto v : t) {
        text += "vertex";
        for (const double x : surface_.vertices[v]) text += ' ' + std::to_string(x);
        text += '\n';
      }
      text += "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
  }
  std::string tetgen(bool poly) {
    const int base = random_.chance(0.5) ? 1 : 0;
    const std::string facets = std::to_string(surface_.triangles.size());
    return std::to_string(surface_.vertices.size()) + " 3 0 0\n" + vertices("", true, base) +
           facets + " 0\n" + faces(poly ? "1\n3" : "3", base) + "0\n0\n";
  }

  std::string model() {
    std::string text =
        "<model unit='inch' requiredextensions='p' "
        "xmlns:p='http://schemas.microsoft.com/3dmanufacturing/production/2015/06' >\n"
        "<resources>\n<object id='1' name='a &#65; b' >\n<mesh>\n<vertices>\n";
    for (const auto& [x, y, z] : surface_.vertices) {
      text += "<vertex x='" + std::to_string(x) + "' y='" + std::to_string(y) + "' z='" +
              std::to_string(z) + "' />\n";
    }
    text += "</vertices>\n<triangles>\n";
    for (const auto& [a, b, c] : surface_.triangles) {
      text += "<triangle v1='" + std::to_string(a) + "' v2='" + std::to_string(b) + "' v3='" +
              std::to_string(c) + "' />\n";
    }
    text +=
        "</triangles>\n</mesh>\n</object>\n<object id='2' >\n<components>\n"
        "<component objectid='1' />\n";
    if (random_.chance(0.5)) {
      text += "<component objectid='1' transform=' 1 0 0 0 -1 0 0 0 1 4 0 0 ' />\n";
    }
    return text +
           "</components>\n</object>\n</resources>\n<build>\n<item objectid='2' />\n</build>\n"
           "</model>\n";
  }

  template <class Number>
  static void append(std::string& text, Number number, bool big) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);  // little-endian, as all machines we fuzz on
    if (big) std::reverse(bytes, bytes + sizeof number);
    text.append(bytes, sizeof number);
  }
  std::string binary_stl() {
    std::string text(80, ' ');
    append(text, static_cast<std::uint32_t>(surface_.triangles.size()), false);
    for (const auto& t : surface_.triangles) {
      text.append(12, '\0');
      for (const auto v : t) {
        for (const double x : surface_.vertices[v]) append(text, static_cast<float>(x), false);
      }
      text.append(2, '\0');
    }
    return text;
  }
  std::string ply() {
    static const char* const kEncodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const std::size_t encoding = random_.below(3);
    std::string text = std::string("ply\nformat ") + kEncodings[encoding] +
                       " 1.0\nelement vertex " + std::to_string(surface_.vertices.size()) +
                       "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                       std::to_string(surface_.triangles.size()) +
                       "\nproperty list uchar int vertex_indices\nend_header\n";
    if (encoding == 0) return text + vertices("", false, 0) + faces("3", 0);
    for (const auto& p : surface_.vertices) {
      for (const double x : p) append(text, x, encoding == 2);
    }
    for (const auto& t : surface_.triangles) {
      text += '\3';
      for (const auto v : t) append(text, v, encoding == 2);
    }
    return text;
  }

  const Surface& surface_;
  Random& random_;
};

// Beginnings and lengths of the words, or of the lines.
std::vector<std::pair<std::size_t, std::size_t>> pieces_of(std::string_view text, bool lines) {
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  const std::string_view breaks = lines ? "\n" : " \n\t\r";
  std::size_t begin = 0;
  while ((begin = text.find_first_not_of(breaks, begin)) != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(breaks, begin), text.size());
    pieces.emplace_back(begin, end - begin);
    begin = end;
  }
  return pieces;
}

std::string other_word(std::string_view word, Random& random) {
  long number = 0;
  // Numbers of so many digits that they would overflow are left out.
  const bool whole =
      !word.empty() && word.size() < 18 && word.find_first_not_of("-0123456789") == word.npos;
  if (whole) number = std::strtol(std::string(word).c_str(), nullptr, 10);
  switch (random.below(whole ? 6 : 3)) {
    case 0: {
      static const char* const kWords[] = {
          "0",      "-1",  "1e400", "nan",        "4294967295",
          "1e-324", "0x1", "#",     "2147483648", "99999999999999999999"};
      return kWords[random.below(std::size(kWords))];
    }
    case 1:
      return "";
    case 2:
      return std::string(word) + ' ' + std::string(word);
    case 3:
      return std::to_string(number + 1);
    case 4:
      return std::to_string(number - 1);
    default:
      return std::to_string(-number);
  }
}

std::string mutate(std::string text, Random& random) {
  const bool lines = random.chance(0.2);
  const auto pieces = pieces_of(text, lines);
  if (pieces.empty()) return text;
  const auto [begin, length] = pieces[random.below(pieces.size())];
  const std::string piece = text.substr(begin, length);
  if (random.chance(0.2)) {  // one of the others instead
    const auto [from, long_] = pieces[random.below(pieces.size())];
    return text.replace(begin, length, text.substr(from, long_));
  }
  if (lines) return text.replace(begin, length, random.chance(0.5) ? "" : piece + '\n' + piece);
  return text.replace(begin, length, other_word(piece, random));
}

}  // namespace
}  // namespace tetproof::fuzz

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  using namespace tetproof::fuzz;
  tetproof::Random random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (size < 8 || random.chance(0.05)) {
    text = Writer(some_surface(random), random).write(TETPROOF_FORMAT);
  } else if (random.chance(0.5)) {
    text = mutate(std::move(text), random);
  } else {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  if (text.size() > max_size) return size;
  std::memcpy(data, text.data(), text.size());
  return text.size();
}
