// Wavefront OBJ: v and f, and l where wanted; labels from materials, groups or objects (see
// formats.md).
#include <algorithm>
#include <map>
#include <vector>

#include "mesher/io/readers.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

// Numbers names from 1 in the order of their first use by a face.
class Names {
 public:
  void set(std::string_view name) {
    current_ = name;
    known_ = false;
  }
  std::int32_t use() {
    if (!known_) {
      number_ = numbers_.try_emplace(current_, static_cast<std::int32_t>(numbers_.size()) + 1)
                    .first->second;
      known_ = true;
    }
    return number_;
  }
  std::size_t count() const { return numbers_.size(); }
  std::string listing() const {
    const LabelNames names = by_number();
    std::string out;
    for (const auto& [number, name] : names) {
      if (number > 20) return out + ", ...";
      out += (number == 1 ? "" : ", ") + std::to_string(number) + " = " + in_quotes(name);
    }
    return out;
  }
  LabelNames by_number() const {
    LabelNames names;
    for (const auto& [name, number] : numbers_) names[number] = name;
    return names;
  }

 private:
  std::map<std::string, std::int32_t, std::less<>> numbers_;
  std::string current_;
  std::int32_t number_ = 0;
  bool known_ = false;
};

class ObjReader {
 public:
  ObjReader(std::string_view text, bool planar, SurfaceBuilder& builder)
      : in_(text, Comments::at_token_start), planar_(planar), builder_(builder) {}

  void read();

 private:
  struct Face {
    std::size_t end;  // in corners_
    std::array<std::int32_t, 3> names;
    std::uint64_t line;
  };

  Position here() const { return at_line(in_.line()); }
  bool next(std::string_view& token);
  void read_vertex();
  void read_face();
  std::uint32_t read_corner(std::string_view token) const;
  void check_reference(std::string_view reference, std::string_view token) const;
  void read_line();
  void check_range(std::uint32_t corner, std::uint64_t line) const;
  void add_faces();
  void add_lines();

  TextLines in_;
  bool planar_;
  SurfaceBuilder& builder_;
  Names materials_, groups_, objects_;
  std::vector<std::uint32_t> corners_;
  std::vector<Face> faces_;
  struct Line {
    std::array<std::uint32_t, 2> ends;
    std::uint64_t line;
  };
  std::vector<Line> lines_;
};

// The next token of a line, which a backslash at its end continues on the next one.
bool ObjReader::next(std::string_view& token) {
  while (in_.next_token(token)) {
    if (token.back() != '\\' || !in_.rest_of_line().empty()) return true;
    token.remove_suffix(1);
    const bool more = in_.next_raw_line();
    if (!token.empty()) return true;
    if (!more) return false;
  }
  return false;
}

void ObjReader::read_vertex() {
  std::array<double, 3> values = {0, 0, 0};
  std::string_view token;
  std::size_t count = 0;
  for (; next(token); ++count) {
    double value = 0;
    const NumberStatus status = parse_double(token, value);
    if (status == NumberStatus::malformed) fail(here(), "bad number " + in_quotes(token));
    if (count >= 3) continue;  // a weight or a colour
    if (status == NumberStatus::not_finite) {
      fail(here(), "non-finite coordinate " + in_quotes(token));
    }
    values[count] = value;
  }
  if (count < 3 && !(planar_ && count == 2)) {
    fail(here(), "a vertex with " + std::to_string(count) + " coordinates instead of 3");
  }
  builder_.add_vertex(values[0], values[1], values[2], here());
}

void ObjReader::check_reference(std::string_view reference, std::string_view token) const {
  std::int64_t number = 0;
  if (!parse_integer(reference, number) || number == 0) {
    fail(here(), "bad corner " + in_quotes(token));
  }
}

// v, v/vt, v//vn or v/vt/vn; positive from 1, negative from the latest vertex backwards.
std::uint32_t ObjReader::read_corner(std::string_view token) const {
  const std::size_t slash = token.find('/');
  if (slash != std::string_view::npos) {
    const std::string_view rest = token.substr(slash + 1);
    const std::size_t second = rest.find('/');
    const std::string_view texture = rest.substr(0, second);
    // "v/" is tolerated like "v//": some exporters write it for a missing texture coordinate.
    if (!texture.empty()) check_reference(texture, token);
    if (second != std::string_view::npos && second + 1 < rest.size()) {
      check_reference(rest.substr(second + 1), token);
    }
  }
  std::int64_t number = 0;
  if (!parse_integer(token.substr(0, slash), number) || number == 0) {
    fail(here(), "bad corner " + in_quotes(token));
  }
  const auto count = static_cast<std::int64_t>(builder_.vertex_count());
  if (number < -count || number > static_cast<std::int64_t>(kMaxVertices)) {
    fail(here(), "vertex index out of range: " + std::to_string(number));
  }
  return static_cast<std::uint32_t>(number > 0 ? number - 1 : count + number);
}

