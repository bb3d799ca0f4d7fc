#include "mesher/improve/relocation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace delmesher::improve {
namespace {

int corner_of(VertexId point, const CreatedTet& tet) {
  return static_cast<int>(std::ranges::find(tet.vertices, point) - tet.vertices.begin());
}

}  // namespace

bool Relocation::run(VertexId v, bool fine) {
  const Mobility mobility = state_.mobility(v);
  if (mobility == Mobility::free || mobility == Mobility::in_plane ||
      state_.points().is_corner(state_.point(v))) {
    return false;
  }
  v_ = v;
  state_.mesh.star(v, star_);
  tilings_.clear();
  faces_.clear();
  find_wedges();
  if (!std::ranges::all_of(wedges_, [&](Wedge& w) { return fill(w); }) || !place_all(fine)) {
    return false;
  }
  std::vector<CreatedTet> created;
  for (const Wedge& wedge : wedges_) {
    created.insert(created.end(), wedge.created.begin(), wedge.created.end());
  }
  state_.insert_in_volume(places_, star_, created, faces_);
  return true;
}

// The parts into which the surface divides the star.
void Relocation::find_wedges() {
  const MeshTopology& mesh = state_.mesh;
  std::vector<std::uint8_t> seen(star_.size(), 0);
  std::vector<std::pair<TetId, std::size_t>> sorted;
  for (std::size_t n = 0; n < star_.size(); ++n) sorted.emplace_back(star_[n], n);
  std::ranges::sort(sorted);
  wedges_.clear();
  for (std::size_t first = 0; first < star_.size(); ++first) {
    if (seen[first] != 0) continue;
    Wedge& wedge = wedges_.emplace_back();
    wedge.point = kNone - static_cast<VertexId>(wedges_.size() - 1);
    seen[first] = 1;
    std::vector<std::size_t> queue = {first};
    for (std::size_t n = 0; n < queue.size(); ++n) {
      const TetId t = star_[queue[n]];
      for (int i = 0; i < 4; ++i) {
        if (mesh.tet(t)[i] == v_ || mesh.facet(t, i) != kNone) continue;
        const TetId neighbor = mesh.neighbor(t, i);
        if (neighbor == kNone) continue;
        const std::size_t u =
            std::ranges::lower_bound(sorted, std::pair{neighbor, std::size_t{0}})->second;
        if (seen[u] != 0) continue;
        seen[u] = 1;
        queue.push_back(u);
      }
    }
    std::ranges::sort(queue);  // in the order of the star
    for (const std::size_t n : queue) wedge.star.push_back(star_[n]);
  }
}

// Finds the tetrahedra that replace those of the wedge, which is between two facets.
bool Relocation::fill(Wedge& wedge) {
  const MeshTopology& mesh = state_.mesh;
  for (const TetId t : wedge.star) {
    for (int i = 0; i < 4; ++i) {
      if (mesh.tet(t)[i] == v_ || mesh.facet(t, i) == kNone) continue;
      std::array<VertexId, 3> face{};
      std::ranges::transform(kFace[i], face.begin(), [&](int k) { return mesh.tet(t)[k]; });
      std::rotate(face.begin(), std::ranges::find(face, v_), face.end());
      wedge.old_faces.push_back({face, t, i});
    }
  }
  if (wedge.old_faces.empty()) return false;
  const FacetId first = facet_of(wedge.old_faces.front());
  const auto other = std::ranges::find_if(
      wedge.old_faces, [&](const Face& face) { return facet_of(face) != first; });
  if (other == wedge.old_faces.end() || !tile(first, wedge) || !tile(facet_of(*other), wedge)) {
    return false;
  }
  for (const TetId t : wedge.star) {
    Tet tet = mesh.tet(t);
    std::ranges::replace(tet, v_, wedge.point);
    wedge.created.push_back({tet, mesh.region(t)});
  }
  return true;
}

// The faces of the facet at v, as a polygon that has v on its edge from the last vertex to the
// first. Empty if they are not one fan.
std::vector<VertexId> Relocation::outline(std::span<const Face> fan) {
  const auto has_no_predecessor = [&](const Face& face) {
    return std::ranges::none_of(
        fan, [&](const Face& other) { return other.vertices[2] == face.vertices[1]; });
  };
  auto next = std::ranges::find_if(fan, has_no_predecessor);
  if (next == fan.end()) return {};
  std::vector<VertexId> polygon = {next->vertices[1]};
  while (next != fan.end()) {
    polygon.push_back(next->vertices[2]);
    next = std::ranges::find_if(
        fan, [&](const Face& face) { return face.vertices[1] == polygon.back(); });
  }
  return polygon.size() == fan.size() + 1 ? polygon : std::vector<VertexId>{};
}

// Tiles the facet without v, as seen from this wedge: like the wedge on its other side, if that was
// first.
bool Relocation::tile(FacetId facet, Wedge& wedge) {
  std::vector<Face> fan;
  Vec3& normal = wedge.normals.emplace_back();
  for (const Face& face : wedge.old_faces) {
    if (facet_of(face) != facet) continue;
    fan.push_back(face);
    normal = geometry::add(normal, state_.face_normal(face.tet, face.face));
  }
  auto tiling = std::ranges::find(tilings_, facet, &Tiling::facet);
  const bool from_behind = tiling != tilings_.end();
  if (!from_behind) {
    tilings_.push_back({facet, {}});
    tiling = tilings_.end() - 1;
    const std::vector<VertexId> polygon = outline(fan);
    if (polygon.empty() || !cut_ears(polygon, normal, state_.mesh.region(fan.front().tet), *tiling))
      return false;
    for (const auto& triangle : tiling->triangles) faces_.push_back({triangle, facet});
  }
  for (const auto& [a, b, c] : tiling->triangles) {
    put_on(from_behind ? std::array{c, b, a} : std::array{a, b, c}, fan.front(), wedge);
  }
  return true;
}

