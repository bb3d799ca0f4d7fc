#include "mesher/refine/facet_boundary.h"

#include <algorithm>
#include <utility>

#include "mesher/base/check.h"

namespace delmesher::refine {
namespace {

constexpr auto kEnds = [](const DirectedSide& side) { return std::pair{side.from, side.to}; };

}  // namespace

FacetBoundary::FacetBoundary(std::vector<DirectedSide> sides) : sides_(std::move(sides)) {
  std::ranges::sort(sides_, {}, kEnds);
}

const DirectedSide* FacetBoundary::find(VertexId from, VertexId to) const {
  const auto found = std::ranges::lower_bound(sides_, std::pair{from, to}, {}, kEnds);
  return found != sides_.end() && kEnds(*found) == std::pair{from, to} ? &*found : nullptr;
}

std::uint32_t FacetBoundary::find(VertexId from, VertexId to, bool* inward) const {
  const DirectedSide* side = find(from, to);
  *inward = side != nullptr;
  if (side == nullptr) side = find(to, from);
  return side != nullptr ? side->subsegment : kNone;
}

// Decided at the sides and flooded between them.
std::vector<std::uint8_t> FacetBoundary::inside(const PlanarTriangulation& planar) const {
  enum : std::uint8_t { kUndecided, kInside, kOutside };
  std::vector<std::uint8_t> place(planar.triangles.size(), kUndecided);
  std::vector<std::uint32_t> stack;
  std::size_t found = 0;
  const auto side_of = [&](std::uint32_t t, int i, bool* inward) {
    return find(planar.triangles[t][(i + 1) % 3], planar.triangles[t][(i + 2) % 3], inward);
  };
  for (std::uint32_t t = 0; t < planar.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      bool inward = false;
      if (side_of(t, i, &inward) == kNone) continue;
      found += inward ? 1 : 0;
      const std::uint8_t here = inward ? kInside : kOutside;
      if (place[t] == kUndecided) stack.push_back(t);
      DELMESHER_CHECK(place[t] == kUndecided || place[t] == here,
                      "the sides of a facet disagree about what is inside");
      place[t] = here;
    }
  }
  DELMESHER_CHECK(found == sides_.size(),
                  "a subsegment is not an edge of the triangulation of its facet");
  while (!stack.empty()) {
    const std::uint32_t t = stack.back();
    stack.pop_back();
    for (int i = 0; i < 3; ++i) {
      bool inward = false;
      const std::uint32_t next = planar.neighbors[t][i];
      if (next == kNone || side_of(t, i, &inward) != kNone || place[next / 3] != kUndecided) {
        continue;
      }
      place[next / 3] = place[t];
      stack.push_back(next / 3);
    }
  }
  for (std::uint8_t& p : place) p = p == kInside ? 1 : 0;
  return place;
}

}  // namespace delmesher::refine
