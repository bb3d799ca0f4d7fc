#include "mesher/improve/shortening.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/sort_unique.h"

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

// False if it is gone, or on the hull, or on a surface that is to be kept.
bool Shortening::find_ring(const Edge& edge) {
  const MeshTopology& mesh = state_.mesh;
  ring_.clear();
  walls_.clear();
  if (mesh.incident(edge.a) == kNone || mesh.incident(edge.b) == kNone) return false;
  mesh.star(edge.a, star_);
  for (const TetId t : star_) {
    if (mesh.index_of(t, edge.b) < 0) continue;
    ring_.push_back(t);
    const auto [i, j] = opposite_edge(mesh.index_of(t, edge.a), mesh.index_of(t, edge.b));
    for (const auto& [face, third] : {std::pair(i, j), std::pair(j, i)}) {
      if (mesh.facet(t, face) != kNone) {
        walls_.emplace_back(mesh.tet(t)[third], mesh.facet(t, face));
      } else if (mesh.neighbor(t, face) == kNone) {
        return false;
      }
    }
  }
  sort_unique(walls_);
  return !ring_.empty() && (walls_.empty() || (on_surface_ && state_.has_places_on_surface()));
}

Mobility Shortening::mobility() const {
  if (walls_.empty()) return Mobility::free;
  return walls_.size() == 2 && walls_[0].second == walls_[1].second ? Mobility::in_plane
                                                                    : Mobility::on_line;
}

std::optional<Place> Shortening::middle(const Edge& edge) const {
  // Of the length: so fine that halves of flat tetrahedra stay positive.
  constexpr double kGrid = 0x1p-30;
  const Vec3 &a = state_.position(edge.a), &b = state_.position(edge.b);
  const double tolerance = std::sqrt(edge.squared) * kGrid;
  Vec3 x;
  for (int k = 0; k < 3; ++k) x[k] = (a[k] + b[k]) / 2;
  switch (mobility()) {
    case Mobility::in_plane:
      return state_.place_in_facet(walls_.front().second, x, tolerance);
    case Mobility::on_line: {
      const std::uint32_t input_edge = state_.input_edge_of(edge.a, edge.b);
      if (input_edge == kNone) return std::nullopt;
      return state_.place_on_input_edge(input_edge, x, tolerance);
    }
    default:
      return state_.new_place(x, tolerance);
  }
}

bool Shortening::split(const Edge& edge) {
  constexpr double kShorter = 0.95;
  const double length = std::sqrt(edge.squared);
  const std::optional<Place> place = middle(edge);
  if (!place) return false;
  created_.clear();
  const bool fits = std::ranges::all_of(ring_, [&](TetId t) {
    const Tet& tet = state_.mesh.tet(t);
    for (const VertexId end : {edge.a, edge.b}) {
      const int i = state_.mesh.index_of(t, end);
      if (!state_.is_positive_with(tet, i, *place)) return false;
      created_.push_back({tet, state_.mesh.region(t)});
      created_.back().vertices[i] = kNone;
    }
    return std::ranges::all_of(tet, [&](VertexId v) {
      const Vec3& end = state_.position(v);
      return !state_.too_long(place->position, end, state_.mesh.region(t)) ||
             distance(place->position, end) < kShorter * length;
    });
  });
  if (!fits) {
    state_.forget(*place);
    return false;
  }
  faces_.clear();
  for (const auto& [third, facet] : walls_) {
    for (const VertexId end : {edge.a, edge.b}) faces_.push_back({{end, third, kNone}, facet});
  }
  const FacetId facet = walls_.empty() ? kNone : walls_.front().second;
  state_.insert_on_surface(*place, mobility(), facet, ring_, created_, faces_);
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
