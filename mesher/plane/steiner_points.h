// Where new points of the refinement go: in the middle of subsegments, near the circumcentres of
// bad triangles, and back to where chamfering took a corner away. Points are added to the store.
// With `circumcentres` a bad triangle gets its circumcentre, as the paper says (section 3), but
// where doubles cannot decide that; otherwise an off-centre or a chamfered corner.
//
// Laws:
//  - a point of a piece is exactly on its line and strictly inside the subsegment; a point of a
//    side of the box has that side's coordinate;
//  - the carrier of a point is the piece that it was put on, by chamfering or here; kNone of all
//    others;
//  - there is no point where doubles leave no room for it.
#pragma once

#include <array>
#include <vector>

#include "mesher/plane/chamfer.h"
#include "mesher/plane/goal.h"
#include "mesher/plane/plane_predicates.h"
#include "mesher/plane/shape.h"
#include "mesher/plane/triangulation.h"

namespace delmesher::plane {

class SteinerPoints {
 public:
  SteinerPoints(const InputGraph& graph, const Chamfered& chamfered, const Triangulation& mesh,
                PointStore& points, PlanePredicates& predicates, bool circumcentres = false);

  // On a subsegment; kNone if there is no room.
  VertexId on_subsegment(EdgeId e);

  // A point that would make a bad triangle go. Either new, and the last of the store until it is
  // taken back, or a chamfered corner.
  struct Candidate {
    VertexId vertex = kNone;  // kNone: no room
    bool restored = false;
  };
  Candidate in_triangle(const std::array<VertexId, 3>& v, const Goal& goal);
  void take_back(const Candidate& candidate) {
    if (!candidate.restored) points_.pop_back();
  }

  // Per vertex id, as far as there are any.
  const std::vector<PieceId>& carrier() const { return carrier_; }

 private:
  void carry(VertexId v, PieceId piece);
  Candidate at(const Vec3& place);
  VertexId corner_near(const std::array<VertexId, 3>& v, const Vec3& place, const Shape& shape);

  const InputGraph& graph_;
  const Triangulation& mesh_;
  PointStore& points_;
  PlanePredicates& predicates_;
  bool circumcentres_;
  std::vector<VertexId> corner_of_;  // of cut points, by id; kNone of others
  std::vector<PieceId> carrier_;
};

}  // namespace delmesher::plane
