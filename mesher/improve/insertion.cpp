#include "mesher/improve/insertion.h"

#include <algorithm>
#include <cmath>

namespace delmesher::improve {
namespace {

constexpr std::size_t kLargestCavity = 24, kSmallCavity = 8;
// A point has to be worth it: its star is not bad, or much better than the tetrahedra before.
constexpr float kLeastScore = 0.4F;
constexpr float kLeastGain = 4;

}  // namespace

bool Insertion::run(TetId t) {
  // A point does not mend a face with a small angle, which is mostly one of the surface.
  if (!state_.counts(t) || state_.score(t) >= State::kBad || state_.face_score(t) < State::kBad)
    return false;
  if (try_from(t, middle(t))) return true;
  // Below each of its faces, where their tetrahedra would be the best.
  for (int i = 0; i < 4; ++i) {
    if (try_from(t, state_.best_apex_below(t, i))) return true;
  }
  return false;
}

bool Insertion::try_from(TetId t, Vec3 x) {
  cavity_.clear();
  faces_.clear();
  add(t, x);
  // Where x went, other faces are the worst.
  for (std::size_t size = 0; size < cavity_.size();) {
    size = cavity_.size();
    grow(x);
    settle(x);
  }
  if (!(state_.score(worst()->quality) > 0)) return false;
  const Place place = state_.new_place(x, shortest_edge(t) * State::kGrid);
  measure(place.position);
  const Quality before = state_.worst_of(cavity_);
  const Quality least = state_.to_be_better(before);
  const float was = state_.score(before);
  bool ok = state_.score(worst()->quality) >= std::min(kLeastScore, kLeastGain * was);
  created_.clear();
  for (std::size_t n = 0; ok && n < faces_.size(); ++n) {
    const auto& [tet, face, quality] = faces_[n];
    ok = State::reaches(quality, least) &&
         state_.is_positive_with(state_.mesh.tet(tet), face, place);
    created_.push_back({state_.mesh.tet(tet), state_.mesh.region(t)});
    created_.back().vertices[face] = kNone;
    for (const int k : kFace[face]) {
      ok = ok && !state_.too_long(place.position, state_.position(state_.mesh.tet(tet)[k]));
    }
  }
  if (ok) {
    state_.insert(place, cavity_, created_);
  } else {
    state_.forget(place);
  }
  return ok;
}

// Of t and its neighbours: t itself may be flat.
Vec3 Insertion::middle(TetId t) const {
  const WorkMesh& mesh = state_.mesh;
  Vec3 sum{};
  double count = 0;
  const auto take = [&](VertexId v) {
    sum = predicates::add(sum, state_.position(v));
    ++count;
  };
  for (int i = 0; i < 4; ++i) {
    take(mesh.tet(t)[i]);
    const TetId u = mesh.neighbor(t, i);
    if (u != kNone && mesh.facet(t, i) == kNone) take(mesh.tet(u)[mesh.mirror(t, i)]);
  }
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

double Insertion::shortest_edge(TetId t) const {
  const Tet& tet = state_.mesh.tet(t);
  double shortest2 = HUGE_VAL;
  for (const auto& [i, j] : kEdge) {
    shortest2 = std::min(shortest2,
                         squared_norm(subtract(state_.position(tet[i]), state_.position(tet[j]))));
  }
  return std::sqrt(shortest2);
}

// Grows the cavity of x across its worst face, until that is on the surface or good, or the
// tetrahedron beyond it is not worth it.
void Insertion::grow(const Vec3& x) {
  while (cavity_.size() < kLargestCavity) {
    const auto& [tet, face, quality] = *worst();
    const TetId next = state_.mesh.neighbor(tet, face);
    if (state_.good(quality) || next == kNone || state_.mesh.facet(tet, face) != kNone) return;
    if (cavity_.size() > kSmallCavity && state_.score(quality) >= kLeastScore &&
        state_.score(next) >= 1) {
      return;
    }
    add(next, x);
  }
}

void Insertion::add(TetId t, const Vec3& x) {
  cavity_.push_back(t);
  for (int i = 0; i < 4; ++i) {
    const TetId u = state_.mesh.neighbor(t, i);
    if (u == kNone || std::find(cavity_.begin(), cavity_.end(), u) == cavity_.end()) {
      faces_.push_back({t, i, state_.quality_with(state_.mesh.tet(t), i, x)});
      continue;
    }
    std::erase_if(faces_, [&](const Face& f) {
      return f.tet == u && state_.mesh.neighbor(f.tet, f.face) == t;
    });
  }
}

std::vector<Insertion::Face>::const_iterator Insertion::worst() const {
  return std::min_element(faces_.begin(), faces_.end(), [&](const Face& a, const Face& b) {
    return state_.score(a.quality) < state_.score(b.quality);
  });
}

void Insertion::measure(const Vec3& x) {
  for (Face& face : faces_) {
    face.quality = state_.quality_with(state_.mesh.tet(face.tet), face.face, x);
  }
}

// Moves x to where the worst face is better.
void Insertion::settle(Vec3& x) {
  constexpr int kRounds = 6;
  for (int round = 0; round < kRounds; ++round) {
    const Face& worst_face = *worst();
    const float before = state_.score(worst_face.quality);
    const Vec3 towards = subtract(state_.best_apex_below(worst_face.tet, worst_face.face), x);
    const Quality least = state_.to_reach(before);
    const auto better = [&](const Vec3& moved) {
      return std::all_of(faces_.begin(), faces_.end(), [&](const Face& face) {
        return state_.score(state_.quality_with(state_.mesh.tet(face.tet), face.face, moved,
                                                least)) > before;
      });
    };
    bool success = false;
    for (const double step : {0.5, 0.25, 0.125, 0.0625}) {
      const Vec3 moved = add_scaled(x, step, towards);
      if (!better(moved)) continue;
      x = moved;
      measure(x);
      success = true;
      break;
    }
    if (!success) return;
  }
}

}  // namespace delmesher::improve
