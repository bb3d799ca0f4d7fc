#include "mesher/cdt/reference_point.h"

#include "mesher/base/epoch.h"
#include "mesher/geometry/vector.h"

namespace delmesher::cdt {

// Does the segment ab meet the closed triangle pqr (not coplanar)?
bool ReferenceFinder::meets(VertexId a, VertexId b, VertexId p, VertexId q, VertexId r) {
  const int side_a = predicates_.orient3d(p, q, r, a);
  const int side_b = predicates_.orient3d(p, q, r, b);
  if (side_a * side_b > 0 || (side_a == 0 && side_b == 0)) return false;
  const int x = predicates_.orient3d(a, b, p, q);
  const int y = predicates_.orient3d(a, b, q, r);
  if (x * y < 0) return false;
  const int z = predicates_.orient3d(a, b, r, p);
  return x * z >= 0 && y * z >= 0;
}

VertexId ReferenceFinder::find(VertexId a, VertexId b) {
  const double length = distance_between(points_, a, b);
  VertexId best = kNone;
  double best_sine = 2;
  if (mark_.size() < mesh_.capacity()) mark_.resize(mesh_.capacity() * 3 / 2, 0);
  next_epoch(epoch_, mark_);
  crossed_.clear();
  for (const TetId t : mesh_.star(a)) visit(t);
  for (std::size_t n = 0; n < crossed_.size(); ++n) {
    control_.poll(points_.size());
    const TetId t = crossed_[n];
    for (int i = 0; i < 4; ++i) {
      const VertexId v = mesh_.vertex(t, i);
      if (v != a && v != b) consider(v, a, b, length, best, best_sine);
      const TetId next = mesh_.neighbor(t, i);
      if (mark_[next] == epoch_ || mesh_.is_ghost(next)) continue;
      const VertexId x = mesh_.vertex(t, kFace[i][0]), y = mesh_.vertex(t, kFace[i][1]),
                     z = mesh_.vertex(t, kFace[i][2]);
      if (x == a || y == a || z == a) continue;
      if (meets(a, b, x, y, z)) visit(next);
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
  if (v == best) return;
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
