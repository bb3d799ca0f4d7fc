#include "mesher/improve/shortening.h"

#include <algorithm>
#include <cmath>

namespace delmesher::improve {

// Queues the edges of t that are too long. Edges with several tetrahedra come several times.
void Shortening::note(TetId t) {
  if (!state_.counts(t)) return;
  const Tet& v = state_.mesh.tet(t);
  for (const auto& [i, j] : kEdge) {
    const Vec3 &x = state_.position(v[i]), &y = state_.position(v[j]);
    if (!state_.too_long(x, y, state_.mesh.region(t))) continue;
    queue_.push({squared_norm(subtract(y, x)), std::min(v[i], v[j]), std::max(v[i], v[j])});
  }
}

// False if it is gone, or on the surface or the hull.
bool Shortening::find_ring(const Edge& edge) {
  const MeshTopology& mesh = state_.mesh;
  ring_.clear();
  if (mesh.incident(edge.a) == kNone || mesh.incident(edge.b) == kNone) return false;
  mesh.star(edge.a, star_);
  for (const TetId t : star_) {
    if (mesh.index_of(t, edge.b) < 0) continue;
    ring_.push_back(t);
    for (int i = 0; i < 4; ++i) {
      const VertexId v = mesh.tet(t)[i];
      if (v == edge.a || v == edge.b) continue;
      if (mesh.facet(t, i) != kNone || mesh.neighbor(t, i) == kNone) return false;
    }
  }
  return !ring_.empty();
}

bool Shortening::split(const Edge& edge) {
  constexpr double kShorter = 0.95;
  const Vec3 &a = state_.position(edge.a), &b = state_.position(edge.b);
  const double length = std::sqrt(edge.squared);
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = (a[k] + b[k]) / 2;
  const Place place = state_.new_place(x, length * State::kGrid);
  created_.clear();
  const bool fits = std::ranges::all_of(ring_, [&](TetId t) {
    const Tet& tet = state_.mesh.tet(t);
    for (const VertexId end : {edge.a, edge.b}) {
      const int i = state_.mesh.index_of(t, end);
      if (!state_.is_positive_with(tet, i, place)) return false;
      created_.push_back({tet, state_.mesh.region(t)});
      created_.back().vertices[i] = kNone;
    }
    return std::ranges::all_of(tet, [&](VertexId v) {
      const Vec3& end = state_.position(v);
      return !state_.too_long(place.position, end, state_.mesh.region(t)) ||
             distance(place.position, end) < kShorter * length;
    });
  });
  if (!fits) {
    state_.forget(place);
    return false;
  }
  state_.insert(place, ring_, created_);
  return true;
}

std::size_t Shortening::run() {
  for (TetId t = 0; t < state_.mesh.slots(); ++t) {
    if (state_.mesh.alive(t)) note(t);
  }
  std::size_t points = 0;
  while (!queue_.empty()) {
    const Edge edge = queue_.top();
    queue_.pop();
    control_.poll(state_.mesh.vertices(), 0);
    if (!find_ring(edge) || !split(edge)) continue;
    ++points;
    for (const TetId t : state_.mesh.created()) note(t);
  }
  return points;
}

}  // namespace delmesher::improve
