// The subsegments of a refinement: the parts into which the segments of the complex are split
// (section 5.2). A subsegment never dies: when it is split, its first part keeps its number.
//
// Invariants at any time:
//  - the subsegments of a segment follow each other from its first vertex to its second;
//  - a subsegment is found by its ends, and nothing else is found;
//  - only subsegments are in the queue.
// Invariants between insertions, for a subsegment that is not in the queue:
//  - it is an edge of the tetrahedrization, and every tetrahedron having that edge has the edge's
//    bit in its note (Note::edges), which may also have bits of edges that are not subsegments any
//    more;
//  - with the Gabriel property, its open diametral ball is empty.
// FacetTriangulations links the sides of a subsegment; Refiner::validate() checks them.
#pragma once

#include <vector>

#include "mesher/base/flat_map.h"
#include "mesher/refine/notes.h"
#include "mesher/refine/subfacet_edge.h"
#include "mesher/refine/work_queue.h"
#include "mesher/surface/plc.h"

namespace delmesher::refine {

class Subsegments {
 public:
  struct Subsegment {
    VertexId a, b;          // in the direction of the complex's segment
    std::uint32_t segment;  // of the complex
    std::uint32_t next;     // following subsegment of the same segment
    SubfacetEdge side[2];   // the same edge in the subfacets beside it
  };

  // One per segment of the complex, with the same numbers. `gabriel`: is the Gabriel property asked
  // for?
  Subsegments(const Plc& plc, Tetrahedrization& dt, bool gabriel);

  std::uint32_t size() const { return static_cast<std::uint32_t>(list_.size()); }
  const Subsegment& operator[](std::uint32_t s) const { return list_[s]; }
  // The subsegment ab, or kNone.
  std::uint32_t find(VertexId a, VertexId b) const { return by_ends_.get(pair_key(a, b), kNone); }
  // The vertices of a segment's subsegments, from end to end.
  std::vector<VertexId> chain(std::uint32_t segment) const;

  // visit(s) for each subsegment that is an edge of t.
  template <class Visit>
  void for_each_on(TetId t, Visit&& visit) const {
    const std::uint8_t edges = note(dt_, t, Note::edges);
    if (edges == 0) return;
    for (int e = 0; e < 6; ++e) {
      if ((edges >> e & 1) == 0) continue;
      const std::uint32_t s = find(dt_.vertex(t, kEdge[e][0]), dt_.vertex(t, kEdge[e][1]));
      if (s != kNone) visit(s);
    }
  }

  // Is v strictly inside the diametral ball of s? It must not be an end of it.
  bool encroached_by(std::uint32_t s, VertexId v) const {
    return dt_.predicates().dot_sign(list_[s].a, v, list_[s].b) < 0;
  }

  // Ends s at v; returns the subsegment from v on, which has no sides yet.
  std::uint32_t split(std::uint32_t s, VertexId v);
  // Marks the subsegment in the tetrahedrization, where t has its edge. Queues it if it is missing
  // there (t is kNone) or, with the Gabriel property, encroached.
  void settle(std::uint32_t s, TetId t);
  // `created` is `inner` with the new vertex in the place of the one opposite `face`.
  void inherit(TetId created, TetId inner, int face) {
    note(dt_, created, Note::edges) = note(dt_, inner, Note::edges) & kEdgesWithout[face];
  }

  void queue(std::uint32_t s) { queue_.add(s); }
  // Takes the first one out of the queue; kNone if it is empty.
  std::uint32_t take_queued() { return queue_.take(); }
  bool queue_empty() const { return queue_.empty(); }

  void attach(std::uint32_t s, SubfacetEdge side);
  void replace_side(std::uint32_t s, SubfacetEdge from, SubfacetEdge to);
  // Every side becomes renumbered(side).
  template <class Renumber>
  void renumber_sides(Renumber&& renumbered) {
    for (Subsegment& s : list_) {
      for (SubfacetEdge& side : s.side) side = renumbered(side);
    }
  }

  // Gives memory back; nothing may be found by its ends afterwards.
  void release_lookup() { by_ends_ = {}; }

  // Throws InternalError at the first broken invariant.
  void validate(Control& control);

 private:
  friend struct SubsegmentsBreaker;  // of the tests of validate()

  // Edges (bits of kEdge) that do not use vertex i.
  static constexpr std::uint8_t kEdgesWithout[4] = {0b111000, 0b100110, 0b010101, 0b001011};

  std::uint32_t add(VertexId a, VertexId b, std::uint32_t segment);
  void mark(std::uint32_t s, TetId having_edge);
  bool encroached(std::uint32_t s, TetId having_edge);
  void validate_chains() const;
  void validate_in_mesh(std::uint32_t s);

  const Plc& plc_;
  Tetrahedrization& dt_;
  bool gabriel_;
  std::vector<Subsegment> list_;
  FlatMap by_ends_;
  WorkQueue queue_;
  std::vector<TetId> ring_;  // scratch
};

}  // namespace delmesher::refine
