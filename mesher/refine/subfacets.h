// The subfacets of a refinement and their presence in the tetrahedrization: which of its faces they
// are, and which of them wait to be split (section 5.3).
//
//   FacetTriangulations  the subfacets in the planes of their facets
//   SubfacetMarks        the faces of tetrahedra that are subfacets
//   WorkQueue            the subfacets to split
//
// Invariant at any time, besides those of the parts: only subfacets are in the queue, some of which
// may be dead.
// Invariants between insertions, for a live subfacet that is not in the queue:
//  - it is a face of the tetrahedrization, which is marked with its number;
//  - with the Gabriel property, its open diametral ball is empty.
#pragma once

#include "mesher/refine/facet_triangulations.h"
#include "mesher/refine/subfacet_marks.h"
#include "mesher/refine/work_queue.h"

namespace delmesher::refine {

class Subfacets {
 public:
  // `gabriel`: is the Gabriel property asked for?
  Subfacets(const Plc& plc, PointStore& points, Tetrahedrization& dt, Subsegments& subsegments,
            bool gabriel)
      : dt_(dt),
        gabriel_(gabriel),
        planar_(plc, points, dt.predicates(), subsegments),
        marks_(dt) {}

  // Triangulates the facets. None is settled yet.
  void build(Control& control);

  // The subfacets in their planes.
  const FacetTriangulations& planar() const { return planar_; }
  FacetTriangulations& planar() { return planar_; }
  std::uint32_t size() const { return planar_.size(); }
  const Subfacet& operator[](std::uint32_t s) const { return planar_[s]; }

  // The live subfacet on face i of a tetrahedron, or kNone.
  std::uint32_t on_face(TetId t, int i) const {
    const std::uint32_t s = marks_.of(t, i);
    return s != kNone && planar_[s].alive ? s : kNone;
  }
  // False only if no face of t is a subfacet.
  bool any_on(TetId t) const { return marks_.any_on(t); }
  // Is v strictly inside the diametral ball of s? It must not be a corner of it.
  bool encroached_by(std::uint32_t s, VertexId v) const {
    const auto& c = planar_[s].v;
    return dt_.predicates().in_diametral_ball(c[0], c[1], c[2], v) > 0;
  }

  // Marks the subfacet on a face of the tetrahedrization. Queues it if it is missing there (no
  // face) or, with the Gabriel property, encroached.
  void settle(std::uint32_t s, FaceHandle face);

  // An insertion, when the cavity in the tetrahedrization has been filled: begin_insertion(),
  // inherit() for every new tetrahedron, the insertions in planar(), settle_created().
  void begin_insertion() {
    marks_.make_room();
    planar_.forget_created();
  }
  // `created` is `inner` with the new vertex in the place of the one opposite `face`.
  void inherit(TetId created, TetId inner, int face) { marks_.inherit(created, inner, face); }
  // Settles the subfacets that were created, whose faces are among the tetrahedra created last.
  void settle_created();

  void queue(std::uint32_t s) {
    if (planar_[s].alive) queue_.add(s);
  }
  // Takes the first live one out of the queue; kNone if there is none.
  std::uint32_t take_queued();
  bool queue_empty() const { return queue_.empty(); }

  // Drops the dead where they outnumber the living. Not to be called between finding constraints
  // and settling.
  void renumber_if_sparse() {
    if (planar_.sparse()) renumber();
  }

  // Gives memory back; nothing may be asked about tetrahedra afterwards.
  void release_marks() { marks_.release(); }

  // Checks the parts, too. Throws InternalError at the first broken invariant.
  void validate(Control& control);

 private:
  friend struct SubfacetsBreaker;  // of the tests of validate()

  void renumber();
  void validate_in_mesh(std::uint32_t s);

  Tetrahedrization& dt_;
  bool gabriel_;
  FacetTriangulations planar_;
  SubfacetMarks marks_;
  WorkQueue queue_;
};

}  // namespace delmesher::refine
