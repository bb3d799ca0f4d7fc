#include "oracles/cgal/record_text.h"

#include <zlib.h>

#include <array>
#include <cctype>
#include <cmath>
#include <exception>
#include <memory>
#include <sstream>

namespace tetproof::oracles {

namespace {

using delmesher::ExactPoint;
using delmesher::ExactRecord;

// "-0x1.8p+3", "0x0p+0", also decimal integers. Exact: at most 53 bits are written.
bool parse_hexadecimal(const std::string& word, double& value) {
  std::size_t at = 0;
  const bool negative = word.starts_with("-");
  if (negative || word.starts_with("+")) ++at;
  if (word.compare(at, 2, "0x") != 0 && word.compare(at, 2, "0X") != 0) return false;
  at += 2;
  double mantissa = 0;
  int exponent = 0, digits = 0;
  bool point = false;
  for (; at < word.size() && word[at] != 'p' && word[at] != 'P'; ++at) {
    if (word[at] == '.' && !point) {
      point = true;
      continue;
    }
    const std::string all = "0123456789abcdef";
    const auto digit = all.find(static_cast<char>(std::tolower(word[at])));
    if (digit == std::string::npos) return false;
    mantissa = mantissa * 16 + static_cast<double>(digit);
    if (point) exponent -= 4;
    ++digits;
  }
  if (digits == 0 || digits > 14) return false;
  if (at < word.size()) {
    try {
      exponent += std::stoi(word.substr(at + 1));
    } catch (const std::exception&) {
      return false;
    }
  }
  value = std::ldexp(negative ? -mantissa : mantissa, exponent);
  return true;
}

bool read_plane(std::istringstream& words, ExactRecord::Plane& plane) {
  std::string kind;
  words >> kind;
  if (kind != "N" && kind != "T") return false;
  plane.spanned = kind == "T";
  std::vector<std::array<double, 3>*> wanted;
  if (!plane.spanned) wanted.push_back(&plane.normal);
  for (std::size_t i = 0; i < (plane.spanned ? 3U : 1U); ++i) wanted.push_back(&plane.through[i]);
  for (std::array<double, 3>* numbers : wanted) {
    for (double& x : *numbers) {
      std::string word;
      if (!(words >> word) || !parse_hexadecimal(word, x)) return false;
    }
  }
  return true;
}

bool read_point(std::istringstream& words, const std::string& kind, ExactPoint& p) {
  std::array<double*, 3> numbers = {&p.x, &p.y, &p.z};
  std::size_t wanted = 3;
  if (kind == "S" || kind == "T" || kind == "P") {
    p.kind = kind == "S"   ? ExactPoint::Kind::on_segment
             : kind == "T" ? ExactPoint::Kind::on_triangle
                           : ExactPoint::Kind::on_planes;
    words >> p.i >> p.j;
    if (kind != "S") words >> p.k;
    wanted = kind == "S" ? 1 : kind == "T" ? 2 : 0;
  } else if (kind != "E") {
    return false;
  }
  std::string word;
  for (std::size_t n = 0; n < wanted; ++n) {
    if (!(words >> word) || !parse_hexadecimal(word, *numbers[n])) return false;
  }
  return true;
}

// The lines of a file, which may be compressed with gzip.
class Lines {
 public:
  explicit Lines(const std::string& path) : file_(::gzopen(path.c_str(), "rb"), ::gzclose) {}

  // False at the end, also if there is no such file.
  bool next(std::string& line) {
    line.clear();
    std::array<char, 4096> piece;
    while (file_ && ::gzgets(file_.get(), piece.data(), static_cast<int>(piece.size()))) {
      line += piece.data();
      if (!line.ends_with('\n')) continue;
      line.pop_back();
      return true;
    }
    return !line.empty();
  }

 private:
  std::unique_ptr<gzFile_s, int (*)(gzFile)> file_;
};

}  // namespace

bool read_definitions(const std::string& path, Definitions& definitions) {
  std::vector<ExactPoint>& points = definitions.points;
  Lines lines(path);
  std::string line, word;
  std::size_t count = 0, planes = 0;
  while (lines.next(line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    if (definitions.planes.size() < planes) {
      if (!read_plane(words, definitions.planes.emplace_back())) return false;
      continue;
    }
    if (!(words >> word)) continue;
    if (word == "planes" && !(words >> planes)) return false;
    if (word == "points" && words >> count) break;
  }
  while (points.size() < count && lines.next(line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string kind;
    if (!(words >> kind)) continue;
    ExactPoint p;
    if (!read_point(words, kind, p)) return false;
    points.push_back(p);
  }
  return count > 0 && points.size() == count;
}

}  // namespace tetproof::oracles
