#include "mesher/improve/smoothing.h"

#include <algorithm>
#include <cmath>

namespace delmesher::improve {

// Collects the star; false if v cannot move.
bool Smoothing::begin(VertexId v) {
  if (state_.mobility(v) == Mobility::fixed) return false;
  v_ = v;
  const WorkMesh& mesh = state_.mesh;
  mesh.star(v, star_);
  // The worst one first: it ends most attempts.
  for (TetId& t : star_) {
    if (state_.score(t) < state_.score(star_[0])) std::swap(t, star_[0]);
  }
  index_.clear();
  cone_.clear();
  double shortest2 = HUGE_VAL;
  for (const TetId t : star_) {
    const int i = mesh.index_of(t, v);
    index_.push_back(i);
    const auto at = [&](int k) -> const Vec3& { return state_.position(mesh.tet(t)[kFace[i][k]]); };
    cone_.add(at(0), at(1), at(2), state_.counts(t));
    for (int k = 0; k < 3; ++k) {
      shortest2 = std::min(shortest2, squared_norm(subtract(at(k), state_.position(v))));
    }
  }
  shortest_ = std::sqrt(shortest2);
  return shortest_ > 0 && find_axis();
}

// Of the neighbours, each as often as it has tetrahedra of the star; on the surface, of those
// there.
void Smoothing::find_center() {
  const WorkMesh& mesh = state_.mesh;
  double neighbours = 0;
  center_ = {0, 0, 0};
  const auto take = [&](VertexId w) {
    center_ = predicates::add(center_, state_.position(w));
    ++neighbours;
  };
  for (std::size_t n = 0; n < star_.size(); ++n) {
    const TetId t = star_[n];
    const int i = index_[n];
    for (int k = 0; k < 4; ++k) {
      if (k == i) continue;
      if (state_.mobility(v_) == Mobility::free) {
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
  if (state_.mobility(v_) == Mobility::free) return true;
  if (state_.mobility(v_) == Mobility::on_line) {
    const PointDefinition d = state_.points().definition(state_.point(v_));
    axis_ = state_.points().difference(d.corner[0], d.corner[1]);
  } else {
    for (std::size_t n = 0; n < star_.size(); ++n) {
      const TetId t = star_[n];
      if (!state_.mesh.inside(t)) continue;
      for (int k = 0; k < 4; ++k) {
        if (k == index_[n] || state_.mesh.facet(t, k) == kNone) continue;
        axis_ = predicates::add(axis_, state_.face_normal(t, k));
      }
    }
  }
  return to_unit_length(axis_);
}

// The part of a displacement that keeps v where it belongs.
Vec3 Smoothing::allowed(const Vec3& offset) const {
  return allowed_offset(state_.mobility(v_), axis_, offset);
}

// From x to the apex that would make a tetrahedron of the star nearly regular.
Vec3 Smoothing::towards_best_apex(TetId t, const Vec3& x) const {
  return subtract(state_.best_apex_below(t, state_.mesh.index_of(t, v_)), x);
}

// The average of that over the tetrahedra that count.
Vec3 Smoothing::towards_best_apexes(const Vec3& x) const {
  Vec3 sum{};
  double count = 0;
  for (const TetId t : star_) {
    if (!state_.counts(t)) continue;
    sum = predicates::add(sum, towards_best_apex(t, x));
    ++count;
  }
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

// The worst of the star with v at x; all 0 if it does not reach `least`.
Quality Smoothing::worst_at(const Vec3& x, const Quality& least) {
  if (!cone_.reaches(x, least)) return {};
  Quality worst = kNotCounted;
  float score = HUGE_VALF;
  for (std::size_t n = 0; n < star_.size(); ++n) {
    const Quality q = cone_.quality(n);
    if (state_.score(q) < score) {
      worst_ = n;
      score = state_.score(q);
    }
    worst = worse(worst, q);
  }
  return worst;
}

bool Smoothing::improve_worst(VertexId v) {
  constexpr double kSteps[] = {0.5, 0.25, 0.125, 0.0625, 0.015625};
  if (!begin(v)) return false;
  find_center();
  const Quality least = state_.to_be_better(state_.worst_of(star_));
  Quality best = state_.worst_of(star_);
  Vec3 x = state_.position(v);
  bool any = false;
  worst_ = 0;
  // Many small steps are for bad tetrahedra alone.
  const bool bad = state_.score(best) < State::kBad;
  const std::size_t steps = bad ? std::size(kSteps) : 3;
  const int rounds = bad ? 4 : 3;
  for (int round = 0; round < rounds; ++round) {
    const std::size_t worst = worst_;
    std::size_t best_worst = worst;
    Vec3 best_x = x;
    bool success = false;
    for (const Vec3& direction :
         {allowed(towards_best_apex(star_[worst], x)), allowed(subtract(center_, x))}) {
      for (const double step : std::span(kSteps, steps)) {
        const Vec3 candidate = add_scaled(x, step, direction);
        const Quality q = worst_at(candidate, any || success ? state_.to_be_better(best) : least);
        if (!(q.dihedral > 0)) {
          if (success) break;
          continue;
        }
        best = q;
        best_x = candidate;
        best_worst = worst_;
        success = true;
      }
    }
    worst_ = best_worst;
    if (!success) break;
    x = best_x;
    any = true;
    if (state_.good(best)) break;
  }
  return any && commit(v, subtract(x, state_.position(v)), least);
}

// The sum of the gammas of the star with v at x; 0 if it does not reach `least`.
double Smoothing::roundness_at(const Vec3& x, const Quality& least) {
  if (!cone_.reaches(x, least)) return 0;
  double sum = 0;
  for (std::size_t n = 0; n < star_.size(); ++n) {
    if (cone_.counts(n)) sum += std::sqrt(cone_.quality(n).gamma);
  }
  return sum;
}

bool Smoothing::round_off(VertexId v) {
  constexpr double kLeastGain = 1.002;
  if (!begin(v)) return false;
  const Quality least = state_.to_be_acceptable(state_.worst_of(star_));
  double before = 0;
  for (const TetId t : star_) {
    if (state_.counts(t)) before += std::sqrt(state_.quality(t).gamma);
  }
  if (!(before > 0)) return false;
  double best = before * kLeastGain;
  Vec3 best_offset{};
  bool any = false;
  const Vec3 x = state_.position(v);
  const Vec3 direction = allowed(towards_best_apexes(x));
  for (const double step : {1.0, 0.5, 0.25}) {
    const Vec3 offset = {step * direction[0], step * direction[1], step * direction[2]};
    const double sum = roundness_at(predicates::add(x, offset), least);
    if (sum > best) {
      best = sum;
      best_offset = offset;
      any = true;
    } else if (any) {
      break;
    }
  }
  if (!any) return false;
  const Place place = state_.moved(v, best_offset, shortest_ * State::kGrid);
  if (!measure_at(place.position, least)) return settle(v, place, false);
  double after = 0;
  for (std::size_t n = 0; n < star_.size(); ++n) {
    if (cone_.counts(n)) after += std::sqrt(quality_[n].gamma);
  }
  return settle(v, place, after > before);
}

// The star with v at x as it will be measured from then on: where it is flat, the cone's roundings
// are other ones. False if it does not reach `least`.
bool Smoothing::measure_at(const Vec3& x, const Quality& least) {
  quality_.clear();
  for (std::size_t n = 0; n < star_.size(); ++n) {
    const TetId t = star_[n];
    const bool counts = cone_.counts(n);
    const Quality q =
        state_.quality_with(state_.mesh.tet(t), index_[n], x, counts ? least : Quality{});
    if (!(q.dihedral > 0) || (counts && !State::reaches(q, least))) return false;
    quality_.push_back(counts ? q : kNotCounted);
  }
  return true;
}

// Moves v by the offset, or to a place a little beside, if its star then reaches `least`.
bool Smoothing::commit(VertexId v, const Vec3& offset, const Quality& least) {
  const Place place = state_.moved(v, offset, shortest_ * State::kGrid);
  return settle(v, place, measure_at(place.position, least));
}

bool Smoothing::becomes_too_long(TetId t, int i, const Vec3& x) const {
  const Tet& tet = state_.mesh.tet(t);
  for (int k = 0; k < 4; ++k) {
    const Vec3& end = state_.position(tet[k]);
    if (k == i || !state_.counts(t) || !state_.too_long(x, end)) continue;
    const Vec3& before = state_.position(v_);
    if (squared_norm(subtract(end, x)) > squared_norm(subtract(end, before)) ||
        !state_.too_long(before, end)) {  // shorter, but nearer to where sizes are smaller
      return true;
    }
  }
  return false;
}

bool Smoothing::settle(VertexId v, const Place& place, bool ok) {
  for (std::size_t n = 0; ok && n < star_.size(); ++n) {
    ok = !becomes_too_long(star_[n], index_[n], place.position) &&
         state_.is_positive_with(state_.mesh.tet(star_[n]), index_[n], place);
  }
  if (ok) {
    state_.move(v, place, star_, quality_);
  } else {
    state_.forget(place);
  }
  return ok;
}

}  // namespace delmesher::improve
