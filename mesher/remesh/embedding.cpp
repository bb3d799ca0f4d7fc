#include "mesher/remesh/embedding.h"

#include <algorithm>

namespace delmesher::remesh {

Embedding::Embedding(const TriangleMesh& mesh, const ChangingBoxTree& boxes,
                     const PointStore& points, Predicates& predicates)
    : mesh_(mesh), boxes_(boxes), points_(points), predicates_(predicates) {
  see_new();
}

void Embedding::see_new() {
  for (auto t = static_cast<std::uint32_t>(projection_.size()); t < mesh_.triangles(); ++t) {
    projection_.push_back(mesh_.has_triangle(t)
                              ? surface::find_projection(predicates_, mesh_.triangle(t))
                              : surface::Projection{});
  }
}

bool Embedding::is_free(const Triangle& face, const Patch& patch,
                        const surface::Projection& projection) {
  const Box box = geometry::enclosing_box(points_, face);
  return boxes_.query(box, [&](std::uint32_t t) {
    return std::ranges::find(patch.removed, t) != patch.removed.end() ||
           !surface::meet_outside_shared(predicates_, face, mesh_.triangle(t), projection,
                                         projection_[t]);
  });
}

bool Embedding::contains(const std::array<VertexId, 4>& tetrahedron, int sign, VertexId v) {
  for (std::size_t i = 0; i < 4; ++i) {
    std::array<VertexId, 4> other = tetrahedron;
    other[i] = v;
    if (predicates_.orient3d(other[0], other[1], other[2], other[3]) == -sign) return false;
  }
  return true;
}

// What passes through it meets one of its faces, so only vertices are looked for.
bool Embedding::is_empty(const std::array<VertexId, 4>& tetrahedron, const Patch& patch) {
  const auto& [a, b, c, d] = tetrahedron;
  const int sign = predicates_.orient3d(a, b, c, d);
  if (sign == 0) return true;  // its faces are all of it
  return boxes_.query(geometry::enclosing_box(points_, tetrahedron), [&](std::uint32_t t) {
    if (std::ranges::find(patch.removed, t) != patch.removed.end()) return true;
    return std::ranges::none_of(mesh_.triangle(t), [&](VertexId v) {
      return std::ranges::find(tetrahedron, v) == tetrahedron.end() &&
             contains(tetrahedron, sign, v);
    });
  });
}

bool Embedding::allows(const Patch& patch) {
  std::vector<surface::Projection> projections;
  for (const Triangle& t : patch.added) {
    projections.push_back(surface::find_projection(predicates_, t));
    if (projections.back().sign == 0) return false;
  }
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (surface::meet_outside_shared(predicates_, patch.added[i], patch.added[j], projections[i],
                                       projections[j])) {
        return false;
      }
    }
  }
  for (std::size_t i = 0; i < patch.added.size(); ++i) {
    if (!is_free(patch.added[i], patch, projections[i])) return false;
  }
  for (const Triangle& face : patch.between) {
    const surface::Projection projection = surface::find_projection(predicates_, face);
    if (projection.sign != 0 && !is_free(face, patch, projection)) return false;
  }
  return std::ranges::all_of(patch.swept, [&](const auto& t) { return is_empty(t, patch); });
}

}  // namespace delmesher::remesh
