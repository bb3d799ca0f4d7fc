// The subsegments that are to be recovered: a queue of those that may not be edges of the
// tetrahedrization, and the lookup of all by their ends.
//
// Invariant at any time: only subsegments are in the queue. A subsegment may be in it although it
// is an edge, and may be in it twice.
// Invariants between two steps (a step splits a subsegment and inserts the point):
//  - every subsegment that is not an edge of the tetrahedrization is in the queue;
//  - if find_all() has found a missing one, every subsegment is found by its ends; subsegments that
//    have been split are still found, too.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "mesher/base/flat_map.h"
#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

class MissingSubsegments {
 public:
  MissingSubsegments(Tetrahedrization& mesh, const Chains& chains) : mesh_(mesh), chains_(chains) {}

  // Queues all missing subsegments of the chains, in their order.
  void find_all(Control& control);

  bool empty() const { return queue_.empty(); }
  // Takes the first one out of the queue, which must not be empty: the node that names it.
  std::uint32_t take();

  // When a vertex has been put between two subsegments that were one, and into the
  // tetrahedrization: queues both of them, and all others that the insertion has destroyed.
  void follow_split(std::uint32_t first, std::uint32_t second);

  // Throws InternalError at the first broken invariant. Looks every subsegment up in the mesh.
  void validate() const;

 private:
  friend struct MissingSubsegmentsBreaker;  // of the tests of validate()

  void remember(std::uint32_t n);
  // The subsegment that has, or has had, these ends; or kNone.
  std::uint32_t find(VertexId a, VertexId b) const {
    if (chains_.valence(a) == 0 || chains_.valence(b) == 0) return kNone;
    return by_ends_.get(pair_key(a, b), kNone);
  }
  void queue_destroyed(VertexId v);

  Tetrahedrization& mesh_;
  const Chains& chains_;
  FlatMap by_ends_;                  // end vertices -> node; empty as long as none was missing
  std::deque<std::uint32_t> queue_;  // nodes
  std::vector<std::uint64_t> kept_;  // of queue_destroyed()
};

}  // namespace delmesher::cdt
