// Algorithm 1: a Delaunay tetrahedrization into which points are inserted until no subsegment and
// no subfacet is encroached and no tetrahedron is bad. One object lives for one call of refine().
//
// The state lies in parts, each with its own invariants; this class inserts points and hands the
// state of a cavity on to the tetrahedra that replace it.
//
//   SteinerPoints      where new points go
//   Subsegments        the parts of segments, with the queue of parts to split
//   Subfacets          the planar triangulations of facets, the faces that they are, with the
//                      queue of subfacets to split
//   CavityConstraints  the subsegments and subfacets near a new point
//   Sides              which tetrahedra are inside
//   BadTetrahedra      the tetrahedra to split, as a Goal judges them
//
// Invariants that link them:
//  - a subsegment has one subfacet beside it in each facet of its segment. It names its edge in
//    that subfacet, and the subfacet names the subsegment at that edge;
//  - once tetrahedra are judged, every bad one waits, at its level or to be judged, unless it is
//    known to be outside, where the goal need not be reached;
//  - queued elements are split before a bad tetrahedron is, so that every subfacet is a face when a
//    side is needed.
#pragma once

#include "mesher/refine/bad_tetrahedra.h"
#include "mesher/refine/cavity_constraints.h"
#include "mesher/refine/goal.h"
#include "mesher/refine/refine.h"
#include "mesher/refine/segment_facets.h"
#include "mesher/refine/sides.h"
#include "mesher/refine/steiner_points.h"
#include "mesher/refine/subfacets.h"
#include "mesher/refine/subsegments.h"

namespace delmesher::refine {

class Refiner {
 public:
  Refiner(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
          Predicates& predicates, const RefineOptions& options, Control& control);

  void run();
  // After run(); nothing may be asked afterwards.
  RefineResult result();

  // Checks the tetrahedrization, the invariants of all parts and those that link them. Requires
  // empty queues. Throws InternalError at the first defect. Costs a few predicates per element,
  // which are not counted.
  void validate();

 private:
  friend struct RefinerBreaker;  // of the tests of validate()

  // --- algorithm 1, in its order (refine.cpp)
  void begin(RefineStep step) const;
  void triangulate_vertices();
  void recover_segments();
  void recover_facets();
  void refine_tetrahedra();
  // Splits bad tetrahedra until there are none. Returns false, with some left, as soon as the store
  // has more than `cap` points.
  bool reach(const Goal& goal, std::size_t cap);
  // 0 if it is not to be split.
  std::uint8_t badness(TetId t) const;

  // --- insertion (refiner.cpp)
  void drain();  // splits queued subsegments, then subfacets, until none is left
  void split_subsegment(std::uint32_t s);
  void split_subfacet(std::uint32_t s);
  void split_tetrahedron(TetId t);
  bool try_volume_point(TetId t, VertexId v);
  // Finds the cavity of v and the constraints in and on it. find_free_cavity() gives up when it
  // meets a subsegment that v encroaches or, with `spare_subfacets`, a subfacet that v encroaches
  // or would destroy: it queues these and returns false.
  void find_cavity(VertexId v, TetId start);
  bool find_free_cavity(VertexId v, TetId start, bool spare_subfacets);
  void commit(VertexId v);
  void after_insertion();
  TetId created_with(VertexId v) const;
  void check_room(VertexId duplicate, VertexId a, VertexId b) const;

  void validate_links() const;
  void validate_goal() const;

  const Plc& plc_;
  const SurfaceTopology& topology_;
  PointStore& points_;
  Predicates& predicates_;
  const RefineOptions& options_;
  Control& control_;
  Tetrahedrization dt_;
  SegmentFacets segment_facets_;
  SteinerPoints steiner_;
  Subsegments subsegments_;
  Subfacets subfacets_;
  CavityConstraints constraints_;
  Sides sides_;
  BadTetrahedra bad_;
  Goal goal_;
  bool refining_ = false;  // are tetrahedra judged?
  RefineResult result_;    // as far as it is known: the points and their counts
};

}  // namespace delmesher::refine
