// The state of a refinement: the Delaunay tetrahedrization, the subsegments and subfacets in it,
// and the queues. One object lives for one call of refine(); its parts are implemented in one
// source file per step.
//
// Invariants between insertions, for elements that wait in no queue:
//  - a live subsegment is an edge of the tetrahedrization, and every tetrahedron having that edge
//    carries the edge's bit;
//  - a live subfacet is a face, and both its tetrahedra (a ghost on the hull) carry its id;
//  - with options.gabriel, the open diametral balls of both are empty;
//  - the live subfacets of a facet are the planar Delaunay triangulation of its vertices, bounded
//  by its subsegments.
#pragma once

#include <deque>

#include "mesher/base/flat_map.h"
#include "mesher/base/growing_array.h"
#include "mesher/delaunay/planar.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/refine/bad_tetrahedra.h"
#include "mesher/refine/notes.h"
#include "mesher/refine/refine.h"
#include "mesher/refine/segment_facets.h"
#include "mesher/refine/steiner_points.h"
#include "mesher/surface/bvh.h"

namespace delmesher {

class Refiner {
 public:
  Refiner(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
          Predicates& predicates, const RefineOptions& options, Control& control);

  void run();
  RefineResult result();

  // Checks the tetrahedrization, the invariants above, and what links the elements: chains of
  // subsegments, neighbours of subfacets, queues. Throws InternalError at the first defect. Costs a
  // few predicates per element, which are not counted.
  void validate();

 private:
  friend struct RefinerBreaker;  // of the tests of validate()

  struct Subsegment {
    VertexId a, b;          // in the direction of the complex's segment
    std::uint32_t segment;  // of the complex
    std::uint32_t next;     // following subsegment of the same segment
    std::uint32_t side[2];  // subfacets beyond it, as 3 * subfacet + edge, or kNone
    bool alive = true;
    bool queued = false;
  };
  struct Subfacet {
    std::array<VertexId, 3> v;  // counter-clockwise seen from outside
    std::array<std::uint32_t, 3>
        neighbor;  // across the edge opposite v[i]: 3 * subfacet + edge, or kNone
    std::array<std::uint32_t, 3> subsegment;  // on that edge, or kNone
    std::uint32_t facet;                      // of the complex
    bool alive = true;
    bool queued = false;
  };
  void begin(RefineStep step) const;

  // segments.cpp
  void recover_segments();
  void split_subsegment(std::uint32_t s);
  bool subsegment_encroached(std::uint32_t s, TetId having_edge);
  void check_subsegment(std::uint32_t s, TetId t);
  TetId created_with(VertexId v) const;
  std::uint32_t find_subsegment(VertexId a, VertexId b) const;
  std::uint32_t new_subsegment(VertexId a, VertexId b, std::uint32_t segment);
  void mark_edge(std::uint32_t s, TetId having_edge);

  // facets.cpp
  void build_facets();
  void build_facet(std::uint32_t f);
  void recover_facets();
  void split_subfacet(std::uint32_t s);
  // The subfacet of the facet that contains v, walking from `start`; if a subsegment is in the way,
  // kNone and that subsegment.
  std::uint32_t locate_subfacet(VertexId v, std::uint32_t start, std::uint32_t* blocked);
  bool in_circle(const Subfacet& f, VertexId v);
  int orient(std::uint32_t facet, VertexId a, VertexId b, VertexId c);
  // Replaces the planar cavity of v, starting at subfacet `start`, by new subfacets. `split` is the
  // edge (3 * subfacet + edge) of `start` on which v lies, or kNone.
  void insert_in_facet(VertexId v, std::uint32_t start, std::uint32_t split, std::uint32_t half_a,
                       std::uint32_t half_b);
  std::uint32_t new_subfacet(const std::array<VertexId, 3>& v, std::uint32_t facet);
  void compact_subfacets();
  void check_subfacet(std::uint32_t s, std::uint32_t face);
  void make_apex(std::uint32_t f);

  // volume.cpp
  void refine_tetrahedra();
  // Splits bad tetrahedra until there are none, or the store has `cap` points; then false.
  bool reach(const Goal& goal, std::size_t cap);
  // 0 if it is not to be split.
  std::uint8_t badness(TetId t) const;
  void split_tetrahedron(TetId t);
  bool try_volume_point(TetId t, VertexId v);

