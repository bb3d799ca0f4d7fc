#include "mesher/io/mesh_reading.h"

#include <algorithm>
#include <map>
#include <utility>

#include "mesher/io/write_formats.h"

namespace delmesher::io {

void MeshText::fail(const std::string& reason) const {
  throw FileError{file_ + ":" + std::to_string(line()) + ": " + reason};
}

std::string_view MeshText::word() {
  polling_.poll();
  std::string_view token;
  return lines_.next_token_anywhere(token) ? token : std::string_view();
}

std::string_view MeshText::need(const char* what) {
  const std::string_view token = word();
  if (token.empty()) fail("the file ends where " + std::string(what) + " is expected");
  return token;
}

std::string_view MeshText::word_in_line() {
  polling_.poll();
  std::string_view token;
  return lines_.next_token(token) ? token : std::string_view();
}

std::string_view MeshText::take_rest_of_line() {
  const std::string_view rest = lines_.rest_of_line();
  while (!word_in_line().empty()) {
  }
  return rest;
}

double MeshText::finite(std::string_view token) const {
  double x = 0;
  const NumberStatus status = parse_double(token, x);
  if (status == NumberStatus::malformed) fail("bad number " + in_quotes(token));
  if (status == NumberStatus::not_finite) fail("non-finite coordinate " + in_quotes(token));
  return x;
}

std::array<double, 3> MeshText::point() {
  std::array<double, 3> p;
  for (double& x : p) x = coordinate();
  return p;
}

std::string_view MeshText::bytes(std::size_t count, const char* what) {
  polling_.poll();
  std::string_view bytes;
  if (!lines_.take_bytes(count, bytes)) {
    fail("the file ends where " + std::string(what) + " is expected");
  }
  return bytes;
}

std::uint64_t MeshText::count(const char* what, std::uint64_t most, std::uint64_t bytes) {
  return count(integer<std::uint64_t>(what), what, most, bytes);
}

std::uint64_t MeshText::count(std::uint64_t n, const char* what, std::uint64_t most,
                              std::uint64_t bytes) {
  if (n > most) fail(std::to_string(n) + " is too large a " + what);
  // The last item need have no line end; the rest of this line counts, too.
  if (n > (lines_.remaining() + lines_.rest_of_line().size() + 1) / bytes) {
    fail("the file is too short for the " + std::string(what) + " " + std::to_string(n));
  }
  return n;
}

std::uint32_t MeshText::vertex(std::string_view token, std::uint64_t first,
                               std::uint64_t vertices) const {
  const auto v = parsed<std::uint64_t>(token, "vertex index");
  if (v < first || v - first >= vertices) {
    fail("vertex index out of range: " + std::to_string(v) + " of " + std::to_string(vertices) +
         " (numbered from " + std::to_string(first) + ")");
  }
  return static_cast<std::uint32_t>(v - first);
}

void MeshText::skip(std::uint64_t tokens) {
  for (; tokens > 0; --tokens) need("a number");
}

void MeshBuilder::add_tetrahedron(const std::array<std::uint32_t, 4>& t,
                                  std::optional<std::int32_t> region, bool inside) {
  mesh_.tetrahedra.push_back(t);
  mesh_.inside.push_back(inside ? 1 : 0);
  mesh_.regions.push_back(region.value_or(inside ? kRegionInside : kRegionOutside));
}

void MeshBuilder::add_triangle(const std::array<std::uint32_t, 3>& t, std::int32_t label,
                               std::optional<std::uint32_t> facet) {
  mesh_.boundary.push_back(t);
  mesh_.boundary_labels.push_back(label);
  mesh_.boundary_facets.push_back(facet.value_or(0));
  all_facets_ &= facet.has_value();
}

void MeshBuilder::set_facets(std::vector<std::uint32_t> facets) {
  mesh_.boundary_facets = std::move(facets);
  all_facets_ = true;
}

TetMesh MeshBuilder::finish() {
  bool told = false;
  for (std::size_t t = 0; t < mesh_.regions.size(); ++t) {
    told |= mesh_.regions[t] != (mesh_.inside[t] != 0 ? kRegionInside : kRegionOutside);
  }
  if (!told) mesh_.regions.clear();
  std::map<std::uint32_t, std::int32_t> label_of;
  bool one_label = all_facets_;
  std::map<std::int32_t, std::uint32_t> number;
  for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
    const std::int32_t label = mesh_.boundary_labels[n];
    number.try_emplace(label, static_cast<std::uint32_t>(number.size()));
    one_label =
        one_label && label_of.try_emplace(mesh_.boundary_facets[n], label).first->second == label;
  }
  if (!one_label) {
    for (std::size_t n = 0; n < mesh_.boundary.size(); ++n) {
      mesh_.boundary_facets[n] = number.at(mesh_.boundary_labels[n]);
    }
  }
  return std::move(mesh_);
}
}  // namespace delmesher::io
