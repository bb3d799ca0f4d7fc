// The subsegments and subfacets in and on the cavity of a new point. With the Gabriel property the
// point can encroach upon no others, because an empty diametral ball of an edge or face is covered
// by the circumballs of the tetrahedra around it. Without that property a ball may not be covered,
// but there a constraint must only be an edge or a face, and the point can destroy no others.
//
// Law: after begin(), each element of the tetrahedra collected is listed once.
#pragma once

#include <vector>

#include "mesher/refine/subfacets.h"
#include "mesher/refine/subsegments.h"

namespace delmesher::refine {

class CavityConstraints {
 public:
  CavityConstraints(Tetrahedrization& dt, Subsegments& subsegments, Subfacets& subfacets)
      : dt_(dt), subsegments_(subsegments), subfacets_(subfacets) {}

  void begin();
  void collect(TetId t);

  // The lengths of the lists. Entries behind an earlier length have been collected since.
  struct Count {
    std::size_t subsegments = 0, subfacets = 0;
  };
  Count count() const { return {found_subsegments_.size(), found_subfacets_.size()}; }

  // Queue the constraints from `first` on that v encroaches. True if there are any.
  bool queue_encroached_subsegments(VertexId v, Count first, std::uint32_t except = kNone);
  bool queue_encroached_subfacets(VertexId v, Count first);
  // Queues the subfacets of t that the insertion would destroy: both their tetrahedra are in the
  // cavity. This happens without the Gabriel property, when a subfacet lies between the new point
  // and the tetrahedron that the point was made for. If t is a ghost, all its subfacets are queued:
  // they are on a side of the box, and rounding has put the point beyond it. True if any is queued.
  bool queue_lost_subfacets(TetId t);

  // When the cavity has been filled: queues the elements that are in the tetrahedrization no more.
  void requeue_lost();

 private:
  struct FoundSubfacet {
    std::uint32_t id;
    bool internal;  // both its tetrahedra are in the cavity
  };

  Tetrahedrization& dt_;
  Subsegments& subsegments_;
  Subfacets& subfacets_;
  std::vector<std::uint32_t> found_subsegments_;
  std::vector<FoundSubfacet> found_subfacets_;
  std::vector<std::uint32_t> subsegment_mark_, subfacet_mark_;
  std::uint32_t epoch_ = 0;
};

}  // namespace delmesher::refine
