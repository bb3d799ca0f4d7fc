#include "oracles/mesh/split_triangles.h"

#include <algorithm>
#include <utility>

#include "oracles/base/box_tree.h"
#include "oracles/base/distances.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

SplitTriangles::SplitTriangles(const TetComplex& complex, std::span<const Face> triangles,
                               double near)
    : complex_(complex),
      points_(*complex.points),
      near_(near),
      is_corner_(complex.points->size(), false) {
  for (const Face& triangle : triangles) {
    for (const Index v : triangle) is_corner_[v] = true;
  }
}

std::vector<SplitTriangles::Split> SplitTriangles::read(const Neighbours& neighbours,
                                                        std::span<const Face> asked) {
  std::vector<Index> added;
  std::vector<BoxTree::Box> boxes;
  for (Index v = complex_.first_vertex; v < complex_.last_vertex; ++v) {
    if (is_corner_[v]) continue;
    added.push_back(v);
    boxes.push_back(box_around(points_, std::array{v}));
  }
  std::vector<Vertices> vertices(asked.size());
  std::vector<Split> result(asked.size());
  if (added.empty()) return result;
  const BoxTree tree(std::move(boxes));
  std::vector<Index> around;
  for (std::size_t n = 0; n < asked.size(); ++n) {
    around.clear();
    tree.query(enlarged(box_around(points_, asked[n]), near_), around);
    for (Index& v : around) v = added[v];
    std::ranges::sort(around);
    result[n].is_ambiguous = !find_vertices(asked[n], around, vertices[n]);
  }
  collect_faces(neighbours, vertices);
  for (std::size_t n = 0; n < asked.size(); ++n) {
    if (result[n].is_ambiguous) continue;
    result[n] = faces_of(asked[n], vertices[n]);
    if (!result[n].faces.empty()) deviation_ = std::max(deviation_, vertices[n].deviation);
  }
  return result;
}

// False if one is near two sides, or their order is none.
bool SplitTriangles::find_vertices(const Face& triangle, const std::vector<Index>& around,
                                   Vertices& vertices) const {
  const auto measured = [&](const mpq_class& squared) {
    return square_root(squared, points_.exponent()) * (1 + 1e-12);
  };
  for (const Index v : around) {
    double off = measured(squared_distance_to_triangle(points_, v, triangle));
    if (!(off <= near_)) continue;
    int sides = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off_side =
          measured(squared_distance_to_segment(points_, v, triangle[k], triangle[(k + 1) % 3]));
      if (!(off_side <= near_)) continue;
      ++sides;
      off = std::max(off, off_side);
      vertices.on_sides[k].push_back(v);
    }
    if (sides > 1) return false;
    if (sides == 0) vertices.inside.push_back(v);
    vertices.deviation = std::max(vertices.deviation, off);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!sort_along(triangle[k], triangle[(k + 1) % 3], vertices.on_sides[k])) return false;
  }
  return true;
}

bool SplitTriangles::sort_along(Index from, Index to, std::vector<Index>& chain) const {
  const auto is_before = [&](Index v, Index w) {
    return exact::dot_sign(points_, v, w, from, to) > 0;
  };
  std::ranges::sort(chain, is_before);
  Index last = from;
  for (const Index v : chain) {
    if (!is_before(last, v)) return false;
    last = v;
  }
  return is_before(last, to);
}

// Those that have nothing but corners and vertices that were found, at least one of these.
void SplitTriangles::collect_faces(const Neighbours& neighbours, std::span<const Vertices> found) {
  std::vector<bool> is_found(points_.size(), false);
  for (const Vertices& vertices : found) {
    for (const auto& chain : vertices.on_sides) {
      for (const Index v : chain) is_found[v] = true;
    }
    for (const Index v : vertices.inside) is_found[v] = true;
  }
  for (Index t = 0; t < complex_.tetrahedra.size(); ++t) {
    for (int i = 0; i < 4; ++i) {
      Face face = face_of(complex_.tetrahedra[t], i);
      const Index across = neighbours.across[4 * t + static_cast<Index>(i)];
      if (across != kNone && across / 4 < t) continue;
      if (!std::ranges::all_of(face, [&](Index v) { return is_corner_[v] || is_found[v]; })) {
        continue;
      }
      sort_face(face);
      for (const Index v : face) {
        if (is_found[v]) faces_at_[v].insert(face);
      }
    }
  }
}

SplitTriangles::Split SplitTriangles::faces_of(const Face& triangle,
                                               const Vertices& vertices) const {
  using Edge = std::pair<Index, Index>;
  std::set<Edge> rim;
  std::map<Index, unsigned> known;  // the sides on which a vertex is, a bit for each
  std::set<Face> faces;
  const auto add = [&](Index v, unsigned sides) {
    known[v] |= sides;
    const auto at = faces_at_.find(v);
    if (at != faces_at_.end()) faces.insert(at->second.begin(), at->second.end());
  };
  for (const Index v : vertices.inside) add(v, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    Index last = triangle[k];
    known[last] |= 1U << k;
    for (const Index v : vertices.on_sides[k]) {
      add(v, 1U << k);
      rim.emplace(last, v);
      last = v;
    }
    rim.emplace(last, triangle[(k + 1) % 3]);
    known[triangle[(k + 1) % 3]] |= 1U << k;
  }
  const ExactVector normal = exact::area2(points_, triangle[0], triangle[1], triangle[2]);
  Split result;
  std::set<Edge> edges;
  for (Face face : faces) {
    unsigned common_sides = 7;
    const bool is_here = std::ranges::all_of(face, [&](Index v) {
      const auto at = known.find(v);
      if (at == known.end()) return false;
      common_sides &= at->second;
      return true;
    });
    if (!is_here || common_sides != 0) continue;
    const int turn = sgn(exact::dot(exact::area2(points_, face[0], face[1], face[2]), normal));
    if (turn == 0) return {{}, true};
    if (turn < 0) std::swap(face[1], face[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.emplace(face[k], face[(k + 1) % 3]).second) return {{}, true};
    }
    result.faces.push_back(face);
  }
  const bool bounded = std::ranges::all_of(edges, [&](const Edge& edge) {
    const Edge back = {edge.second, edge.first};
    return rim.contains(edge) ? !edges.contains(back) : edges.contains(back);
  });
  const bool closed =
      std::ranges::all_of(rim, [&](const Edge& edge) { return edges.contains(edge); });
  return bounded && closed ? result : Split();
}

}  // namespace tetproof::oracles
