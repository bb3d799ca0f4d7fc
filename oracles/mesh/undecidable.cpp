// Whether positions tell which edge of the input a mesh edge is on (conformity.h).
#include <algorithm>
#include <unordered_map>

#include "oracles/base/distances.h"
#include "oracles/mesh/conformity.h"

namespace tetproof::oracles {
namespace {

// Is the root of a squared distance at most `distance`?
bool within(const ExactPoints& points, const mpq_class& squared, double distance) {
  return square_root(squared, points.exponent()) <= distance;
}

// Does the bounding box of an edge, widened, contain a vertex?
bool boxed(const ExactPoints& points, const InputSurface::Edge& edge, Index v, double distance) {
  const Position p = points.nearest(edge.from), q = points.nearest(edge.to), x = points.nearest(v);
  for (std::size_t i = 0; i < 3; ++i) {
    if (x[i] < std::min(p[i], q[i]) - 2 * distance || x[i] > std::max(p[i], q[i]) + 2 * distance) {
      return false;
    }
  }
  return true;
}

// Finds the edges for which a file cannot tell whether a vertex is on them or on another edge.
class Ambiguity {
 public:
  Ambiguity(const TetComplex& complex, const InputSurface& surface,
            const ConformityResult& conformity, double ulps, double largest_given)
      : points_(*complex.points), surface_(surface), ulps_(ulps), largest_given_(largest_given) {
    for (const Face& face : conformity.faces) {
      vertices_.insert(vertices_.end(), face.begin(), face.end());
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  }

  bool at(Index edge) const {
    return std::any_of(vertices_.begin(), vertices_.end(), [&](Index v) {
      const InputSurface::Edge& e = surface_.edges()[edge];
      if (!near(e, v) || exact::equal(points_, v, e.from) || exact::equal(points_, v, e.to)) {
        return false;
      }
      return std::any_of(
          surface_.edges().begin(), surface_.edges().end(),
          [&](const InputSurface::Edge& other) { return &other != &e && near(other, v); });
    });
  }

 private:
  bool near(const InputSurface::Edge& edge, Index v) const {
    const double distance = ulps_ * surface_.ulp_on(edge, largest_given_);
    return boxed(points_, edge, v, distance) &&
           within(points_, squared_distance_to_segment(points_, v, edge.from, edge.to), distance);
  }

  const ExactPoints& points_;
  const InputSurface& surface_;
  double ulps_, largest_given_;
  std::vector<Index> vertices_;
};

// Is every face of the boundary, with all its corners, so near to one facet?
bool along_surface(const TetComplex& complex, const InputSurface& surface,
                   const std::vector<Face>& faces, double ulps, double largest_given) {
  const ExactPoints& points = *complex.points;
  const double most =
      ulps * unit_in_last_place(std::max(surface.largest_coordinate(), largest_given));
  std::unordered_map<Index, std::vector<Index>> near;  // the facets near each vertex, sorted
  std::vector<Index> found;
  const auto facets_near = [&](Index v) -> const std::vector<Index>& {
    const auto [at, fresh] = near.try_emplace(v);
    if (!fresh) return at->second;
    found.clear();
    surface.triangles_near(enlarged(box_around(points, std::array{v}), 2 * most), found);
    for (const Index t : found) {
      const auto& triangle = surface.triangles()[t];
      const Index facet = surface.facet_of_triangle()[t];
      const double distance = ulps * surface.ulp_on(facet, largest_given);
      if (!within(points, squared_distance_to_triangle(points, v, triangle), distance)) continue;
      at->second.push_back(facet);
    }
    std::sort(at->second.begin(), at->second.end());
    at->second.erase(std::unique(at->second.begin(), at->second.end()), at->second.end());
    return at->second;
  };
  return std::all_of(faces.begin(), faces.end(), [&](const Face& face) {
    const std::vector<Index> first = facets_near(face[0]);
    return std::any_of(first.begin(), first.end(), [&](Index f) {
      const auto has = [&](Index v) {
        const std::vector<Index>& list = facets_near(v);
        return std::binary_search(list.begin(), list.end(), f);
      };
      return has(face[1]) && has(face[2]);
    });
  });
}

}  // namespace

bool undecidable(const TetComplex& complex, const InputSurface& surface,
                 const ConformityResult& conformity, double ulps, double largest_given) {
  if (conformity.failed_elsewhere > 0 || conformity.report.passed()) return false;
  if (!along_surface(complex, surface, conformity.faces, ulps, largest_given)) return false;
  const Ambiguity ambiguity(complex, surface, conformity, ulps, largest_given);
  const auto& edges = surface.edges();
  return std::all_of(conformity.failed_edges.begin(), conformity.failed_edges.end(),
                     [&](Index e) { return ambiguity.at(e); }) &&
         std::all_of(conformity.failed_facets.begin(), conformity.failed_facets.end(),
                     [&](Index facet) {
                       for (Index e = 0; e < edges.size(); ++e) {
                         if (edges[e].left != facet && edges[e].right != facet) continue;
                         if (ambiguity.at(e)) return true;
                       }
                       return false;
                     });
}

}  // namespace tetproof::oracles
