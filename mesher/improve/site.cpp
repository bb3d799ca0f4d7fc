#include "mesher/improve/site.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace delmesher::improve {
namespace {

using Side = std::pair<TetId, int>;  // a face of a tetrahedron

// Faces of the surface at an edge of t, each once: around the edge, and if that ends at the hull,
// also the other way round.
std::vector<Side> walls_around(const MeshTopology& mesh, TetId t, VertexId a, VertexId b) {
  const auto [first, last] = opposite_edge(mesh.index_of(t, a), mesh.index_of(t, b));
  const bool begin = first < last;
  std::vector<Side> walls;
  for (const bool forwards : {begin, !begin}) {
    TetId u = t;
    do {
      const auto [x, y] = opposite_edge(mesh.index_of(u, a), mesh.index_of(u, b));
      const int out = forwards ? x : y;
      if (mesh.facet(u, out) != kNone) walls.emplace_back(u, out);
      u = mesh.neighbor(u, out);
    } while (u != t && u != kNone);
    if (u == t) break;
  }
  return walls;
}

}  // namespace

std::optional<Site> site_on_edge(const State& state, TetId t, int i, int j) {
  const VertexId a = state.mesh.tet(t)[i], b = state.mesh.tet(t)[j];
  const std::vector<Side> walls = walls_around(state.mesh, t, a, b);
  if (walls.size() != 2) return std::nullopt;
  Site site;
  for (int k = 0; k < 2; ++k) site.facet[k] = state.mesh.facet(walls[k].first, walls[k].second);
  if (site.facet[0] == site.facet[1]) {
    site.mobility = Mobility::in_plane;
    site.axis = state.face_normal(walls[0].first, walls[0].second);
  } else {
    site.mobility = Mobility::on_line;
    site.axis = subtract(state.position(b), state.position(a));
    site.piece = {std::min(a, b), std::max(a, b)};
    site.input_edge = state.input_edge_of(a, b);
    if (site.input_edge == kNone) return std::nullopt;
  }
  return to_unit_length(site.axis) ? std::optional(site) : std::nullopt;
}

std::optional<Site> site_on_face(const State& state, TetId t, int i) {
  Site site;
  site.mobility = Mobility::in_plane;
  site.facet[0] = state.mesh.facet(t, i);
  if (site.facet[0] == kNone) return std::nullopt;
  site.axis = state.face_normal(t, i);
  return to_unit_length(site.axis) ? std::optional(site) : std::nullopt;
}

}  // namespace delmesher::improve
