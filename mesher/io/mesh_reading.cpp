#include "mesher/io/mesh_reading.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
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

namespace {

using Point = std::array<double, 3>;

// How far a point is from the middle between two others, as a fraction of their distance; both in
// the largest coordinate.
double off_the_middle(const Point& p, const Point& a, const Point& b) {
  double off = 0, length = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    off = std::max(off, std::fabs(p[i] - (a[i] / 2 + b[i] / 2)));
    length = std::max(length, std::fabs(a[i] - b[i]));
  }
  return off == 0 ? 0 : off / length;
}

// Below this, programs that write few digits mean the middle.
constexpr double kStraight = 1e-6;

}  // namespace

// Formats number edges in different orders, and corners are all that is used: the nearest edge it
// is.
void MeshBuilder::add_edge_nodes(std::span<const std::uint32_t> corners,
                                 std::span<const std::uint32_t> nodes) {
  if (nodes.empty()) return;
  is_edge_node_.resize(mesh_.vertices.size());
  double worst = 0;
  for (const std::uint32_t node : nodes) {
    is_edge_node_[node] = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        nearest = std::min(nearest, off_the_middle(mesh_.vertices[node], mesh_.vertices[corners[i]],
                                                   mesh_.vertices[corners[j]]));
      }
    }
    worst = std::max(worst, nearest);
  }
  if (worst <= kStraight) return;
  ++curved_;
  farthest_ = std::max(farthest_, worst);
}

void MeshBuilder::take_out_edge_nodes() {
  std::vector<std::uint32_t> number(mesh_.vertices.size());
  std::vector<Point> vertices;
  is_edge_node_.resize(number.size());
  for (std::size_t v = 0; v < number.size(); ++v) {
    number[v] = static_cast<std::uint32_t>(vertices.size());
    if (!is_edge_node_[v]) vertices.push_back(mesh_.vertices[v]);
  }
  const auto renumber = [&](auto& cells) {
    for (auto& cell : cells) {
      for (std::uint32_t& v : cell) {
        if (is_edge_node_[v]) {
          fail({}, "node " + std::to_string(v) + " (numbered from 0) is a corner of an element, " +
                       "and of another one in the middle of an edge");
        }
        v = number[v];
      }
    }
  };
  renumber(mesh_.tetrahedra);
  renumber(mesh_.boundary);
  mesh_.vertices = std::move(vertices);
  if (curved_ == 0) return;
  char share[32];
  std::snprintf(share, sizeof share, "%.3g", farthest_);
  warnings_.push_back(std::to_string(curved_) + " curved elements: nodes are up to " + share +
                      " of an edge's length off its middle, and the edges are taken as straight");
}

TetMesh MeshBuilder::finish() {
  if (order() == 2) take_out_edge_nodes();
  // Regions that are the two sides, and are called so, say nothing more than `inside`.
  const auto is_named = [&](std::int32_t region, const char* side) {
    const auto found = region_names_.find(region);
    return found != region_names_.end() && found->second != side;
  };
  const bool solid = is_named(kRegionInside, "inside"), rest = is_named(kRegionOutside, "outside");
  bool told = false;
  for (std::size_t t = 0; t < mesh_.regions.size(); ++t) {
    const bool inside = mesh_.inside[t] != 0;
    told |=
        mesh_.regions[t] != (inside ? kRegionInside : kRegionOutside) || (inside ? solid : rest);
  }
  if (!told) mesh_.regions.clear();
  choose_facets();
  return std::move(mesh_);
}

void MeshBuilder::choose_facets() {
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
}

}  // namespace delmesher::io
