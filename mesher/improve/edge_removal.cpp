#include "mesher/improve/edge_removal.h"

#include <algorithm>
#include <cmath>

namespace delmesher::improve {

bool EdgeRemoval::run(TetId t, int i, int j, std::span<const std::uint32_t> failed) {
  a_ = state_.mesh.tet(t)[i];
  b_ = state_.mesh.tet(t)[j];
  longest_ = kLongest;
  if (!find_ring(t, failed) || !split_ring()) return false;
  aim_ = Aim::best_worst;
  least_ = state_.to_be_better(state_.worst_of(ring_));
  return refill(-HUGE_VAL);
}

bool EdgeRemoval::flip(TetId t, int i, int j) {
  a_ = state_.mesh.tet(t)[i];
  b_ = state_.mesh.tet(t)[j];
  longest_ = kLongest;
  aim_ = Aim::best_worst;
  least_ = {};
  return find_ring(t, {}) && split_ring() && !faces_.empty() && refill(-HUGE_VAL);
}

bool EdgeRemoval::round_off(TetId t, int i, int j, std::span<const std::uint32_t> failed) {
  // Of a change, so that many that bring nothing do not follow each other.
  constexpr double kLeastGain = 0.02;
  a_ = state_.mesh.tet(t)[i];
  b_ = state_.mesh.tet(t)[j];
  for (const int k : opposite_edge(i, j)) {  // most rings are known by one of these
    if (is_known(state_.mesh.neighbor(t, k), failed)) return false;
  }
  const auto is_on_surface = [&](VertexId v) { return state_.mobility(v) != Mobility::free; };
  longest_ = is_on_surface(a_) && is_on_surface(b_) ? kLongestForRoundness : kLargestForRoundness;
  if (!find_ring(t, failed) || !split_ring()) return false;
  if (std::ranges::any_of(polygons_,
                          [](const Polygon& p) { return p.size > kLargestForRoundness; })) {
    return false;
  }
  aim_ = Aim::roundest;
  least_ = state_.to_be_acceptable(state_.worst_of(ring_));
  double before = 0;
  for (const TetId u : ring_) {
    if (state_.counts(u)) before += roundness(state_.quality(u));
  }
  return refill(before + kLeastGain);
}

// Fills all polygons, if that is rounder than this.
bool EdgeRemoval::refill(double least_roundness) {
  created_.clear();
  double sum = 0;
  for (Polygon& polygon : polygons_) {
    const Filling filling = triangulate(polygon);
    if (!(filling.worst.dihedral > 0)) return false;
    sum += filling.roundness;
    collect(polygon);
  }
  if (!(sum > least_roundness)) return false;
  for (const CreatedTet& tet : created_) {
    if (!state_.is_positive(tet.vertices)) return false;
  }
  state_.replace(ring_, created_, faces_);
  return true;
}

// Finds the ring around the edge. False if it is too long, or if the edge may not go or has been
// tried.
bool EdgeRemoval::find_ring(TetId t, std::span<const std::uint32_t> failed) {
  if (!collect_ring(t, failed)) return false;
  const bool closed = vertex_.size() == ring_.size();
  if (closed) return ring_.size() >= 3;
  const TetId first = beginning(t);
  return first == t || (first != kNone && collect_ring(first, failed));
}

// Has a-b been tried from t, and no tetrahedron at a or none at b has changed since?
bool EdgeRemoval::is_known(TetId t, std::span<const std::uint32_t> failed) const {
  return t < failed.size() &&
         (failed[t] > state_.changed_at(a_) || failed[t] > state_.changed_at(b_));
}

// From `first` on, so that (a, b, vertex[n], vertex[n + 1]) is the n-th tetrahedron.
bool EdgeRemoval::collect_ring(TetId first, std::span<const std::uint32_t> failed) {
  const MeshTopology& mesh = state_.mesh;
  ring_.clear();
  vertex_.clear();
  facet_.clear();
  FacetId only = kNone;
  for (TetId u = first; u != first || ring_.empty();) {
    if (ring_.size() == longest_ || is_known(u, failed)) return false;
    const auto [x, y] = opposite_edge(mesh.index_of(u, a_), mesh.index_of(u, b_));
    const FacetId facet = mesh.facet(u, y);
    // An edge between two facets stays.
    if (facet != kNone && only != kNone && facet != only) return false;
    if (facet != kNone) only = facet;
    ring_.push_back(u);
    vertex_.push_back(mesh.tet(u)[x]);
    facet_.push_back(facet);
    const TetId next = mesh.neighbor(u, x);
    if (next == kNone) {
      vertex_.push_back(mesh.tet(u)[y]);
      facet_.push_back(mesh.facet(u, x));
      return true;
    }
    u = next;
  }
  return true;
}

// The first tetrahedron of an open ring; kNone if it is too far away.
TetId EdgeRemoval::beginning(TetId t) const {
  const MeshTopology& mesh = state_.mesh;
  for (int steps = 0; steps <= static_cast<int>(longest_); ++steps) {
    const auto [x, y] = opposite_edge(mesh.index_of(t, a_), mesh.index_of(t, b_));
    const TetId previous = mesh.neighbor(t, y);
    if (previous == kNone) return t;
    t = previous;
  }
  return kNone;
}

// Into the polygons between faces of the surface. False if the edge may not go.
bool EdgeRemoval::split_ring() {
  const std::size_t n = ring_.size();
  const bool open = vertex_.size() > n;
  std::vector<std::size_t>& walls = walls_;
  walls.clear();
  for (std::size_t k = 0; k < vertex_.size(); ++k) {
    if (facet_[k] != kNone) walls.push_back(k);
  }
  polygons_.clear();
  faces_.clear();
  const auto polygon = [&](std::size_t from, std::size_t steps) {
    Polygon p;
    p.size = static_cast<int>(steps) + 1;
    p.region = state_.mesh.region(ring_[from]);
    for (std::size_t k = 0; k <= steps; ++k) p.vertex[k] = vertex_[(from + k) % vertex_.size()];
    polygons_.push_back(p);
  };
  if (walls.empty()) {
    if (open) return false;
    polygon(0, n - 1);
    return true;
  }
  if (walls.size() != 2 || facet_[walls[0]] != facet_[walls[1]]) return false;
  if (open && (walls[0] != 0 || walls[1] != n)) return false;
  polygon(walls[0], walls[1] - walls[0]);
  if (!open) polygon(walls[1], n - (walls[1] - walls[0]));
  const VertexId x = vertex_[walls[0]], y = vertex_[walls[1]];
  faces_ = {{{a_, x, y}, facet_[walls[0]]}, {{b_, x, y}, facet_[walls[0]]}};
  return true;
}

// Above 0 for tetrahedra rounder than kMean, which raise the mean; of the others, fewer are better.
double EdgeRemoval::roundness(const Quality& q) {
  constexpr double kMean = 0.65;
  return std::sqrt(q.gamma) - kMean;
}

bool EdgeRemoval::improves(const Filling& filling, const Filling& best) const {
  return aim_ == Aim::best_worst ? state_.score(filling.worst) > state_.score(best.worst)
                                 : !(best.worst.dihedral > 0) || filling.roundness > best.roundness;
}

// Two tetrahedra, towards a and b, for each triangle of the polygon: the best filling among those
// that reach the quality required (Klincsek's dynamic program).
EdgeRemoval::Filling EdgeRemoval::triangulate(Polygon& polygon) {
  const int n = polygon.size;
  const bool counts = state_.counts_in(polygon.region);
  const bool weighs_roundness = counts && aim_ == Aim::roundest;
  const bool is_diagonal = !faces_.empty();  // of a facet: the edge from first to last is new, too
  const Quality least = counts ? least_ : Quality{};
  auto& best = best_;
  for (int i = 0; i + 1 < n; ++i) best[i][i + 1] = {kNotCounted, 0};
  for (int width = 2; width < n; ++width) {
    for (int i = 0; i + width < n; ++i) {
      const int j = i + width;
      best[i][j] = {};
      const bool is_new = width < n - 1 || is_diagonal;
      if (counts && is_new &&
          state_.too_long(state_.position(polygon.vertex[i]), state_.position(polygon.vertex[j]))) {
        continue;
      }
      for (int k = i + 1; k < j; ++k) {
        Filling filling = {worse(best[i][k].worst, best[k][j].worst),
                           best[i][k].roundness + best[k][j].roundness};
        const auto fails = [&] {
          const Quality& q = filling.worst;
          return !(q.dihedral > 0) || !State::reaches(q, least) ||
                 (aim_ == Aim::best_worst && !improves(filling, best[i][j]));
        };
        const auto& v = polygon.vertex;
        const auto add = [&](const Tet& tet) {
          const Quality q = state_.quality_of(tet, least);
          filling.worst = worse(filling.worst, q);
          if (weighs_roundness) filling.roundness += roundness(q);
          return !fails();
        };
        if (fails() || !add({v[i], v[k], v[j], b_}) || !add({v[k], v[i], v[j], a_})) continue;
        if (!improves(filling, best[i][j])) continue;
        best[i][j] = filling;
        polygon.middle[i][j] = static_cast<std::int8_t>(k);
        if (!counts) break;
      }
    }
  }
  return best[0][n - 1];
}

void EdgeRemoval::collect(const Polygon& polygon) {
  std::array<std::array<int, 2>, 2 * kLongest> open;
  int count = 0;
  open[count++] = {0, polygon.size - 1};
  while (count > 0) {
    const auto [i, j] = open[--count];
    if (j == i + 1) continue;
    const int k = polygon.middle[i][j];
    const auto& v = polygon.vertex;
    created_.push_back({{v[i], v[k], v[j], b_}, polygon.region});
    created_.push_back({{v[k], v[i], v[j], a_}, polygon.region});
    open[count++] = {i, k};
    open[count++] = {k, j};
  }
}

}  // namespace delmesher::improve
