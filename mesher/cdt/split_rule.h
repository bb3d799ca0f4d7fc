// Where a missing subsegment is split, given the point that keeps it from being an edge (Si and
// Gaertner 2005; Diazzi et al. 2023, section 4).
//
// Laws. Around an acute vertex, parts of different edges end on common spheres, so that they do not
// split each other for ever. Points of edges that run along each other face each other. Everything
// is steered by doubles, which only costs points: the splitter decides which points lie on a
// subsegment.
#pragma once

#include <cstdint>

#include "mesher/arithmetic/dyadic.h"
#include "mesher/cdt/subsegment_splitter.h"

namespace delmesher::cdt {

// The end of the original edge around which a subsegment's splits lie on common spheres.
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
  // References, in all calls, that no point on the edge can be matched with. Never reset: splitting
  // without end takes turns among many subsegments.
  std::uint32_t hopeless_ = 0;
};

}  // namespace delmesher::cdt
