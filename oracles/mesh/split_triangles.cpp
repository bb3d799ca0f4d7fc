#include "oracles/mesh/split_triangles.h"

#include <algorithm>
#include <set>
#include <utility>

#include "oracles/base/distances.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {
namespace {

double rounded_up(const ExactPoints& points, const mpq_class& squared) {
  return square_root(squared, points.exponent()) * (1 + 1e-12);
}

}  // namespace

double distance_rounded_up(const ExactPoints& points, Index v, const Face& triangle) {
  return rounded_up(points, squared_distance_to_triangle(points, v, triangle));
}

SplitTriangles::SplitTriangles(const TetComplex& complex, std::span<const std::int64_t> regions,
                               std::span<const Face> triangles, double near)
    : complex_(complex),
      points_(*complex.points),
      regions_(regions),
      triangles_(triangles),
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
  find_triangles(tree, added, vertices);
  for (std::size_t n = 0; n < asked.size(); ++n) {
    if (result[n].is_ambiguous) continue;
    result[n] = faces_of(asked[n], vertices[n]);
    if (is_beside_others(asked[n], vertices[n])) result[n].is_ambiguous = true;
    for (const Face& face : result[n].faces) {
      for (const Index v : face) {
        const auto at = vertices[n].off.find(v);
        if (at != vertices[n].off.end()) deviation_ = std::max(deviation_, at->second);
      }
    }
  }
  return result;
}

// False if one is near two sides, or their order is none.
bool SplitTriangles::find_vertices(const Face& triangle, const std::vector<Index>& around,
                                   Vertices& vertices) const {
  for (const Index v : around) {
    double off = distance_rounded_up(points_, v, triangle);
    if (!(off <= near_)) continue;
    int sides = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off_side = rounded_up(
          points_, squared_distance_to_segment(points_, v, triangle[k], triangle[(k + 1) % 3]));
      if (!(off_side <= near_)) continue;
      ++sides;
      off = std::max(off, off_side);
      vertices.on_sides[k].push_back(v);
    }
    if (sides > 1) return false;
    if (sides == 0) vertices.inside.push_back(v);
    vertices.off.emplace(v, off);
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

// All triangles to which vertices that were found are near.
void SplitTriangles::find_triangles(const BoxTree& tree, std::span<const Index> added,
                                    std::span<const Vertices> found) {
  for (const Vertices& vertices : found) {
    for (const auto& [v, off] : vertices.off) triangles_at_[v];
  }
  std::vector<Index> around;
  for (const Face& triangle : triangles_) {
    around.clear();
    tree.query(enlarged(box_around(points_, triangle), near_), around);
    for (const Index n : around) {
      const auto at = triangles_at_.find(added[n]);
      if (at != triangles_at_.end() && distance_rounded_up(points_, added[n], triangle) <= near_) {
        at->second.push_back(triangle);
      }
    }
  }
}

// Is a vertex near a triangle that has not the side on which it is?
bool SplitTriangles::is_beside_others(const Face& triangle, const Vertices& vertices) const {
  const auto has = [](const Face& face, Index v) { return std::ranges::count(face, v) > 0; };
  return std::ranges::any_of(vertices.off, [&](const auto& vertex) {
    return std::ranges::any_of(triangles_at_.at(vertex.first), [&](const Face& other) {
      if (std::ranges::is_permutation(other, triangle)) return false;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool is_on_side = std::ranges::count(vertices.on_sides[k], vertex.first) > 0;
        if (is_on_side && has(other, triangle[k]) && has(other, triangle[(k + 1) % 3])) {
          return false;
        }
      }
      return true;
    });
  });
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
      const bool is_wall =
          across == kNone || (!regions_.empty() && regions_[t] != regions_[across / 4]);
      sort_face(face);
      for (const Index v : face) {
        if (is_found[v]) faces_at_[v].emplace(face, is_wall);
      }
    }
  }
}

class SplitTriangles::Tiles {
 public:
  void add(const Face& face, bool is_wall) {
    for (std::size_t k = 0; k < 3; ++k) {
      at_[{face[k], face[(k + 1) % 3]}].push_back({face, is_wall});
    }
  }
  // Its edges lie in a line, seen along the normal.
  void add_flat(const Face& face) {
    for (std::size_t k = 0; k < 3; ++k) {
      flat_.insert({face[k], face[(k + 1) % 3]});
      flat_.insert({face[(k + 1) % 3], face[k]});
    }
  }

  // Edges wait for the face on their left, those with one choice first: it may be that of others.
  Split run(const std::set<Edge>& rim) {
    Split result;
    std::set<Edge> done, clear, unclear;
    const auto wait = [&](const Edge& edge) {
      (next(edge) != nullptr ? clear : unclear).insert(edge);
      result.is_ambiguous = result.is_ambiguous || flat_.contains(edge) || choices(edge) > 1;
    };
    std::ranges::for_each(rim, wait);
    while (!clear.empty()) {
      const Face face = *next(*clear.begin());
      for (std::size_t k = 0; k < 3; ++k) {
        const Edge edge = {face[k], face[(k + 1) % 3]}, back = {edge.second, edge.first};
        if (!done.insert(edge).second || rim.contains(back)) return {{}, result.is_ambiguous};
        clear.erase(edge);
        unclear.erase(edge);
        if (!rim.contains(edge) && !done.contains(back)) wait(back);
      }
      result.faces.push_back(face);
    }
    if (!unclear.empty()) return {{}, result.is_ambiguous};
    return result;
  }

 private:
  struct Tile {
    Face face;
    bool is_wall;
  };

  std::size_t choices(const Edge& edge) const {
    const auto at = at_.find(edge);
    return at == at_.end() ? 0 : at->second.size();
  }
  // Null: there is none, or more than one.
  const Face* next(const Edge& edge) const {
    const auto at = at_.find(edge);
    if (at == at_.end()) return nullptr;
    const std::vector<Tile>& tiles = at->second;
    if (tiles.size() == 1) return &tiles.front().face;
    const auto wall = std::ranges::find(tiles, true, &Tile::is_wall);
    return std::ranges::count(tiles, true, &Tile::is_wall) == 1 ? &wall->face : nullptr;
  }

  std::map<Edge, std::vector<Tile>> at_;
  std::set<Edge> flat_;
};

SplitTriangles::Split SplitTriangles::faces_of(const Face& triangle,
                                               const Vertices& vertices) const {
  std::set<Edge> rim;
  std::map<Index, unsigned> known;  // the sides on which a vertex is, a bit for each
  FacesAt faces;
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
  Tiles tiles;
  for (const auto& [sorted, is_wall] : faces) {
    Face face = sorted;
    unsigned common_sides = 7;
    bool is_here = true;
    for (const Index v : face) {
      const auto at = known.find(v);
      is_here = is_here && at != known.end();
      if (is_here) common_sides &= at->second;
    }
    if (!is_here || common_sides != 0) continue;
    const int turn = sgn(exact::dot(exact::area2(points_, face[0], face[1], face[2]), normal));
    if (turn < 0) std::swap(face[1], face[2]);
    if (turn == 0) {
      tiles.add_flat(face);
    } else {
      tiles.add(face, is_wall);
    }
  }
  return tiles.run(rim);
}

}  // namespace tetproof::oracles