  // sides.cpp
  bool near_removed(TetId t) const;
  static std::uint8_t classify_exactly(Solid& solid, const VertexId* v);
  void classify_near_removed();
  std::uint8_t side_through(TetId t, int i) const;
  std::uint8_t side_of(TetId start);

  // validate.cpp
  void validate_queues() const;
  void validate_chains() const;
  void validate_subsegment(std::uint32_t s);
  void validate_subfacet(std::uint32_t s);
  void validate_in_facet(std::uint32_t s);

  // insertion.cpp
  void drain();  // splits queued subsegments, then subfacets, until none is left
  void queue_subsegment(std::uint32_t s);
  void queue_subfacet(std::uint32_t s);
  void begin_constraints();
  // The subfacet on face i of a tetrahedron, or kNone.
  std::uint32_t subfacet_on(TetId t, int i) const {
    return (note(t, kFaces) >> i & 1) != 0 ? subfacet_[t][i] : kNone;
  }
  void collect_constraints_of(TetId t);
  // Find the cavity of v and the constraints in and on it; the second gives up, queues and returns
  // false at the first subsegment (and subfacet, if these are to be spared) in the way.
  void find_cavity(VertexId v, TetId start);
  bool find_free_cavity(VertexId v, TetId start, bool spare_subfacets);
  // Of the constraints found, from the given place on.
  bool queue_encroached_subsegments(VertexId v, std::size_t first = 0);
  bool queue_encroached_subfacets(VertexId v, std::size_t first = 0);
  bool queue_lost_subfacets(TetId t);
  void commit(VertexId v);
  void requeue_lost();
  // Finds the new subfacets among the new tetrahedra, requeues what was lost, judges the new
  // tetrahedra.
  void after_insertion();

  const Plc& plc_;
  const SurfaceTopology& topology_;
  PointStore& points_;
  Predicates& predicates_;
  const RefineOptions& options_;
  Control& control_;
  Tetrahedrization dt_;
  Solid solid_;
  Bvh removed_;
  SegmentFacets segment_facets_;
  SteinerPoints steiner_;
  BadTetrahedra bad_;
  Goal goal_;

  std::vector<Subsegment> subsegments_;
  std::vector<std::uint32_t> first_subsegment_;  // per segment of the complex
  FlatMap edge_map_;                             // of live subsegments, by their ends
  GrowingArray<Subfacet> subfacets_;
  std::size_t dead_subfacets_ = 0;
  std::vector<FacetPlane> planes_;               // per facet
  std::vector<std::vector<VertexId>> on_facet_;  // per facet: Steiner points inside it
  std::vector<VertexId> in_volume_;
  std::vector<std::array<VertexId, 4>> ball_;  // of each of them
  std::uint64_t on_segments_ = 0, on_facets_ = 0;

  // Per tetrahedron.
  enum : std::uint8_t { kUnknown, kOutside, kInside, kStraddling, kAsked };
  static constexpr Note kEdges = Note::edges, kFaces = Note::faces, kSide = Note::side;
  std::uint8_t& note(TetId t, Note kind) { return delmesher::note(dt_, t, kind); }
  std::uint8_t note(TetId t, Note kind) const { return delmesher::note(dt_, t, kind); }
  GrowingArray<std::array<std::uint32_t, 4>> subfacet_;

  std::deque<std::uint32_t> subsegment_queue_, subfacet_queue_;
  bool facets_built_ = false;
  bool refining_ = false;

  // Scratch of one insertion.
  struct FoundSubfacet {
    std::uint32_t id;
    bool internal;  // both its tetrahedra are in the cavity
  };
  std::vector<FoundSubfacet> found_subfacets_;
  std::vector<std::uint32_t> found_subsegments_;
  std::vector<std::uint32_t> new_subfacets_;
  std::vector<std::uint32_t> subfacet_stamp_, subsegment_stamp_;
  std::uint32_t stamp_ = 0;
  std::vector<TetId> ring_;
};

}  // namespace delmesher
