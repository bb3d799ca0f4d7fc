#include "mesher/improve/smoothing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace delmesher::improve {

// Collects the star; false if v cannot move.
bool Smoothing::begin(VertexId v) {
  if (state_.mobility(v) == Mobility::fixed) return false;
  move_.begin(v);
  // The worst one first: it ends most attempts.
  std::vector<TetId>& star = move_.star();
  for (TetId& t : star) {
    if (state_.score(t) < state_.score(star[0])) std::swap(t, star[0]);
  }
  cone_.clear();
  const MeshTopology& mesh = state_.mesh;
  for (const TetId t : star) {
    const int i = move_.corner(t);
    const auto at = [&](int k) -> const Vec3& { return state_.position(mesh.tet(t)[kFace[i][k]]); };
    cone_.add(at(0), at(1), at(2), state_.counts(t));
  }
  cone_.finish();
  return find_axis();
}

// Of the neighbours, each as often as it has tetrahedra of the star; on the surface, of those
// there.
void Smoothing::find_center() {
  const MeshTopology& mesh = state_.mesh;
  double neighbours = 0;
  center_ = {0, 0, 0};
  const auto take = [&](VertexId w) {
    center_ = geometry::add(center_, state_.position(w));
    ++neighbours;
  };
  for (const TetId t : move_.star()) {
    const int i = move_.corner(t);
    for (int k = 0; k < 4; ++k) {
      if (k == i) continue;
      if (state_.mobility(move_.vertex()) == Mobility::free) {
        take(mesh.tet(t)[k]);
      } else if (mesh.facet(t, k) != kNone) {
        for (const int j : kFace[k]) {
          if (j != i) take(mesh.tet(t)[j]);
        }
      }
    }
  }
  for (double& x : center_) x /= neighbours;
}

// The normal of the facet that v is in, or the direction of the edge that it is on.
bool Smoothing::find_axis() {
  axis_ = {};
  const VertexId v = move_.vertex();
  if (state_.mobility(v) == Mobility::free) return true;
  if (state_.mobility(v) == Mobility::on_line) {
    const PointDefinition d = state_.points().definition(state_.point(v));
    axis_ = state_.points().difference(d.corner[0], d.corner[1]);
  } else {
    for (const TetId t : move_.star()) {
      if (!state_.mesh.inside(t)) continue;
      for (int k = 0; k < 4; ++k) {
        if (k == move_.corner(t) || state_.mesh.facet(t, k) == kNone) continue;
        axis_ = geometry::add(axis_, state_.face_normal(t, k));
      }
    }
  }
  return to_unit_length(axis_);
}

// The part of a displacement that keeps v where it belongs.
Vec3 Smoothing::allowed(const Vec3& offset) const {
  return allowed_offset(state_.mobility(move_.vertex()), axis_, offset);
}

// From x to the apex that would make a tetrahedron of the star nearly regular.
Vec3 Smoothing::towards_best_apex(TetId t, const Vec3& x) const {
  return subtract(state_.best_apex_below(t, move_.corner(t)), x);
}

// The worst of the star with v at x; all 0 if it does not reach `least`.
Quality Smoothing::worst_at(const Vec3& x, const Quality& least) {
  if (!cone_.reaches(x, least)) return {};
  Quality worst = kNotCounted;
  float score = HUGE_VALF;
  for (std::size_t n = 0; n < move_.star().size(); ++n) {
    const Quality q = cone_.quality(n);
    if (state_.score(q) < score) {
      worst_ = n;
      score = state_.score(q);
    }
    worst = worse(worst, q);
  }
  return worst;
}

struct Smoothing::Judge {
  using Value = Quality;
  Smoothing& smoothing;
  bool any = false;  // was there a better candidate?

  bool value_at(const Vec3& x, const Quality& best, Quality& value) {
    value = smoothing.worst_at(x, smoothing.state_.to_be_better(best));
    any = any || value.dihedral > 0;
    return value.dihedral > 0;
  }
  static bool is_enough(const Quality&) { return false; }
  bool ends_with_failure() const { return any; }
};

bool Smoothing::improve_worst(VertexId v) {
  constexpr double kSteps[] = {0.5, 0.25, 0.125, 0.0625, 0.015625};
  if (!begin(v)) return false;
  find_center();
  Quality best = state_.worst_of(move_.star());
  const Quality least = state_.to_be_better(best);
  const Vec3 from = state_.position(v);
  Vec3 x = from;
  worst_ = 0;
  // Many small steps are for bad tetrahedra alone.
  const bool bad = state_.score(best) < State::kBad;
  const std::size_t steps = bad ? std::size(kSteps) : 3;
  const int rounds = bad ? 4 : 3;
  for (int round = 0; round < rounds; ++round) {
    const Vec3 here = x;
    Judge judge{*this};
    for (const Vec3& direction : {allowed(towards_best_apex(move_.star()[worst_], here)),
                                  allowed(subtract(center_, here))}) {
      std::array<Vec3, std::size(kSteps)> line;
      for (std::size_t n = 0; n < steps; ++n) line[n] = add_scaled(here, kSteps[n], direction);
      const Vec3* better = MoveVertex::find(std::span(line.data(), steps), judge, best);
      if (better != nullptr) x = *better;
    }
    if (!judge.any || state_.good(best)) break;
  }
  return x != from && commit(v, subtract(x, from), least, 0);
}

