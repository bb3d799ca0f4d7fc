// Object File Format (Geomview's manual, "OFF Files"), ASCII: [ST][C][N]OFF. One vertex and one
// face per line, as every writer does; normals, colours and texture coordinates are ignored.
#include <vector>

#include "mesher/io/readers.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

struct Keyword {
  bool valid = false;
  bool extras = false;  // lines hold more than coordinates
  std::string_view dimension;
  std::string_view rest;  // the rest of the token behind "OFF": "OFF490 518 0" occurs in the wild
};

Keyword parse_keyword(std::string_view token) {
  Keyword out;
  for (std::string_view prefix : {"ST", "C", "N"}) {
    if (token.starts_with(prefix)) {
      token.remove_prefix(prefix.size());
      out.extras = true;
    }
  }
  for (std::string_view prefix : {"4", "n"}) {
    if (token.starts_with(prefix)) {
      out.dimension = prefix;
      token.remove_prefix(prefix.size());
    }
  }
  if (!token.starts_with("OFF")) return out;
  out.rest = token.substr(3);
  out.valid = out.rest.empty() || (out.rest[0] >= '0' && out.rest[0] <= '9');
  return out;
}

class OffReader {
 public:
  OffReader(std::string_view text, SurfaceBuilder& builder)
      : in_(text, Comments::anywhere), builder_(builder) {}

  void read() {
    read_header();
    builder_.expect(vertices_, faces_, in_.remaining());
    for (std::uint64_t i = 0; i < vertices_; ++i) read_vertex(i);
    for (std::uint64_t i = 0; i < faces_; ++i) read_face(i);
    if (in_.next_line()) builder_.warn("lines after the last face ignored");
  }

 private:
  Position here() const { return at_line(in_.line()); }
  std::uint64_t read_count(std::string_view token, const char* what) const;
  void read_header();
  void read_vertex(std::uint64_t index);
  void read_face(std::uint64_t index);
  void need_line(const char* what, std::uint64_t index, std::uint64_t count) {
    if (in_.next_line()) return;
    fail(here(), std::string("the file ends before ") + what + " " + std::to_string(index) +
                     " of " + std::to_string(count));
  }

  TextLines in_;
  SurfaceBuilder& builder_;
  bool extras_ = false;
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::vector<std::uint32_t> corners_;
};

std::uint64_t OffReader::read_count(std::string_view token, const char* what) const {
  std::uint64_t count = 0;
  if (!parse_integer(token, count)) {
    fail(here(), std::string("bad number of ") + what + " " + in_quotes(token));
  }
  return count;
}

void OffReader::read_header() {
  std::string_view token;
  if (!in_.next_line() || !in_.next_token(token)) fail(here(), "the file is empty");
  const Keyword keyword = parse_keyword(token);
  if (keyword.valid) {
    if (!keyword.dimension.empty()) {
      fail(here(), in_quotes(token) + " is not a surface in three dimensions");
    }
    extras_ = keyword.extras;
    token = keyword.rest;
    if (token.empty() && !in_.next_token(token)) {
      if (!in_.next_line()) fail(here(), "the file ends before the counts");
      in_.next_token(token);
    }
    if (token == "BINARY") fail(here(), "binary OFF is not supported");
  }
  vertices_ = read_count(token, "vertices");
  if (!in_.next_token(token)) fail(here(), "the number of faces is missing");
  faces_ = read_count(token, "faces");
  // The number of edges follows; nobody needs it and many leave it out.
  const std::uint64_t smallest = 6;  // "0 0 0" or "3 0 1 2" and a line end
  if (vertices_ > kMaxVertices || vertices_ > in_.remaining() / smallest + 1) {
    fail(here(), "the file is too short for " + std::to_string(vertices_) + " vertices");
  }
  if (faces_ > kMaxTriangles || faces_ > in_.remaining() / smallest + 1) {
    fail(here(), "the file is too short for " + std::to_string(faces_) + " faces");
  }
}

void OffReader::read_vertex(std::uint64_t index) {
  need_line("vertex", index, vertices_);
  double values[3];
  std::string_view token;
  std::size_t count = 0;
  for (; in_.next_token(token); ++count) {
    double value = 0;
    const NumberStatus status = parse_double(token, value);
    if (status == NumberStatus::malformed) fail(here(), "bad number " + in_quotes(token));
    if (count >= 3) continue;
    if (status == NumberStatus::not_finite) {
      fail(here(), "non-finite coordinate " + in_quotes(token));
    }
    values[count] = value;
  }
  if (count < 3) {
    fail(here(), "vertex " + std::to_string(index) + " has " + std::to_string(count) +
                     " coordinates instead of 3");
  }
  if (count > 3 && !extras_) builder_.warn("more than 3 numbers per vertex; the others ignored");
  builder_.add_vertex(values[0], values[1], values[2], here());
}

void OffReader::read_face(std::uint64_t index) {
  need_line("face", index, faces_);
  std::string_view token;
  in_.next_token(token);
  std::uint32_t count = 0;
  if (!parse_integer(token, count)) fail(here(), "bad number of corners " + in_quotes(token));
  corners_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t corner = 0;
    if (!in_.next_token(token)) {
      fail(here(), "the line ends after " + std::to_string(i) + " of " + std::to_string(count) +
                       " corners");
    }
    if (!parse_integer(token, corner)) fail(here(), "bad vertex index " + in_quotes(token));
    if (corner >= vertices_) {
      fail(here(), "vertex index out of range: " + std::to_string(corner) + " of " +
                       std::to_string(vertices_));
    }
    corners_.push_back(corner);
  }
  builder_.add_polygon(corners_, 0, here());
}

}  // namespace

bool looks_like_off(std::string_view data) {
  TextLines in(data.substr(0, 65536), Comments::anywhere);
  std::string_view token;
  return in.next_line() && in.next_token(token) && parse_keyword(token).valid;
}

void read_off(std::string_view text, SurfaceBuilder& builder) {
  OffReader(text, builder).read();
}

}  // namespace delmesher::io
