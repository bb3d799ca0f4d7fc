#include "mesher/improve/insertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

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
  cavity_.clear();
  faces_.clear();
  crosses_facets_ = false;
  add(t, x);
  // Where x went, other faces are the worst.
  for (std::size_t size = 0; size < cavity_.size();) {
    size = cavity_.size();
    grow(x);
    if (crosses_facets_ && site_.mobility != Mobility::free) return false;
    settle(x);
  }
  const Quality before = state_.worst_of(cavity_);
  // Where the point really goes is so near that no more can be gained there.
  if (!(state_.score(worst()->quality) > kOfWorth * worth(before)) || !keeps_surface()) {
    return false;
  }
  const Place place = place_at(x, std::sqrt(extreme_edges(t).first) * State::kGrid);
  measure(place.position);
  const Quality least = state_.to_be_better(before);
  bool ok = is_worth_it(before) && sees_outline(place);
  created_.clear();
  for (std::size_t n = 0; ok && n < faces_.size(); ++n) {
    const auto& [tet, face, quality] = faces_[n];
    if (site_.is_on(state_.mesh.facet(tet, face))) continue;  // of the hull
    ok = State::reaches(quality, least) &&
         state_.is_positive_with(state_.mesh.tet(tet), face, place);
    created_.push_back({state_.mesh.tet(tet), state_.mesh.region(tet)});
    created_.back().vertices[face] = kNone;
    for (const int k : kFace[face]) {
      ok = ok && !(state_.counts(tet) &&
                   state_.too_long(place.position, state_.position(state_.mesh.tet(tet)[k])));
    }
  }
  if (ok) {
    put_in(place);
  } else {
    state_.forget(place);
  }
  return ok;
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

bool Insertion::is_worth_it(const Quality& before) const {
  return state_.score(worst()->quality) >= worth(before);
}

void Insertion::put_in(const Place& place) {
  if (site_.mobility == Mobility::free) {
    state_.insert(place, cavity_, created_);
  } else {
    state_.insert_on_surface(place, site_.mobility, site_.facet[0], cavity_, created_,
                             created_faces_);
  }
}

// Finds the faces at the point on the surface. False if the surface would be another one.
bool Insertion::keeps_surface() {
  outline_.clear();
  created_faces_.clear();
  if (site_.mobility == Mobility::free) return true;
  if (crosses_facets_ || !keeps_its_vertices()) return false;
  find_patch();
  const auto is_same = [](const FaceEdge& a, const FaceEdge& b) {
    return a.ends == b.ends && a.facet == b.facet;
  };
  int pieces = 0;
  for (std::size_t n = 0; n < patch_.size(); ++n) {
    if (n + 1 < patch_.size() && is_same(patch_[n], patch_[n + 1])) {
      ++n;
    } else if (patch_[n].ends == site_.piece) {
      ++pieces;
    } else {
      outline_.push_back(patch_[n]);
      created_faces_.push_back({{patch_[n].ends[0], patch_[n].ends[1], kNone}, patch_[n].facet});
    }
  }
  return site_.mobility == Mobility::in_plane || pieces == 2;
}

// The edges of the faces that the point replaces, in order.
void Insertion::find_patch() {
  const MeshTopology& mesh = state_.mesh;
  patch_.clear();
  for (const TetId t : cavity_) {
    for (int i = 0; i < 4; ++i) {
      const TetId u = mesh.neighbor(t, i);
      if (!site_.is_on(mesh.facet(t, i)) || (u != kNone && u < t)) continue;
      for (int k = 0; k < 3; ++k) {
        const auto [a, b] =
            std::minmax(mesh.tet(t)[kFace[i][k]], mesh.tet(t)[kFace[i][(k + 1) % 3]]);
        patch_.push_back({{a, b}, mesh.facet(t, i), t, kFace[i][(k + 2) % 3]});
      }
    }
  }
  std::ranges::sort(patch_, {}, [](const FaceEdge& e) { return std::tuple(e.ends, e.facet); });
}

// On the hull nothing beyond a face tells that the point is not beside the patch, in its plane.
bool Insertion::sees_outline(const Place& place) {
  return std::ranges::all_of(outline_, [&](const FaceEdge& edge) {
    return state_.is_positive_with(state_.mesh.tet(edge.tet), edge.corner, place);
  });
}

