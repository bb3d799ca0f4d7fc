// The facets of the complex as they are triangulated in their planes (section 5.3). The triangles
// are the subfacets, numbered through all facets.
//
// Invariants at any time:
//  - the live subfacets of a facet are the Delaunay triangulation of its vertices in its plane,
//    bounded by its subsegments: each is counter-clockwise seen from outside, and across each of
//    its edges lies either a subsegment or a neighbour that names it in return;
//  - the dead are counted; their slots are used again only when all are renumbered.
// That subsegments name the subfacets beside them is checked by Refiner::validate(). Whether a
// subfacet is a face of the tetrahedrization is the concern of Subfacets, not of this class.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/base/growing_array.h"
#include "mesher/delaunay/planar.h"
#include "mesher/refine/planar_cavity.h"
#include "mesher/refine/subfacet_edge.h"
#include "mesher/refine/subsegments.h"
#include "mesher/surface/plc.h"

namespace delmesher::refine {

struct Subfacet {
  std::array<VertexId, 3> v;  // counter-clockwise seen from outside
  // Edge i is opposite v[i]. Beyond it is a neighbour (then subsegment[i] is kNone) or a subsegment
  // (then neighbor[i] is none).
  std::array<SubfacetEdge, 3> neighbor;
  std::array<std::uint32_t, 3> subsegment;
  std::uint32_t facet;  // of the complex
  bool alive = true;
};

class FacetTriangulations {
 public:
  FacetTriangulations(const Plc& plc, PointStore& points, Predicates& predicates,
                      Subsegments& subsegments)
      : plc_(plc), points_(points), predicates_(predicates), subsegments_(subsegments) {}

  // Triangulates every facet. Adds a point off each facet's plane to the store. The subsegments
  // must be edges of the triangulations, as they are when all are edges of the tetrahedrization.
  void build(Control& control);
  bool built() const { return built_; }

  // The dead included.
  std::uint32_t size() const { return static_cast<std::uint32_t>(list_.size()); }
  const Subfacet& operator[](std::uint32_t s) const { return list_[s]; }
  const Subfacet* begin() const { return list_.begin(); }
  const Subfacet* end() const { return list_.end(); }
  // From end to end, counter-clockwise around the subfacet.
  std::array<VertexId, 2> ends(SubfacetEdge e) const {
    const auto& v = list_[e.subfacet()].v;
    return {v[(e.edge() + 1) % 3], v[(e.edge() + 2) % 3]};
  }

  // Positive if counter-clockwise seen from outside.
  int orient(std::uint32_t facet, VertexId a, VertexId b, VertexId c) const {
    return planes_[facet].axis_sign * predicates_.orient2d(planes_[facet].axis, a, b, c);
  }
  // Is v in the (perturbed) circumcircle?
  bool in_circle(std::uint32_t s, VertexId v) const {
    const Subfacet& f = list_[s];
    return predicates_.insphere_perturbed(f.v[0], f.v[1], f.v[2], planes_[f.facet].off_plane, v) >
           0;
  }

  struct Location {
    std::uint32_t subfacet;  // the one that contains the point; kNone if the walk was blocked
    std::uint32_t blocked;   // the subsegment that blocked the walk, or kNone
  };
  // Walks from `start` towards a point of its facet.
  Location locate(VertexId v, std::uint32_t start) const;
  // Makes v, which lies in the subfacet, a vertex of its facet.
  void insert(VertexId v, std::uint32_t container);
  // Makes v a vertex of a facet beside a subsegment that v has split. `side`: the edge that the
  // subsegment was there; `half_a`: the half that kept its number; `half_b`: the new half.
  void insert_on_edge(VertexId v, SubfacetEdge side, std::uint32_t half_a, std::uint32_t half_b);
  // The subfacets created since forget_created(). Each has the vertex inserted as its first.
  std::span<const std::uint32_t> created() const { return created_; }
  void forget_created() { created_.clear(); }

  // Dead subfacets keep their slots, so that stale references to them are recognized. Are there so
  // many that renumbering pays?
  bool sparse() const;
  // Drops the dead. Returns the new number of each subfacet, kNone of the dead; the living keep
  // their order. Neighbours and subsegments know the new numbers. Not to be called between an
  // insertion and the last look at created().
  std::vector<std::uint32_t> renumber();

  // Throws InternalError at the first broken invariant.
  void validate(Control& control) const;

 private:
  friend struct FacetTriangulationsBreaker;  // of the tests of validate()

  std::uint32_t add(const std::array<VertexId, 3>& v, std::uint32_t facet);
  void make_point_off_plane(std::uint32_t f);
  void build_facet(std::uint32_t f);
  void link(std::uint32_t s, std::uint32_t edge, std::uint32_t subsegment);
  void fill_cavity(VertexId v, std::uint32_t half_a, std::uint32_t half_b);
  void validate_dead() const;
  void validate_subfacet(std::uint32_t s) const;

  const Plc& plc_;
  PointStore& points_;
  Predicates& predicates_;
  Subsegments& subsegments_;
  bool built_ = false;
  GrowingArray<Subfacet> list_;
  std::size_t dead_ = 0;
  std::vector<FacetPlane> planes_;  // per facet
  std::vector<std::uint32_t> created_;
  // Scratch of an insertion.
  struct Spoke {
    VertexId from;
    std::uint32_t subfacet;
  };
  PlanarCavity cavity_;
  std::vector<Spoke> spokes_;
};

}  // namespace delmesher::refine
