// The subsegments of the refinement, which are the edges with a piece, and the queue of those to
// split. The triangulation knows the edges; only the queue is here.
//
// Invariants between insertions:
//  - a subsegment waits if it is encroached: if a triangle beside it that counts (Sides::counts)
//    has its opposite corner in the open disc of which the subsegment is a diameter;
//  - a waiting subsegment may be gone, or encroached no more, and may wait twice: take() asks
//    again.
#pragma once

#include <vector>

#include "mesher/plane/plane_predicates.h"
#include "mesher/plane/sides.h"
#include "mesher/plane/triangulation.h"

namespace delmesher::plane {

struct Subsegment {
  VertexId a, b;
  EdgeId edge;  // where it was: mostly it still is
};

class Subsegments {
 public:
  Subsegments(const Triangulation& mesh, const Sides& sides, PlanePredicates& predicates)
      : mesh_(mesh), sides_(sides), predicates_(predicates) {}

  // The edge of a subsegment, or kNone if it is no more.
  EdgeId find(const Subsegment& s) const;

  // Is p in the open disc of which ab is a diameter, and does the triangle beside ab on the side of
  // p count? p must not be one of the ends.
  bool encroached_by(VertexId p, VertexId a, VertexId b, TriangleId beside) {
    return sides_.counts(beside) && predicates_.dot(a, p, b) < 0;
  }

  // Queues all subsegments that are encroached.
  void queue_all();
  // Queues the subsegments that are encroached by the new triangles: the parts of a subsegment that
  // was split as well, or only those around the cavity, for a point on no subsegment.
  void queue_at_created();
  void queue_around_created();

  // The edge of the next one that is encroached still; kNone if there is none.
  EdgeId take();
  void clear();

  // Throws InternalError unless every encroached subsegment waits. Its predicates do not count.
  void validate();

 private:
  friend struct SubsegmentsBreaker;  // of the tests of validate()

  bool encroached(EdgeId e);
  bool encroached_from(EdgeId e);  // by the corner opposite, in the triangle on the left
  void queue_if_encroached_from(EdgeId e);

  const Triangulation& mesh_;
  const Sides& sides_;
  PlanePredicates& predicates_;
  std::vector<Subsegment> queue_;
  std::size_t head_ = 0;  // those before have been taken
};

}  // namespace delmesher::plane