// No face of the point's facets is left on the skin but on the hull, and all vertices of the
// surface are.
bool Insertion::keeps_its_vertices() const {
  const MeshTopology& mesh = state_.mesh;
  std::vector<VertexId> kept;
  for (const auto& [tet, face, quality] : faces_) {
    if (site_.is_on(mesh.facet(tet, face))) {
      if (mesh.neighbor(tet, face) != kNone) return false;
      continue;
    }
    for (const int k : kFace[face]) kept.push_back(mesh.tet(tet)[k]);
  }
  std::sort(kept.begin(), kept.end());
  return std::ranges::all_of(cavity_, [&](TetId t) {
    return std::ranges::all_of(mesh.tet(t), [&](VertexId v) {
      const bool may_go =
          state_.mobility(v) == Mobility::free || state_.mobility(v) == Mobility::in_plane;
      return may_go || std::ranges::binary_search(kept, v);
    });
  });
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
  while (cavity_.size() < largest) {
    const auto next = face_to_cross();
    if (next == faces_.end()) return;
    add(state_.mesh.neighbor(next->tet, next->face), x);
  }
}

// Faces of the point's own facets first: it is in their plane.
std::vector<Insertion::Face>::const_iterator Insertion::face_to_cross() const {
  const MeshTopology& mesh = state_.mesh;
  if (site_.mobility != Mobility::free) {
    const auto own = std::ranges::find_if(faces_, [&](const Face& f) {
      return site_.is_on(mesh.facet(f.tet, f.face)) && mesh.neighbor(f.tet, f.face) != kNone;
    });
    if (own != faces_.end()) return own;
  }
  const auto face = worst();
  const auto& [tet, i, quality] = *face;
  const TetId next = mesh.neighbor(tet, i);
  if (state_.good(quality) || next == kNone || mesh.facet(tet, i) != kNone) return faces_.end();
  const bool enough = cavity_.size() > kSmallCavity && state_.score(quality) >= kLeastScore &&
                      state_.score(next) >= 1;
  return enough ? faces_.end() : face;
}

void Insertion::add(TetId t, const Vec3& x) {
  cavity_.push_back(t);
  for (int i = 0; i < 4; ++i) {
    const TetId u = state_.mesh.neighbor(t, i);
    if (u == kNone || std::find(cavity_.begin(), cavity_.end(), u) == cavity_.end()) {
      faces_.push_back({t, i, quality_from(t, i, x)});
      continue;
    }
    const FacetId facet = state_.mesh.facet(t, i);
    if (facet != kNone && !site_.is_on(facet)) crosses_facets_ = true;
    std::erase_if(faces_, [&](const Face& f) {
      return f.tet == u && state_.mesh.neighbor(f.tet, f.face) == t;
    });
  }
}

// Of t with x in place of its i-th vertex, as far as it counts. There is none at faces of the hull
// whose plane x is in.
Quality Insertion::quality_from(TetId t, int i, const Vec3& x) const {
  if (site_.is_on(state_.mesh.facet(t, i))) return kNotCounted;
  const bool counts = state_.counts(t);
  const Quality q = state_.quality_with(state_.mesh.tet(t), i, x);
  return counts || !(q.dihedral > 0) ? q : kNotCounted;
}

std::vector<Insertion::Face>::const_iterator Insertion::worst() const {
  return std::min_element(faces_.begin(), faces_.end(), [&](const Face& a, const Face& b) {
    return state_.score(a.quality) < state_.score(b.quality);
  });
}

void Insertion::measure(const Vec3& x) {
  for (Face& face : faces_) {
    face.quality = quality_from(face.tet, face.face, x);
  }
}

// Moves x to where the worst face is better.
void Insertion::settle(Vec3& x) {
  constexpr int kRounds = 6;
  build_cone();
  for (int round = 0; round < kRounds; ++round) {
    const Face& worst_face = *worst();
    const float before = state_.score(worst_face.quality);
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
    if (!success) return;
    std::size_t n = 0;
    for (Face& face : faces_) {
      if (in_cone(face)) face.quality = cone_.quality(n++);
    }
  }
}

bool Insertion::in_cone(const Face& face) const {
  return !site_.is_on(state_.mesh.facet(face.tet, face.face));
}

void Insertion::build_cone() {
  cone_.clear();
  for (const Face& face : faces_) {
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