// Opposite the edge with v. No ear contains another vertex, because v sees all of the polygon.
// fits() decides where doubles see no ear.
bool Relocation::cut_ears(std::vector<VertexId> polygon, const Vec3& normal, RegionId region,
                          Tiling& tiling) {
  while (polygon.size() >= 3) {
    const std::size_t ear = best_ear(polygon, normal);
    if (ear == 0) return false;
    const VertexId before = polygon[ear - 1], after = polygon[ear + 1];
    if (state_.too_long(state_.position(before), state_.position(after), region)) return false;
    tiling.triangles.push_back({before, polygon[ear], after});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return true;
}

// The tetrahedron from a new face of the surface to the point; as `model` is turned.
void Relocation::put_on(const std::array<VertexId, 3>& face, const Face& model, Wedge& wedge) {
  Tet tet = state_.mesh.tet(model.tet);
  for (std::size_t k = 0; k < 3; ++k) tet[kFace[model.face][k]] = face[k];
  tet[model.face] = wedge.point;
  wedge.created.push_back({tet, state_.mesh.region(model.tet)});
}

// The roundest one, or the least inverted; 0 if none has a shape in doubles.
std::size_t Relocation::best_ear(const std::vector<VertexId>& polygon, const Vec3& normal) const {
  std::size_t best = 0;
  double roundest = -HUGE_VAL;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec3 &a = state_.position(polygon[i - 1]), &b = state_.position(polygon[i]),
               &c = state_.position(polygon[i + 1]);
    const Vec3 ab = subtract(b, a), bc = subtract(c, b), ca = subtract(a, c);
    const double area = dot(cross(ab, bc), normal);
    const double round = area / (squared_norm(ab) + squared_norm(bc) + squared_norm(ca));
    if (!(round > roundest)) continue;
    roundest = round;
    best = i;
  }
  return best;
}

// Of unit length, halfway between the two facets.
Vec3 Relocation::inwards(const Wedge& wedge) {
  Vec3 sum{};
  for (const Vec3& normal : wedge.normals) sum = add_scaled(sum, -1 / norm(normal), normal);
  to_unit_length(sum);
  return sum;
}

bool Relocation::place_all(bool fine) {
  places_.clear();
  for (const Wedge& wedge : wedges_) {
    if (place(wedge, fine)) continue;
    for (; !places_.empty(); places_.pop_back()) state_.forget(places_.back());
    return false;
  }
  return true;
}

bool Relocation::place(const Wedge& wedge, bool fine) {
  Vec3 x{};
  if (!find_place(wedge, fine, x)) return false;
  // In a thin wedge the place has to be finer than it is far from v.
  constexpr int kMostGrids = 4;
  double tolerance = norm(subtract(x, state_.position(v_)));
  for (int n = 0; n < kMostGrids; ++n) {
    tolerance *= State::kGrid;
    const Place place = state_.new_place(x, tolerance);
    if (fits(wedge, place)) {
      places_.push_back(place);
      return true;
    }
    state_.forget(place);
  }
  return false;
}

bool Relocation::find_place(const Wedge& wedge, bool fine, Vec3& best) const {
  constexpr int kHalvings = 24, kFineHalvings = 50;  // of the longest edge at v
  Vec3 centre{};
  double longest = 0, count = 0;
  const Vec3 &at = state_.position(v_), direction = inwards(wedge);
  for (const TetId t : wedge.star) {
    for (const VertexId w : state_.mesh.tet(t)) {
      if (w == v_) continue;
      centre = geometry::add(centre, subtract(state_.position(w), at));
      longest = std::max(longest, distance(state_.position(w), at));
      ++count;
    }
  }
  for (double& x : centre) x /= count;
  std::vector<std::pair<Tet, int>> around;  // and the corner that moves
  for (const CreatedTet& tet : wedge.created) {
    around.emplace_back(tet.vertices, corner_of(wedge.point, tet));
  }
  float score = 0;
  double step = 1;
  const auto goes_on = [&](int n) {
    return n < kHalvings || (fine && score == 0 && n < kFineHalvings);
  };
  for (int n = 0; goes_on(n); ++n, step /= 2) {
    const float before = score;
    for (const Vec3& x :
         {add_scaled(at, step * longest, direction), add_scaled(at, step, centre)}) {
      const float here = worst_at(around, x, score);
      if (here <= score) continue;
      score = here;
      best = x;
    }
    if (score > 0 && score == before) break;
  }
  return score > 0;
}

// Squared: the sine of the smallest dihedral angle of the tetrahedra with the corner at x; 0 if it
// is not above `best`, or one is not positive. (Other measures are beyond the range of floats where
// all is flat.) What forbids one place often forbids the next.
float Relocation::worst_at(std::span<std::pair<Tet, int>> around, const Vec3& x, float best) const {
  float worst = HUGE_VALF;
  for (auto& one : around) {
    const auto& [tet, corner] = one;
    const Quality q = state_.quality_with(tet, corner, x, {best, HUGE_VALF, HUGE_VALF});
    if (!(q.dihedral > best)) {
      std::swap(one, around.front());
      return 0;
    }
    worst = std::min(worst, q.dihedral);
  }
  return worst;
}

bool Relocation::fits(const Wedge& wedge, const Place& place) {
  return std::ranges::all_of(wedge.created, [&](const CreatedTet& tet) {
    for (const VertexId w : tet.vertices) {
      if (w != wedge.point && state_.too_long(place.position, state_.position(w), tet.region))
        return false;
    }
    return state_.is_positive_with(tet.vertices, corner_of(wedge.point, tet), place);
  });
}

}  // namespace delmesher::improve
