#include "mesher/improve/insertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace delmesher::improve {
namespace {

constexpr std::size_t kLargestCavity = 24, kSmallCavity = 8;
constexpr std::size_t kLargestOnSurface = 48;  // both sides of it
// A point has to be worth it: its star is not bad, or much better than the tetrahedra before.
constexpr float kLeastScore = 0.4F;
constexpr float kLeastGain = 4, kOfWorth = 0.9F;
// One point is no use where an edge is so many times shorter than another of the tetrahedron: edges
// of lengths between have no room there. Squared; for what is measured, and for dihedral angles.
constexpr double kTooUnequal = 8 * 8, kTooUnequalForAngles = 32 * 32;
// Nor does one on the surface mend flatter ones: the squared sine of 5.1 degrees.
constexpr float kTooFlat = 0x1p-7F;

}  // namespace

bool Insertion::run(TetId t) {
  // A point does not mend a face with a small angle, which is mostly one of the surface.
  if (!state_.counts(t) || state_.score(t) >= State::kBad || state_.face_score(t) < State::kBad ||
      is_too_unequal(t)) {
    return false;
  }
  site_ = {};
  if (try_from(t, middle(t))) return true;
  // Below each of its faces, where their tetrahedra would be the best.
  for (int i = 0; i < 4; ++i) {
    if (try_from(t, state_.best_apex_below(t, i))) return true;
  }
  return false;
}

bool Insertion::run_on_surface(TetId t) {
  if (!state_.has_places_on_surface() || !state_.counts(t) || state_.score(t) >= State::kBad ||
      state_.quality(t).dihedral < kTooFlat) {
    return false;
  }
  const Tet v = state_.mesh.tet(t);
  const auto middle_of = [&](std::span<const int> corners) {
    Vec3 sum{};
    for (const int k : corners) sum = geometry::add(sum, state_.position(v[k]));
    for (double& x : sum) x /= static_cast<double>(corners.size());
    return sum;
  };
  const auto try_site = [&](const std::optional<Site>& site, std::span<const int> corners) {
    if (!site) return false;
    site_ = *site;
    return try_from(t, middle_of(corners));
  };
  for (const auto& [i, j] : kEdge) {
    if (try_site(site_on_edge(state_, t, i, j), std::array{i, j})) return true;
  }
  for (int i = 0; i < 4; ++i) {
    if (try_site(site_on_face(state_, t, i), kFace[i])) return true;
  }
  return false;
}

bool Insertion::try_from(TetId t, Vec3 x) {
  operation_.begin(site_.facet, site_.piece);
  operation_.add(t, at(x));
  // Where x went, other faces are the worst.
  bool settled = false;
  for (std::size_t size = 0; size < operation_.cavity().size();) {
    size = operation_.cavity().size();
    grow(x);
    if (operation_.crosses_facets()) return false;
    if (settled && operation_.cavity().size() == size) break;
    settled = settle(x);
  }
  const Quality before = state_.worst_of(operation_.cavity());
  // Where the point really goes is so near that no more can be gained there.
  if (!(worst()->value.score > kOfWorth * worth(before)) ||
      !operation_.find_change([&](VertexId v) { return may_go(v); })) {
    return false;
  }
  const Place place = place_at(x, std::sqrt(extreme_edges(t).first) * State::kGrid);
  if (!fits(place, before)) {
    state_.forget(place);
    return false;
  }
  state_.insert_on_surface(place, site_.mobility, site_.facet[0], operation_.cavity(),
                           operation_.created(), operation_.faces());
  return true;
}

// Is the star of the point worth it, and valid?
bool Insertion::fits(const Place& place, const Quality& before) {
  for (Face& face : operation_.skin()) {
    if (in_cone(face)) face.value = at(place.position).value_of(face.tet, face.face);
  }
  if (worst()->value.score < worth(before)) return false;
  // On the hull nothing beyond a face tells that the point is not beside the faces in its plane.
  const auto is_seen = [&](const auto& edge) {
    return state_.is_positive_with(state_.mesh.tet(edge.tet), edge.corner, place);
  };
  if (!std::ranges::all_of(operation_.outline(), is_seen)) return false;
  const Quality least = state_.to_be_better(before);
  return std::ranges::all_of(operation_.skin(), [&](const Face& face) {
    if (!in_cone(face)) return true;
    const Tet& tet = state_.mesh.tet(face.tet);
    return State::reaches(face.value.quality, least) &&
           state_.is_positive_with(tet, face.face, place) &&
           std::ranges::none_of(kFace[face.face], [&](int k) {
             return state_.counts(face.tet) &&
                    state_.too_long(place.position, state_.position(tet[k]),
                                    state_.mesh.region(face.tet));
           });
  });
}

Place Insertion::place_at(const Vec3& x, double tolerance) {
  switch (site_.mobility) {
    case Mobility::in_plane:
      return state_.place_in_facet(site_.facet[0], x, tolerance);
    case Mobility::on_line:
      return state_.place_on_input_edge(site_.input_edge, x, tolerance);
    default:
      return state_.new_place(x, tolerance);
  }
}

// The least score of the star that is worth a point.
float Insertion::worth(const Quality& before) const {
  return std::min(kLeastScore, kLeastGain * state_.score(before));
}

// Vertices of the surface stay.
bool Insertion::may_go(VertexId v) const {
  return state_.mobility(v) == Mobility::free || state_.mobility(v) == Mobility::in_plane;
}

