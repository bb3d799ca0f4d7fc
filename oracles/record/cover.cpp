#include "oracles/record/cover.h"

#include <algorithm>
#include <iterator>
#include <unordered_map>

#include "oracles/record/refined_index.h"

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

// A directed edge that a facet has on its left.
struct Side {
  Index facet, from, to;
  auto operator<=>(const Side&) const = default;
};

// The sum of the faces on a facet, less the facet, is a chain of the plane, and so is its boundary:
// the sides that the two do not share. It vanishes outside the bounding boxes of the connected
// parts of these sides.
class Uncovered {
 public:
  explicit Uncovered(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        facets_(surface_, record_),
        input_edges_(surface_) {}

  void find(Cover& cover) {
    collect_sides_of_faces();
    collect_sides_of_facets();
    std::vector<Side> differ;
    std::sort(of_faces_.begin(), of_faces_.end());
    std::sort(of_facets_.begin(), of_facets_.end());
    std::set_symmetric_difference(of_faces_.begin(), of_faces_.end(), of_facets_.begin(),
                                  of_facets_.end(), std::back_inserter(differ));
    for (std::size_t first = 0; first < differ.size();) {
      std::size_t last = first;
      while (last < differ.size() && differ[last].facet == differ[first].facet) ++last;
      add_boxes(std::span(differ).subspan(first, last - first), cover);
      first = last;
    }
    cover.rest = std::make_unique<const BoxTree>(std::move(boxes_));
  }

 private:
  // Sides between two faces of one facet cancel.
  void collect_sides_of_faces() {
    std::vector<Side> all;
    all.reserve(3 * record_.refined_facets.size());
    for (const auto& [a, b, c, id] : record_.refined_facets) {
      const Index f = facets_.find(id);
      if (f == kNone || std::max({a, b, c}) >= points_.size()) continue;
      all.insert(all.end(), {{f, a, b}, {f, b, c}, {f, c, a}});
    }
    std::sort(all.begin(), all.end());
    for (const Side& side : all) {
      if (!std::binary_search(all.begin(), all.end(), Side{side.facet, side.to, side.from})) {
        of_faces_.push_back(side);
      }
    }
  }

  // The sides on the input's edges, along their segments where there are any.
  void collect_sides_of_facets() {
    std::vector<const ExactRecord::Chain*> chain(surface_.edges().size(), nullptr);
    for (const ExactRecord::Chain& segment : record_.segments) {
      if (segment.artificial || segment.vertices.size() < 2) continue;
      const Index e = input_edges_.of_chain(record_, segment.vertices);
      if (e != kNone) chain[e] = &segment;
    }
    of_facets_.reserve(2 * chain.size());
    std::vector<Index> way;
    for (std::size_t e = 0; e < chain.size(); ++e) {
      const InputSurface::Edge& edge = surface_.edges()[e];
      way.assign(1, edge.from);
      if (chain[e] != nullptr) {
        const std::vector<Index>& v = chain[e]->vertices;
        // Either direction is right; the edge's own leaves the smaller boxes.
        const Interval along = exact::dot(points_.rough_difference(edge.from, edge.to),
                                          points_.rough_difference(v.front(), v.back()));
        if (along.sign() == -1) {
          way.insert(way.end(), v.rbegin(), v.rend());
        } else {
          way.insert(way.end(), v.begin(), v.end());
        }
      }
      way.push_back(edge.to);
      for (std::size_t i = 1; i < way.size(); ++i) {
        if (way[i - 1] == way[i]) continue;
        of_facets_.push_back({edge.left, way[i - 1], way[i]});
        of_facets_.push_back({edge.right, way[i], way[i - 1]});
      }
    }
  }

  void add_boxes(std::span<const Side> sides, Cover& cover) {
    std::unordered_map<Index, Index> parent;
    const auto root = [&](Index v) {
      Index at = parent.try_emplace(v, v).first->second;
      while (parent[at] != at) at = parent[at] = parent[parent[at]];
      return at;
    };
    for (const Side& side : sides) {
      const Index a = root(side.from), b = root(side.to);
      parent[std::max(a, b)] = std::min(a, b);
    }
    std::unordered_map<Index, std::vector<Index>> parts;
    for (const auto& [v, above] : parent) parts[root(above)].push_back(v);
    for (const auto& [first, vertices] : parts) {
      const BoxTree::Box part = box_around(points_, vertices);
      std::vector<Index> found;
      surface_.triangles_near(part, found);
      for (const Index t : found) {
        if (surface_.facet_of_triangle()[t] != sides[0].facet) continue;
        BoxTree::Box box = box_around(points_, surface_.triangles()[t]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
          box.low[axis] = std::max(box.low[axis], part.low[axis]);
          box.high[axis] = std::min(box.high[axis], part.high[axis]);
        }
        boxes_.push_back(box);
        cover.triangles.push_back(t);
      }
    }
  }

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const FacetIndex facets_;
  const InputEdges input_edges_;
  std::vector<Side> of_faces_, of_facets_;
  std::vector<BoxTree::Box> boxes_;
};

}  // namespace

std::vector<std::uint8_t> walls_of(const TetComplex& complex,
                                   std::span<const std::array<std::uint32_t, 4>> faces) {
  std::vector<std::uint8_t> walls(complex.tetrahedra.size());
  std::vector<Face> corners;
  corners.reserve(faces.size());
  for (const auto& [a, b, c, id] : faces) corners.push_back({a, b, c});
  const SimplexSet<3> listed(corners);
  for_each_face_in(listed, complex.tetrahedra, [&walls](std::size_t t, int i, std::size_t) {
    walls[t] |= static_cast<std::uint8_t>(1U << i);
  });
  return walls;
}

Cover cover_of(const RefinedMesh& mesh) {
  Cover cover;
  cover.walls = walls_of(*mesh.complex, mesh.record->refined_facets);
  Uncovered(mesh).find(cover);
  return cover;
}

}  // namespace tetproof::oracles