void ObjReader::read_face() {
  const std::uint64_t line = in_.line();
  const std::size_t begin = corners_.size();
  std::string_view token;
  while (next(token)) corners_.push_back(read_corner(token));
  if (corners_.size() - begin < 3) {
    fail(at_line(line), "a face needs at least 3 corners, this one has " +
                            std::to_string(corners_.size() - begin));
  }
  faces_.push_back({corners_.size(), {materials_.use(), groups_.use(), objects_.use()}, line});
}

void ObjReader::read_line() {
  const std::uint64_t line = in_.line();
  std::string_view token;
  std::size_t count = 0;
  std::uint32_t last = 0;
  for (; next(token); ++count) {
    const std::uint32_t corner = read_corner(token);
    if (count > 0 && corner == last) {
      fail(at_line(line), "a line from vertex " + std::to_string(corner + 1ULL) + " to itself");
    }
    if (count > 0) lines_.push_back({{last, corner}, line});
    last = corner;
  }
  if (count < 2) {
    fail(at_line(line), "a line needs at least 2 vertices, this one has " + std::to_string(count));
  }
}

void ObjReader::check_range(std::uint32_t corner, std::uint64_t line) const {
  if (corner < builder_.vertex_count()) return;
  fail(at_line(line), "vertex index out of range: " + std::to_string(corner + 1ULL) + " of " +
                          std::to_string(builder_.vertex_count()));
}

void ObjReader::add_lines() {
  for (const Line& line : lines_) {
    for (const std::uint32_t end : line.ends) check_range(end, line.line);
    builder_.add_line(line.ends);
  }
}

void ObjReader::add_faces() {
  // Materials describe the purpose of a face best, then groups, then objects.
  const std::array<const Names*, 3> sources = {&materials_, &groups_, &objects_};
  const std::array<const char*, 3> kinds = {"material", "group", "object"};
  std::size_t chosen = 0;
  while (chosen < 3 && sources[chosen]->count() < 2) ++chosen;
  if (chosen < 3) {
    builder_.note(std::string("labels by ") + kinds[chosen] + ": " + sources[chosen]->listing());
    for (const auto& [number, name] : sources[chosen]->by_number()) {
      builder_.name_label(number, name);
    }
  }
  std::size_t begin = 0;
  for (const Face& face : faces_) {
    const std::span<const std::uint32_t> corners(corners_.data() + begin, face.end - begin);
    begin = face.end;
    for (const std::uint32_t corner : corners) check_range(corner, face.line);
    builder_.add_polygon(corners, chosen < 3 ? face.names[chosen] : 0, at_line(face.line));
  }
}

void ObjReader::read() {
  bool curves = false;
  while (in_.next_line()) {
    std::string_view keyword;
    in_.next_token(keyword);
    if (keyword == "v") {
      read_vertex();
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else if (keyword == "l" && planar_) {
      read_line();
    } else if (keyword == "usemtl") {
      materials_.set(in_.rest_of_line());
    } else if (keyword == "g") {
      groups_.set(in_.rest_of_line());
    } else if (keyword == "o") {
      objects_.set(in_.rest_of_line());
    } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
      curves = true;
    } else {
      // Normals, texture coordinates, lines, points, smoothing groups, libraries. Anything that is
      // not a keyword at all means that this is not an OBJ file.
      const bool word = std::all_of(keyword.begin(), keyword.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_';
      });
      const bool letter_first =
          (keyword[0] >= 'a' && keyword[0] <= 'z') || (keyword[0] >= 'A' && keyword[0] <= 'Z');
      if (!word || !letter_first) fail(here(), "unexpected " + in_quotes(keyword));
    }
  }
  if (curves) builder_.warn("free-form curves and surfaces ignored");
  add_faces();
  add_lines();
}

}  // namespace

bool looks_like_obj(std::string_view data) {
  TextLines in(data.substr(0, 65536), Comments::at_token_start);
  while (in.next_line()) {
    std::string_view keyword, token;
    in.next_token(keyword);
    double value = 0;
    if (keyword == "v") {
      return in.next_token(token) && parse_double(token, value) != NumberStatus::malformed;
    }
    const std::array<std::string_view, 6> allowed = {"g", "o", "usemtl", "mtllib", "vt", "vn"};
    if (std::find(allowed.begin(), allowed.end(), keyword) == allowed.end()) return false;
  }
  return false;
}

void read_obj(std::string_view text, bool planar, SurfaceBuilder& builder) {
  ObjReader(text, planar, builder).read();
}

}  // namespace delmesher::io
