// Where a new vertex can be put in on the surface: in a facet, or on an edge between two.
#pragma once

#include <array>
#include <optional>

#include "mesher/improve/state.h"

namespace delmesher::improve {

struct Site {
  Mobility mobility = Mobility::free;  // of the vertex: free if the site is not on the surface
  std::array<FacetId, 2> facet = {kNone, kNone};
  Vec3 axis{};  // of allowed_offset()
  // On an edge only: the piece of it that is split, its smaller vertex first, and the edge.
  std::array<VertexId, 2> piece = {kNone, kNone};
  std::uint32_t input_edge = kNone;
};

// Nothing if edge i-j of t is not on the surface, more than two of its faces are at the edge, or
// the points of the edge of the surface are given by two parameters.
std::optional<Site> site_on_edge(const State& state, TetId t, int i, int j);
// Nothing if face i of t is not on the surface, or has no area.
std::optional<Site> site_on_face(const State& state, TetId t, int i);

}  // namespace delmesher::improve
