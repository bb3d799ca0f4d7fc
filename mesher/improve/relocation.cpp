#include "mesher/improve/relocation.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace delmesher::improve {
namespace {

int corner_of_point(const CreatedTet& tet) {
  return static_cast<int>(std::ranges::find(tet.vertices, kNone) - tet.vertices.begin());
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
  if (!find_faces()) return false;
  created_.clear();
  faces_.clear();
  normals_.clear();
  const auto facet_of = [&](const Face& face) { return state_.mesh.facet(face.tet, face.face); };
  const FacetId first = facet_of(old_faces_.front());
  const auto other =
      std::ranges::find_if(old_faces_, [&](const Face& face) { return facet_of(face) != first; });
  if (other == old_faces_.end() || !tile(first) || !tile(facet_of(*other))) return false;
  find_created();
  Vec3 x{};
  if (!find_place(fine, x)) return false;
  // In a thin wedge the place has to be finer than it is far from v.
  constexpr int kMostGrids = 4;
  double tolerance = norm(subtract(x, state_.position(v)));
  for (int n = 0; n < kMostGrids; ++n) {
    tolerance *= State::kGrid;
    const Place place = state_.new_place(x, tolerance);
    if (fits(place)) {
      state_.insert_on_surface(place, Mobility::free, kNone, star_, created_, faces_);
      return true;
    }
    state_.forget(place);
  }
  return false;
}

// False if there are tetrahedra on both sides of the surface.
bool Relocation::find_faces() {
  const MeshTopology& mesh = state_.mesh;
  old_faces_.clear();
  for (const TetId t : star_) {
    for (int i = 0; i < 4; ++i) {
      if (mesh.tet(t)[i] == v_ || mesh.facet(t, i) == kNone) continue;
      if (mesh.neighbor(t, i) != kNone) return false;
      std::array<VertexId, 3> face{};
      std::ranges::transform(kFace[i], face.begin(), [&](int k) { return mesh.tet(t)[k]; });
      std::rotate(face.begin(), std::ranges::find(face, v_), face.end());
      old_faces_.push_back({face, t, i});
    }
  }
  return !old_faces_.empty();
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

// Tiles the facet without v: ears are cut off opposite the edge with v. None of them contains
// another vertex, because v sees all of the polygon. fits() decides where doubles see no ear.
bool Relocation::tile(FacetId facet) {
  std::vector<Face> fan;
  Vec3& normal = normals_.emplace_back();
  for (const Face& face : old_faces_) {
    if (state_.mesh.facet(face.tet, face.face) != facet) continue;
    fan.push_back(face);
    normal = geometry::add(normal, state_.face_normal(face.tet, face.face));
  }
  std::vector<VertexId> polygon = outline(fan);
  if (polygon.empty()) return false;
  while (polygon.size() >= 3) {
    const std::size_t ear = best_ear(polygon, normal);
    if (ear == 0) return false;
    const VertexId before = polygon[ear - 1], after = polygon[ear + 1];
    if (state_.too_long(state_.position(before), state_.position(after))) return false;
    put_on({before, polygon[ear], after}, fan.front());
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return true;
}

// A new face of the surface, with the tetrahedron from there to the point; as `model` is turned.
void Relocation::put_on(const std::array<VertexId, 3>& face, const Face& model) {
  faces_.push_back({face, state_.mesh.facet(model.tet, model.face)});
  Tet tet = state_.mesh.tet(model.tet);
  for (std::size_t k = 0; k < 3; ++k) tet[kFace[model.face][k]] = face[k];
  tet[model.face] = kNone;
  created_.push_back({tet, state_.mesh.region(model.tet)});
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
Vec3 Relocation::inwards() const {
  Vec3 sum{};
  for (const Vec3& normal : normals_) sum = add_scaled(sum, -1 / norm(normal), normal);
  to_unit_length(sum);
  return sum;
}

// Besides those on the new faces.
void Relocation::find_created() {
  for (const TetId t : star_) {
    Tet tet = state_.mesh.tet(t);
    std::ranges::replace(tet, v_, kNone);
    created_.push_back({tet, state_.mesh.region(t)});
  }
}

bool Relocation::find_place(bool fine, Vec3& best) const {
  constexpr int kHalvings = 24, kFineHalvings = 50;  // of the longest edge at v
  Vec3 centre{};
  double longest = 0, count = 0;
  const Vec3 &at = state_.position(v_), direction = inwards();
  for (const TetId t : star_) {
    for (const VertexId w : state_.mesh.tet(t)) {
      if (w == v_) continue;
      centre = geometry::add(centre, subtract(state_.position(w), at));
      longest = std::max(longest, distance(state_.position(w), at));
      ++count;
    }
  }
  for (double& x : centre) x /= count;
  float score = 0;
  double step = 1;
  const auto goes_on = [&](int n) {
    return n < kHalvings || (fine && score == 0 && n < kFineHalvings);
  };
  for (int n = 0; goes_on(n); ++n, step /= 2) {
    const float before = score;
    for (const Vec3& x :
         {add_scaled(at, step * longest, direction), add_scaled(at, step, centre)}) {
      const float here = worst_at(x);
      if (here <= score) continue;
      score = here;
      best = x;
    }
    if (score > 0 && score == before) break;
  }
  return score > 0;
}

// Squared: the sine of the smallest dihedral angle of the new tetrahedra with the point at x; 0 if
// one is not positive. (Other measures are beyond the range of floats where all is flat.)
float Relocation::worst_at(const Vec3& x) const {
  float worst = HUGE_VALF;
  for (const CreatedTet& tet : created_) {
    const Quality q = state_.quality_with(tet.vertices, corner_of_point(tet), x);
    if (!(q.dihedral > 0)) return 0;
    worst = std::min(worst, q.dihedral);
  }
  return worst;
}

bool Relocation::fits(const Place& place) {
  return std::ranges::all_of(created_, [&](const CreatedTet& tet) {
    for (const VertexId w : tet.vertices) {
      if (w != kNone && state_.too_long(place.position, state_.position(w))) return false;
    }
    return state_.is_positive_with(tet.vertices, corner_of_point(tet), place);
  });
}

}  // namespace delmesher::improve