// The sum of the gammas of the star with v at x; 0 if it does not reach `least`.
double Smoothing::roundness_at(const Vec3& x, const Quality& least) {
  return cone_.reaches(x, least) ? sum_of_roundness() : 0;
}

// Of the cone as it was measured last.
double Smoothing::sum_of_roundness() const {
  double sum = 0;
  for (std::size_t n = 0; n < move_.star().size(); ++n) {
    if (cone_.counts(n)) sum += std::sqrt(cone_.quality(n).gamma);
  }
  return sum;
}

bool Smoothing::round_off(VertexId v) {
  constexpr double kLeastGain = 1.002;
  // A step below this, in lengths of edges, hardly ever gains so much.
  constexpr double kLeastStep = 0.02;
  if (!begin(v)) return false;
  const Vec3 x = state_.position(v);
  const Vec3 direction = allowed(subtract(cone_.average_apex(), x));
  if (!(squared_norm(direction) > kLeastStep * kLeastStep * cone_.average_squared_edge())) {
    return false;
  }
  const Quality least = state_.to_be_acceptable(state_.worst_of(move_.star()));
  double before = 0;
  for (const TetId t : move_.star()) {
    if (state_.counts(t)) before += std::sqrt(state_.quality(t).gamma);
  }
  if (!(before > 0)) return false;
  // Beyond the average first, since its neighbours will follow.
  for (const double step : {1.5, 1.0, 0.5, 0.25}) {
    const Vec3 offset = {step * direction[0], step * direction[1], step * direction[2]};
    const double sum = roundness_at(geometry::add(x, offset), least);
    if (sum > before * kLeastGain) return commit(v, offset, least, before);
    // Where the whole way is possible and gains little, a part of it seldom gains more.
    if (sum > 0 && step <= 1) return false;
  }
  return false;
}

// The star with v at x, exactly where it will be. False if it does not reach `least`.
bool Smoothing::measure_at(const Vec3& x, const Quality& least) {
  // Flatter or thinner ones are measured as they will be from then on: the cone's roundings are
  // other ones, and may be all that it sees of them.
  constexpr float kFlat = 1e-8F;
  if (!cone_.reaches(x, least)) return false;
  quality_.clear();
  for (std::size_t n = 0; n < move_.star().size(); ++n) {
    Quality q = cone_.quality(n);
    if (q.dihedral < kFlat || q.face < kFlat) {
      q = state_.quality_with(state_.mesh.tet(move_.star()[n]), move_.corner(move_.star()[n]), x,
                              least);
      if (!(q.dihedral > 0) || !State::reaches(q, least)) return false;
    }
    quality_.push_back(q);
  }
  return true;
}

// Moves v by the offset, or to a place a little beside, if its star then reaches `least`, and its
// roundness is above this.
bool Smoothing::commit(VertexId v, const Vec3& offset, const Quality& least, double roundness) {
  const double tolerance = move_.shortest_edge() * State::kGrid;
  if (!(tolerance > 0)) return false;
  const Place place = state_.moved(v, offset, tolerance);
  return settle(v, place, measure_at(place.position, least) && sum_of_roundness() > roundness);
}

bool Smoothing::becomes_too_long(TetId t, int i, const Vec3& x) const {
  if (!state_.edges_are_bounded()) return false;
  const Tet& tet = state_.mesh.tet(t);
  const RegionId region = state_.mesh.region(t);
  for (int k = 0; k < 4; ++k) {
    const Vec3& end = state_.position(tet[k]);
    if (k == i || !state_.counts(t) || !state_.too_long(x, end, region)) continue;
    const Vec3& before = state_.position(move_.vertex());
    if (squared_norm(subtract(end, x)) > squared_norm(subtract(end, before)) ||
        !state_.too_long(before, end, region)) {  // shorter, but nearer to where sizes are smaller
      return true;
    }
  }
  return false;
}

bool Smoothing::settle(VertexId v, const Place& place, bool ok) {
  ok = ok &&
       std::ranges::none_of(
           move_.star(),
           [&](TetId t) { return becomes_too_long(t, move_.corner(t), place.position); }) &&
       move_.fits(place);
  if (ok) {
    state_.move(v, place, move_.star(), quality_);
  } else {
    state_.forget(place);
  }
  return ok;
}

}  // namespace delmesher::improve
