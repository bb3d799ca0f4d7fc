// Where a missing subsegment is split, given the point that keeps it from being an edge (Si and
// Gaertner 2005; Diazzi et al. 2023, section 4).
//
// Laws: around an acute vertex, parts of different edges end on common spheres, so that they do not
// split each other for ever. Points of edges that run along each other face each other. A target is
// only aimed at, in doubles or, at very small angles, in dyadic numbers of twice as many bits. The
// splitter decides by an exact predicate whether the point lies on its subsegment.
#pragma once

#include <cstdint>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/cdt/subsegment_splitter.h"

namespace delmesher::cdt {

// Which ends of the original edge are acute. The split points of a subsegment lie on common spheres
// around the acute end; if both are acute, the edge is first split in the middle.
enum class Centre : std::uint8_t { end0 = 0, end1 = 1, none = 2, both = 3 };

class SplitRule {
 public:
  SplitRule(const Chains& chains, const PointStore& points) : chains_(chains), points_(points) {}

  // For the subsegment of node n. With Centre::both, or without a reference (kNone), in the middle.
  // Throws Stopped where points on the edge cannot be placed as finely as its surroundings
  // require.
  SplitTarget target(std::uint32_t n, Centre centre, VertexId reference);

 private:
  bool target_opposite(const ChainNode& u, const ChainNode& w, VertexId reference, SplitTarget& t,
                       bool& soon) const;
  bool runs_along(std::uint32_t edge, VertexId v, double sine) const;
  double sine_between(std::uint32_t e, std::uint32_t f) const;
  SplitTarget on_sphere(const ChainNode& u, const ChainNode& w, int centre, VertexId reference,
                        const SplitTarget& middle);
  double distance_from_apex(VertexId apex, VertexId v) const;
  void sharpen(SplitTarget& target, std::uint32_t edge, VertexId reference);
  Dyadic product(VertexId a, VertexId v, VertexId b) const;
  Dyadic squared_distance(VertexId a, VertexId b) const { return product(a, b, b); }

  const Chains& chains_;
  const PointStore& points_;
  // How many calls had a reference so near to the edge that no parameter matches its distance from
  // the apex. Never reset: a recovery without end goes round many subsegments.
  std::uint32_t hopeless_ = 0;
};

}  // namespace delmesher::cdt
