// The subfacets of a refinement: the triangles into which the facets of the complex are split
// (section 5.3).
//
// Invariants at any time:
//  - the live subfacets of a facet are the Delaunay triangulation of its vertices in its plane,
//    bounded by its subsegments: each is counter-clockwise seen from outside, and across each of
//    its edges lies either a subsegment or a neighbour that names it in return;
//  - only subfacets are in the queue, some of which may be dead;
//  - the dead are counted; their slots are used again only when all are renumbered.
// Invariants between insertions, for a live subfacet that is not in the queue:
//  - it is a face of the tetrahedrization, and both tetrahedra there (a ghost on the hull) have its
//    face's bit in their notes (Note::faces) and its number. These may also name dead subfacets;
//  - with the Gabriel property, its open diametral ball is empty.
// That subsegments name the subfacets beside them is checked by Refiner::validate().
#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesher/base/growing_array.h"
#include "mesher/delaunay/planar.h"
#include "mesher/refine/notes.h"
#include "mesher/refine/planar_cavity.h"
#include "mesher/refine/subfacet_edge.h"
#include "mesher/refine/subsegments.h"
#include "mesher/refine/work_queue.h"
#include "mesher/surface/plc.h"

namespace delmesher::refine {

class Subfacets {
 public:
  struct Subfacet {
    std::array<VertexId, 3> v;  // counter-clockwise seen from outside
    // Of each edge, opposite v[i]: its other side, or none and the subsegment there.
    std::array<SubfacetEdge, 3> neighbor;
    std::array<std::uint32_t, 3> subsegment;
    std::uint32_t facet;  // of the complex
    bool alive = true;
  };

  // `gabriel`: is the Gabriel property asked for?
  Subfacets(const Plc& plc, PointStore& points, Tetrahedrization& dt, Subsegments& subsegments,
            bool gabriel)
      : plc_(plc), points_(points), dt_(dt), subsegments_(subsegments), gabriel_(gabriel) {}

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

  // --- in the plane of a facet
  // Positive if counter-clockwise seen from outside.
  int orient(std::uint32_t facet, VertexId a, VertexId b, VertexId c) const {
    return planes_[facet].axis_sign * dt_.predicates().orient2d(planes_[facet].axis, a, b, c);
  }
  // Is v in the (perturbed) circumcircle?
  bool in_circle(std::uint32_t s, VertexId v) const {
    const Subfacet& f = list_[s];
    return dt_.predicates().insphere_perturbed(f.v[0], f.v[1], f.v[2], planes_[f.facet].off_plane,
                                               v) > 0;
  }
  struct Location {
    std::uint32_t subfacet;  // that contains the point, or kNone
    std::uint32_t blocked;   // and the subsegment in the way, or kNone
  };
  // Walks from `start` towards a point of its facet.
  Location locate(VertexId v, std::uint32_t start) const;
  // Makes v, which lies in the subfacet, a vertex of its facet.
  void insert(VertexId v, std::uint32_t container);
  // Makes v a vertex of the facet on one side of a subsegment that v has split into two.
  void insert_on_edge(VertexId v, SubfacetEdge side, std::uint32_t half_a, std::uint32_t half_b);
  // Since forget_created(). The vertex inserted comes first.
  std::span<const std::uint32_t> created() const { return created_; }
  void forget_created() { created_.clear(); }

  // --- in the tetrahedrization
  // The live subfacet on face i of a tetrahedron, or kNone.
  std::uint32_t on_face(TetId t, int i) const {
    if ((note(dt_, t, Note::faces) >> i & 1) == 0) return kNone;
    const std::uint32_t s = on_face_[t][i];
    return list_[s].alive ? s : kNone;
  }
  // False only if no face of t is a subfacet.
  bool any_on(TetId t) const { return note(dt_, t, Note::faces) != 0; }
  // Is v strictly inside the diametral ball of s? It has to be no corner of it.
  bool encroached_by(std::uint32_t s, VertexId v) const {
    const auto& c = list_[s].v;
    return dt_.predicates().in_diametral_ball(c[0], c[1], c[2], v) > 0;
  }
  // Marks the subfacet on a face of the tetrahedrization. Queues it if it is missing there (no
  // face) or, with the Gabriel property, encroached.
  void settle(std::uint32_t s, FaceHandle face);
  // The same for created(), whose faces are among the tetrahedra created last.
  void settle_created();
  // To be called before anything is said of tetrahedra that are new.
  void make_room() {
    if (dt_.capacity() > on_face_.size()) on_face_.resize(dt_.capacity());
  }
  // `created` came from the tetrahedron `inner` by a new vertex in the place of `face`.
  void inherit(TetId created, TetId inner, int face) {
    const auto bit = static_cast<std::uint8_t>(1U << face);
    std::uint8_t& faces = note(dt_, created, Note::faces);
    faces = note(dt_, inner, Note::faces) & bit;
    if (faces != 0) on_face_[created][face] = on_face_[inner][face];
  }

  // --- queue
  void queue(std::uint32_t s) {
    if (list_[s].alive) queue_.add(s);
  }
  // Takes the first live one out of the queue; kNone if there is none.
  std::uint32_t take_queued();
  bool queue_empty() const { return queue_.empty(); }

  // Dead subfacets keep their slots, so that stale references to them are recognized; where they
  // outnumber the living, all are renumbered, in the same order. Not to be called between finding
  // constraints and settling.
  void renumber_if_sparse();

  // Gives memory back; nothing may be asked about tetrahedra afterwards.
  void release_marks() { on_face_.release(); }

  // Throws InternalError at the first broken invariant.
  void validate(Control& control);

 private:
  friend struct SubfacetsBreaker;  // of the tests of validate()

  std::uint32_t add(const std::array<VertexId, 3>& v, std::uint32_t facet);
  void make_point_off_plane(std::uint32_t f);
  void build_facet(std::uint32_t f);
  void link(std::uint32_t s, std::uint32_t edge, std::uint32_t subsegment);
  void fill_cavity(VertexId v, std::uint32_t half_a, std::uint32_t half_b);
  void renumber();
  void validate_dead() const;
  void validate_in_facet(std::uint32_t s) const;
  void validate_in_mesh(std::uint32_t s);

  const Plc& plc_;
  PointStore& points_;
  Tetrahedrization& dt_;
  Subsegments& subsegments_;
  bool gabriel_;
  bool built_ = false;
  GrowingArray<Subfacet> list_;
  std::size_t dead_ = 0;
  std::vector<FacetPlane> planes_;                      // per facet
  GrowingArray<std::array<std::uint32_t, 4>> on_face_;  // per tetrahedron, where its note says so
  WorkQueue queue_;
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
