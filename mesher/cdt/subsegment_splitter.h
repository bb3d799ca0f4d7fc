// Where a subsegment is split, and the point that does it.
#pragma once

#include <array>
#include <cstdint>

#include "mesher/cdt/chains.h"

namespace delmesher::cdt {

// Where to split an edge.
struct SplitTarget {
  std::array<double, 2> from;  // fraction of the edge from end 0 and from end 1
  int anchor;                  // 0 or 1: the end whose fraction counts
  double tolerance;            // the fraction may be off by this, for a short parameter
  // Added to the fraction where 53 bits are not enough; the tolerance is 0 then.
  double low = 0;
};

// Fraction of the edge between two nodes of its chain, a before b, from the end where it is more
// accurate.
double fraction_between(const ChainNode& a, const ChainNode& b);

// The point at fraction `step` of the edge behind node a, before b.
SplitTarget target_behind(const ChainNode& a, const ChainNode& b, double step);
SplitTarget target_in_the_middle(const ChainNode& a, const ChainNode& b);

// Something is nearer to the edge than points on it can be placed: throws Stopped.
[[noreturn]] void stop_beside(const Chains& chains, std::uint32_t edge);

// Adds points to subsegments. Law: each new point lies strictly between the vertices of the
// subsegment that it splits, by an exact predicate; its supports are the edge and the planes of the
// facets on both sides.
class SubsegmentSplitter {
 public:
  SubsegmentSplitter(Chains& chains, PointStore& points, Predicates& predicates)
      : chains_(chains), points_(points), predicates_(predicates) {}

  // Adds the point and its node; falls back to the middle if the target cannot be met strictly
  // between the neighbours. Returns the new node.
  std::uint32_t split(std::uint32_t node, const SplitTarget& target);

 private:
  VertexId add(std::uint32_t edge, const SplitTarget& t);
  std::array<double, 2> fractions(VertexId v, const SplitTarget& t) const;

  Chains& chains_;
  PointStore& points_;
  Predicates& predicates_;
};

}  // namespace delmesher::cdt