// Of t and its neighbours: t itself may be flat.
Vec3 Insertion::middle(TetId t) const {
  const MeshTopology& mesh = state_.mesh;
  Vec3 sum{};
  double count = 0;
  const auto take = [&](VertexId v) {
    sum = geometry::add(sum, state_.position(v));
    ++count;
  };
  for (int i = 0; i < 4; ++i) {
    take(mesh.tet(t)[i]);
    const TetId u = mesh.neighbor(t, i);
    if (u != kNone && mesh.facet(t, i) == kNone) take(mesh.tet(u)[mesh.mirror(t, i)]);
  }
  return {sum[0] / count, sum[1] / count, sum[2] / count};
}

// Squared: the shortest and the longest.
std::pair<double, double> Insertion::extreme_edges(TetId t) const {
  const Tet& tet = state_.mesh.tet(t);
  std::pair<double, double> result{HUGE_VAL, 0};
  for (const auto& [i, j] : kEdge) {
    const double squared = squared_norm(subtract(state_.position(tet[i]), state_.position(tet[j])));
    result = {std::min(result.first, squared), std::max(result.second, squared)};
  }
  return result;
}

bool Insertion::is_too_unequal(TetId t) const {
  const auto [shortest, longest] = extreme_edges(t);
  const bool shape = state_.measures() == Measure::shape;
  return longest > (shape ? kTooUnequal : kTooUnequalForAngles) * shortest;
}

// Grows the cavity of x across its worst face, until that is on the surface or good, or the
// tetrahedron beyond it is not worth it.
void Insertion::grow(const Vec3& x) {
  const std::size_t largest = site_.mobility == Mobility::free ? kLargestCavity : kLargestOnSurface;
  while (operation_.cavity().size() < largest) {
    const auto next = face_to_cross();
    if (next == operation_.skin().end()) return;
    operation_.cross(next, at(x));
  }
}

// Faces of the point's own facets first: it is in their plane.
std::vector<Insertion::Face>::const_iterator Insertion::face_to_cross() {
  const MeshTopology& mesh = state_.mesh;
  const std::vector<Face>& skin = operation_.skin();
  if (site_.mobility != Mobility::free) {
    const auto own = std::ranges::find_if(skin, [&](const Face& f) {
      return operation_.is_own(f.tet, f.face) && mesh.neighbor(f.tet, f.face) != kNone;
    });
    if (own != skin.end()) return own;
  }
  const auto face = worst();
  const auto& [tet, i, value] = *face;
  const TetId next = mesh.neighbor(tet, i);
  if (value.score >= 1 || next == kNone || mesh.facet(tet, i) != kNone) return skin.end();
  const bool enough = operation_.cavity().size() > kSmallCavity && value.score >= kLeastScore &&
                      state_.score(next) >= 1;
  return enough ? skin.end() : face;
}

// Of t with x in place of its i-th vertex, as far as it counts.
Insertion::Scored Insertion::Judge::value_of(TetId t, int i) const {
  const bool counts = state.counts(t);
  const Quality q = state.quality_with(state.mesh.tet(t), i, x);
  if (!counts && q.dihedral > 0) return in_plane();
  return {q, state.score(q)};
}

std::vector<Insertion::Face>::const_iterator Insertion::worst() {
  const std::vector<Face>& skin = operation_.skin();
  auto worst = skin.begin();
  float least = HUGE_VALF;
  for (auto face = skin.begin(); face != skin.end(); ++face) {
    if (!(face->value.score < least)) continue;
    least = face->value.score;
    worst = face;
  }
  return worst;
}

// Moves x to where the worst face is better. Is there no such place, as far as was looked?
bool Insertion::settle(Vec3& x) {
  constexpr int kRounds = 6;
  build_cone();
  for (int round = 0; round < kRounds; ++round) {
    const Face& worst_face = *worst();
    const float before = worst_face.value.score;
    const Vec3 towards =
        allowed_offset(site_.mobility, site_.axis,
                       subtract(state_.best_apex_below(worst_face.tet, worst_face.face), x));
    bool success = false;
    for (const double step : {0.5, 0.25, 0.125, 0.0625}) {
      const Vec3 moved = add_scaled(x, step, towards);
      if (!is_better_at(moved, before)) continue;
      x = moved;
      success = true;
      break;
    }
    if (!success) return true;
    std::size_t n = 0;
    for (Face& face : operation_.skin()) {
      if (!in_cone(face)) continue;
      const Quality q = cone_.quality(n++);
      face.value = {q, state_.score(q)};
    }
  }
  return false;
}

bool Insertion::in_cone(const Face& face) const {
  return !operation_.is_own(face.tet, face.face);
}

void Insertion::build_cone() {
  cone_.clear();
  for (const Face& face : operation_.skin()) {
    if (!in_cone(face)) continue;
    const auto at = [&](int k) -> const Vec3& {
      return state_.position(state_.mesh.tet(face.tet)[kFace[face.face][k]]);
    };
    cone_.add(at(0), at(1), at(2), state_.counts(face.tet));
  }
  cone_.finish();
}

// Are all tetrahedra of the cone above this score, with the point at x?
bool Insertion::is_better_at(const Vec3& x, float score) {
  if (!cone_.reaches(x, state_.to_reach(score))) return false;
  for (std::size_t n = 0; n < cone_.size(); ++n) {
    if (!(state_.score(cone_.quality(n)) > score)) return false;
  }
  return true;
}

}  // namespace delmesher::improve
