// Triangles as the arrangement takes them, and what their edges say.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof::unite {

using Index = std::uint32_t;
inline constexpr Index kNone = 0xffffffffU;
using Position = std::array<double, 3>;
using Triangle = std::array<Index, 3>;

struct Soup {
  std::vector<Position> vertices;            // no two are equal, and each is a corner
  std::vector<Triangle> triangles;           // of three corners that are not on one line
  std::vector<std::int32_t> labels;          // per triangle
  std::uint64_t welded = 0, degenerate = 0;  // vertices, triangles that are gone
};

// Why the triangles of a surface are none; empty if they are.
std::string defect_of_lists(const delmesher::Surface& surface);

// Equal vertices become one, and triangles without area go (exactly). Where such a triangle joined
// two parts of an edge with the whole, these parts and the whole meet, so that the arrangement
// closes what is left open.
Soup soup_of(const delmesher::Surface& surface);

delmesher::Surface surface_of(const Soup& soup);

double largest_coordinate(const Soup& soup);  // its absolute value
double diagonal(const Soup& soup);            // of the box around it, which is not empty

// Signed, and rounded.
double volume(const Soup& soup);

struct EdgeUse {
  Index low, high;  // the vertices
  Index triangle;
  bool forward;  // does the triangle go from low to high?
};

// The edges of some triangles, one after another.
class Edges {
 public:
  explicit Edges(std::span<const Triangle> triangles);
  // Calls visit(std::span<const EdgeUse>) for each edge.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t first = 0, last = 0; first < uses_.size(); first = last) {
      while (last < uses_.size() && same_edge(uses_[first], uses_[last])) ++last;
      visit(std::span(uses_).subspan(first, last - first));
    }
  }

 private:
  static bool same_edge(const EdgeUse& a, const EdgeUse& b) {
    return a.low == b.low && a.high == b.high;
  }
  std::vector<EdgeUse> uses_;
};

// Sets of triangles that are connected over edges.
std::uint64_t count_bodies(std::span<const Triangle> triangles);

// Where parts of closed triangles touch.
struct Touching {
  std::uint64_t edges = 0;     // of more than two triangles
  std::uint64_t vertices = 0;  // not on such an edge, around which the triangles form several fans
  Index place = kNone;         // a vertex of the first edge or, if there is none, the first vertex
};
Touching find_touching(std::span<const Triangle> triangles);

}  // namespace tetproof::unite
