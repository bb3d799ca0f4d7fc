#include "mesher/cdt/reference_point.h"

#include <array>

#include "mesher/base/epoch.h"
#include "mesher/geometry/vector.h"

namespace delmesher::cdt {

// On which side the segment ab passes the edges of a tetrahedron: two faces ask for each edge.
class ReferenceFinder::Passing {
 public:
  Passing(Predicates& predicates, VertexId a, VertexId b, const VertexId* corner)
      : predicates_(predicates), a_(a), b_(b), corner_(corner) {
    sign_.fill(kUnset);
  }

  // Sign of orient3d(a, b, i-th corner, j-th corner).
  int side_of(int i, int j) {
    if (i > j) return -side_of(j, i);
    std::int8_t& sign = sign_[static_cast<std::size_t>(4 * i + j)];
    if (sign == kUnset) {
      sign = static_cast<std::int8_t>(predicates_.orient3d(a_, b_, corner_[i], corner_[j]));
    }
    return sign;
  }
  // Signs of a and b at a face.
  int side_of_a(const int* face) { return side_of_end(face, a_); }
  int side_of_b(const int* face) { return side_of_end(face, b_); }

 private:
  static constexpr std::int8_t kUnset = 2;

  int side_of_end(const int* face, VertexId end) {
    return predicates_.orient3d(corner_[face[0]], corner_[face[1]], corner_[face[2]], end);
  }

  Predicates& predicates_;
  VertexId a_, b_;
  const VertexId* corner_;
  std::array<std::int8_t, 16> sign_;
};

// Does the segment meet the closed triangle (not coplanar)?
bool ReferenceFinder::meets(Passing& passing, int face) {
  const int* f = kFace[face];
  const int x = passing.side_of(f[0], f[1]), y = passing.side_of(f[1], f[2]);
  if (x * y < 0) return false;
  const int z = passing.side_of(f[2], f[0]);
  if (x * z < 0 || y * z < 0) return false;
  const int side_a = passing.side_of_a(f), side_b = passing.side_of_b(f);
  return side_a * side_b <= 0 && (side_a != 0 || side_b != 0);
}

VertexId ReferenceFinder::find(VertexId a, VertexId b) {
  const double length = distance_between(points_, a, b);
  VertexId best = kNone;
  double best_sine = 2;
  if (mark_.size() < mesh_.capacity()) mark_.resize(mesh_.capacity() * 3 / 2, 0);
  if (considered_.size() < points_.size()) considered_.resize(points_.size() * 3 / 2, 0);
  next_epoch(epoch_, mark_, considered_);
  crossed_.clear();
  for (const TetId t : mesh_.star(a)) visit(t);
  for (std::size_t n = 0; n < crossed_.size(); ++n) {
    control_.poll(points_.size());
    const TetId t = crossed_[n];
    Passing passing(predicates_, a, b, mesh_.vertices(t));
    for (int i = 0; i < 4; ++i) {
      const VertexId v = mesh_.vertex(t, i);
      if (v != a && v != b && considered_[v] != epoch_) {
        considered_[v] = epoch_;
        consider(v, a, b, length, best, best_sine);
      }
      const TetId next = mesh_.neighbor(t, i);
      if (mark_[next] == epoch_ || mesh_.is_ghost(next)) continue;
      const int corner_at_a = mesh_.index_of(t, a);
      if (corner_at_a >= 0 && corner_at_a != i) continue;
      if (meets(passing, i)) visit(next);
    }
  }
  return best;
}

void ReferenceFinder::visit(TetId t) {
  if (mesh_.is_ghost(t)) return;
  mark_[t] = epoch_;
  crossed_.push_back(t);
}

// By differences: far from the origin the nearest doubles of all three may be the same.
void ReferenceFinder::consider(VertexId v, VertexId a, VertexId b, double length, VertexId& best,
                               double& best_sine) const {
  const Vec3 f = scaled_difference(points_.difference(v, a), {}, length),
             g = scaled_difference(points_.difference(v, b), {}, length);
  const double both = dot(f, f) * dot(g, g), cosine = dot(f, g);
  // Perturbation may have one on the sphere in the way: edges of lengths 1 and root 2 that meet at
  // 45 degrees, halved in turn, have such points for ever.
  constexpr double kOnSphere = 0x1p-80;
  if (!(cosine < 0 || cosine * cosine <= kOnSphere * both)) return;
  const Vec3 normal = cross(f, g);
  const double sine = dot(normal, normal) / both;
  if (sine < best_sine || (sine == best_sine && v < best)) {
    best = v;
    best_sine = sine;
  }
}

}  // namespace delmesher::cdt
