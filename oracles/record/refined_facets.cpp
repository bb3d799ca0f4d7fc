#include "oracles/record/refinement.h"

#include <algorithm>
#include <utility>

namespace tetproof::oracles {
namespace {

using delmesher::ExactRecord;

class RefinedFacets {
 public:
  explicit RefinedFacets(const RefinedMesh& mesh)
      : record_(*mesh.record),
        points_(*mesh.points),
        surface_(*mesh.surface),
        complex_(*mesh.complex),
        facets_(surface_, record_),
        faces_(faces_on_facets(record_)),
        in_mesh_(faces_.size()) {}

  OracleReport run() {
    find_mesh_faces();
    sides_.reserve(3 * record_.refined_facets.size());
    for (const auto& [a, b, c, id] : record_.refined_facets) check_face({a, b, c}, id);
    report_.checked += surface_.facets().size();
    collect_chains();
    check_borders();
    return std::move(report_);
  }

 private:
  void find_mesh_faces();
  void check_face(Face face, Index id);
  void collect_chains();
  void check_borders();

  const ExactRecord& record_;
  const ExactPoints& points_;
  const InputSurface& surface_;
  const TetComplex& complex_;
  const FacetIndex facets_;
  const SimplexSet<3> faces_;
  std::vector<std::uint8_t> in_mesh_;  // per face
  // There are more of these than of anything else, so they are as small as can be.
  struct EdgeOfFacet {
    Index facet, low, high;
    static EdgeOfFacet of(Index facet, Index a, Index b) {
      return {facet, std::min(a, b), std::max(a, b)};
    }
    auto operator<=>(const EdgeOfFacet&) const = default;
  };
  struct Side {  // of a face
    Index facet, from, to;
    EdgeOfFacet edge() const { return EdgeOfFacet::of(facet, from, to); }
    bool forward() const { return from < to; }
    bool operator==(const Side&) const = default;
  };
  std::vector<Side> sides_;
  std::vector<EdgeOfFacet> chained_;  // edges of chains
  OracleReport report_{"facets", "facets and faces"};
};

void RefinedFacets::find_mesh_faces() {
  for_each_face_in(faces_, complex_.tetrahedra,
                   [this](std::size_t, int, std::size_t face) { in_mesh_[face] = 1; });
}

void RefinedFacets::check_face(Face face, Index id) {
  ++report_.checked;
  if (in_mesh_[faces_.find(face)] == 0) {
    return report_.fail(complex_.face_name(face) + " is not a face of the refined mesh");
  }
  const Index f = facets_.find(id);
  if (f == kNone) {
    return report_.fail(complex_.face_name(face) + ": there is no facet " + std::to_string(id));
  }
  const InputSurface::Facet& facet = surface_.facets()[f];
  for (const Index v : face) {
    if (facet.side(points_, v) != 0) {
      report_.fail(complex_.vertex_name(v) + " is off the plane of facet " + std::to_string(id));
    }
  }
  if (!facets_.kept(f)) report_.fail(complex_.face_name(face) + " lies on a filtered facet");
  if (facet.facing(points_, face) <= 0) {
    report_.fail(complex_.face_name(face) + " is folded over on facet " + std::to_string(id));
  }
  for (int i = 0; i < 3; ++i) {
    sides_.push_back({f, face[i], face[(i + 1) % 3]});
  }
}

void RefinedFacets::collect_chains() {
  const InputEdges input_edges(surface_);
  for (const ExactRecord::Chain& chain : record_.segments) {
    std::array<Index, 2> of = {kNone, kNone};
    if (chain.artificial) {
      of[0] = facets_.find(chain.facet);
    } else if (const Index e = input_edges.of_chain(record_, chain.vertices); e != kNone) {
      of = {surface_.edges()[e].left, surface_.edges()[e].right};
    }
    for (const Index f : of) {
      if (f == kNone || !facets_.kept(f)) continue;
      for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
        chained_.push_back(EdgeOfFacet::of(f, chain.vertices[i - 1], chain.vertices[i]));
      }
    }
  }
  std::sort(chained_.begin(), chained_.end());
}

// A side of a face has its opposite among the faces of the facet, or lies on a chain of the facet;
// and on every edge of a chain there is exactly one side.
void RefinedFacets::check_borders() {
  std::sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
    return std::pair(a.edge(), a.forward()) < std::pair(b.edge(), b.forward());
  });
  const auto name = [&](const EdgeOfFacet& edge) {
    return "edge " + complex_.vertex_name(edge.low) + " - " + complex_.vertex_name(edge.high) +
           " of facet " + std::to_string(surface_.facets()[edge.facet].id);
  };
  if (const auto twice = std::adjacent_find(sides_.begin(), sides_.end()); twice != sides_.end()) {
    report_.fail(name(twice->edge()) + " has two faces on one side");
  }
  std::vector<EdgeOfFacet> open;
  for (std::size_t i = 0; i < sides_.size();) {
    const Side& side = sides_[i];
    bool pair = false;
    std::size_t end = i;
    for (; end < sides_.size() && sides_[end].edge() == side.edge(); ++end) {
      pair = pair || sides_[end].forward() != side.forward();
    }
    if (!pair) open.insert(open.end(), end - i, side.edge());
    i = end;
  }
  for (const auto& side : open) {
    if (!std::binary_search(chained_.begin(), chained_.end(), side)) {
      report_.fail(name(side) + " has a face on one side only and is on no segment");
    }
  }
  for (const auto& side : chained_) {
    if (!std::binary_search(open.begin(), open.end(), side)) {
      report_.fail(name(side) + " is on a segment but does not bound the faces");
    }
  }
  report_.figures.emplace_back("edges on segments", chained_.size());
}

}  // namespace

OracleReport check_refined_facets(const RefinedMesh& mesh) {
  return RefinedFacets(mesh).run();
}

}  // namespace tetproof::oracles
