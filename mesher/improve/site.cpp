#include "mesher/improve/site.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace delmesher::improve {
namespace {

using Side = std::pair<TetId, int>;  // a face of a tetrahedron

Vec3 normal_of(const State& state, const Side& side) {
  const Tet& v = state.mesh.tet(side.first);
  const auto at = [&](int k) -> const Vec3& { return state.position(v[kFace[side.second][k]]); };
  return cross(subtract(at(1), at(0)), subtract(at(2), at(0)));
}

bool to_unit_length(Vec3& x) {
  const double length = norm(x);
  for (double& k : x) k /= length;
  return length > 0;
}

// The vertices of t that are neither a nor b.
std::array<int, 2> others(const Tet& t, VertexId a, VertexId b) {
  std::array<int, 2> other{};
  int n = 0;
  for (int k = 0; k < 4; ++k) {
    if (t[k] != a && t[k] != b) other[n++] = k;
  }
  return other;
}

// Faces of the surface at an edge of t, each once. From t around the edge, through its face `out`
// first; if that ends at the hull, also the other way round.
std::vector<Side> walls_around(const WorkMesh& mesh, TetId t, VertexId a, VertexId b) {
  std::vector<Side> walls;
  for (const int start : others(mesh.tet(t), a, b)) {
    TetId u = t;
    int out = start;
    do {
      if (mesh.facet(u, out) != kNone) walls.emplace_back(u, out);
      const TetId next = mesh.neighbor(u, out);
      if (next == kNone) break;
      const auto [x, y] = others(mesh.tet(next), a, b);
      out = x == mesh.mirror(u, out) ? y : x;
      u = next;
    } while (u != t);
    if (mesh.neighbor(u, out) != kNone) break;
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
    site.axis = normal_of(state, walls[0]);
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
  site.axis = normal_of(state, {t, i});
  return to_unit_length(site.axis) ? std::optional(site) : std::nullopt;
}

}  // namespace delmesher::improve
