// STL, ASCII and binary. Normals and attribute words are ignored; corners of equal coordinates are
// one vertex.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "mesher/io/readers.h"
#include "mesher/io/text.h"

namespace delmesher::io {
namespace {

constexpr std::size_t kHeaderSize = 84, kFacetSize = 50;

std::uint32_t little_endian(std::string_view data, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = value << 8 | static_cast<unsigned char>(data[offset + i]);
  }
  return value;
}

// The size decides where it can: a text of that size would have to announce more than 2^27 facets.
bool has_binary_size(std::string_view data) {
  if (data.size() < kHeaderSize) return false;
  return data.size() == kHeaderSize + std::uint64_t{little_endian(data, 80)} * kFacetSize;
}

bool is_text(std::string_view data) {
  TextLines in(data.substr(0, 4096), Comments::none);
  std::string_view token;
  if (!in.next_line() || !in.next_token(token) || !equal_ignoring_case(token, "solid")) {
    return false;
  }
  // The header of a binary file may say "solid", but its numbers are not text for long.
  return data.substr(0, 4096).find('\0') == std::string_view::npos;
}

void read_binary(std::string_view data, SurfaceBuilder& builder) {
  if (data.size() < kHeaderSize) {
    fail(at_byte(data.size()), "neither an ASCII STL ('solid ...') nor 84 bytes of a binary one");
  }
  const std::uint64_t count = little_endian(data, 80);
  const std::uint64_t whole = (data.size() - kHeaderSize) / kFacetSize;
  if (whole < count) {
    fail(at_byte(data.size()),
         "the file ends in facet " + std::to_string(whole) + " of " + std::to_string(count));
  }
  if (data.size() != kHeaderSize + count * kFacetSize) {
    builder.warn(std::to_string(data.size() - kHeaderSize - count * kFacetSize) +
                 " bytes after the last facet ignored");
  }
  builder.expect(3 * count, count, data.size());
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::size_t facet = kHeaderSize + i * kFacetSize;
    std::array<std::uint32_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = facet + 12 + 12 * k;
      std::array<double, 3> p;
      for (std::size_t j = 0; j < 3; ++j) {
        p[j] = std::bit_cast<float>(little_endian(data, corner + 4 * j));
      }
      corners[k] = static_cast<std::uint32_t>(builder.vertex_count());
      builder.add_vertex(p[0], p[1], p[2], at_byte(corner));
    }
    builder.add_polygon(corners, 0, at_byte(facet));
  }
}

class AsciiStlReader {
 public:
  AsciiStlReader(std::string_view text, SurfaceBuilder& builder)
      : in_(text, Comments::none), builder_(builder) {}

  void read();

 private:
  Position here() const { return at_line(in_.line()); }
  std::string_view need(const char* what);
  void expect_word(std::string_view word);
  double read_number();
  void read_facet();
  std::string_view read_name() {
    const std::string_view name = in_.rest_of_line();
    std::string_view token;
    while (in_.next_token(token)) {
    }
    return name;
  }

  TextLines in_;
  SurfaceBuilder& builder_;
  std::int32_t solid_ = 0;
};

std::string_view AsciiStlReader::need(const char* what) {
  std::string_view token;
  if (!in_.next_token_anywhere(token)) {
    fail(here(), std::string("the file ends where ") + what + " is expected");
  }
  return token;
}

void AsciiStlReader::expect_word(std::string_view word) {
  const std::string quoted_word = in_quotes(word);
  const std::string_view token = need(quoted_word.c_str());
  if (!equal_ignoring_case(token, word)) {
    fail(here(), in_quotes(token) + " instead of " + quoted_word);
  }
}

double AsciiStlReader::read_number() {
  const std::string_view token = need("a coordinate");
  double value = 0;
  const NumberStatus status = parse_double(token, value);
  if (status == NumberStatus::malformed) fail(here(), "bad number " + in_quotes(token));
  if (status == NumberStatus::not_finite) {
    fail(here(), "non-finite coordinate " + in_quotes(token));
  }
  return value;
}

void AsciiStlReader::read_facet() {
  const Position facet = here();
  expect_word("normal");
  // The normal is not needed, and may be any text ("-nan(ind)" occurs).
  while (!equal_ignoring_case(need("'outer'"), "outer")) {
    if (in_.line() > facet.number + 1) fail(here(), "'outer loop' missing after 'facet normal'");
  }
  expect_word("loop");
  std::array<std::uint32_t, 3> corners;
  for (std::uint32_t& corner : corners) {
    expect_word("vertex");
    const double x = read_number(), y = read_number(), z = read_number();
    corner = static_cast<std::uint32_t>(builder_.vertex_count());
    builder_.add_vertex(x, y, z, here());
  }
  expect_word("endloop");
  expect_word("endfacet");
  builder_.add_polygon(corners, solid_, facet);
}

void AsciiStlReader::read() {
  std::string_view token;
  bool open = false;
  while (in_.next_token_anywhere(token)) {
    if (!open && equal_ignoring_case(token, "solid")) {
      open = true;
      builder_.name_label(++solid_, read_name());
    } else if (open && equal_ignoring_case(token, "facet")) {
      read_facet();
    } else if (open && equal_ignoring_case(token, "endsolid")) {
      open = false;
      read_name();
    } else {
      fail(here(), "unexpected " + in_quotes(token));
    }
  }
  if (open) fail(here(), "the file ends without 'endsolid'");
  if (solid_ < 2) return builder_.forget_labels();
  builder_.note(std::to_string(solid_) + " solids, labelled in their order from 1");
}

}  // namespace

bool looks_like_stl(std::string_view data) {
  return has_binary_size(data) || is_text(data);
}

void read_stl(std::string_view data, SurfaceBuilder& builder) {
  if (!has_binary_size(data) && is_text(data)) {
    AsciiStlReader(data, builder).read();
  } else {
    read_binary(data, builder);
  }
  builder.weld();
}

}  // namespace delmesher::io
