// The refinement in the plane (section 3): points are inserted until no subsegment is encroached
// and no triangle is bad. One object lives for one call of refine().
//
// The state lies in parts, each with its own invariants; this class inserts points.
//
//   SteinerPoints  where new points go
//   Subsegments    which subsegments are encroached, the queue of those to split
//   Sides          which triangles are inside
//   BadTriangles   the triangles to split, as a Goal judges them
//   Crowding       where there was no room
//
// Invariants between insertions, as long as nothing is crowded:
//  - every encroached subsegment waits in the queue (Subsegments);
//  - once triangles are judged, every bad one that counts waits among the bad ones.
//
// Encroached subsegments are split before bad triangles are. Where there is no room for a point,
// the subsegment or triangle that asked for it no longer waits: the attempt has failed, and goes on
// to find the other crowded places.
#pragma once

#include <vector>

#include "mesher/plane/bad_triangles.h"
#include "mesher/plane/crowding.h"
#include "mesher/plane/goal.h"
#include "mesher/plane/refine.h"
#include "mesher/plane/sides.h"
#include "mesher/plane/steiner_points.h"
#include "mesher/plane/subsegments.h"

namespace delmesher::plane {

class Refiner {
 public:
  Refiner(InputGraph& graph, const Chamfered& chamfered, PointStore& points,
          PlanePredicates& predicates, const RefineOptions& options, Control& control);

  void run();
  // After run(); nothing may be asked afterwards.
  RefinedMesh result();

  // Checks the triangulation and the invariants of all parts and those above. Throws InternalError
  // at the first defect. A few predicates per triangle, which are not counted.
  void validate();

 private:
  friend struct RefinerBreaker;  // of the tests of validate()

  // --- the algorithm, in its order (refine.cpp)
  void begin(RefineStep step) const;
  void triangulate_graph();
  void split_segments();
  void refine_triangles();
  // Until every triangle keeps the bound, or (if `most` is not 0) so many points are in.
  bool refine_to(double degrees, std::uint64_t most);
  void try_for(double degrees);

  // --- insertion (refiner.cpp)
  void drain();  // splits encroached subsegments until none is left
  // False if there is no room.
  bool split_subsegment(EdgeId e);
  void split_triangle(TriangleId t);
  struct Encroached {
    std::vector<Subsegment> upon;
    bool cavity_found = false;  // the cavity of the point is that of mesh_
  };
  Encroached find_encroached(VertexId p, const Triangulation::Sight& sight);
  bool split_all(const std::vector<Subsegment>& subsegments);
  void fill(VertexId p);
  void judge(TriangleId t);
  bool in_cavity(TriangleId t) const;
  void crowd(TriangleId t);

  void validate_bad_triangles();

  InputGraph& graph_;
  const Chamfered& chamfered_;
  PointStore& points_;
  PlanePredicates& predicates_;
  const RefineOptions& options_;
  Control& control_;
  Triangulation mesh_;
  Sides sides_;
  SteinerPoints steiner_;
  Subsegments subsegments_;
  BadTriangles bad_;
  Crowding crowding_;
  Goal goal_;
  bool judging_ = false;  // are triangles judged?
  RefinedMesh result_;    // as far as it is known: counts and the bound
};

}  // namespace delmesher::plane
