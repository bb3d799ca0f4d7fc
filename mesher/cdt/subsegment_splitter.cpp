#include "mesher/cdt/subsegment_splitter.h"

#include <algorithm>
#include <string>

#include "mesher/base/check.h"
#include "mesher/geometry/placement.h"

namespace delmesher::cdt {
namespace {

// Relative to the shorter part of a split: how far a point may be from its target so that its
// parameter is short.
constexpr double kPlacementTolerance = 0x1p-20;

}  // namespace

double fraction_between(const ChainNode& a, const ChainNode& b) {
  return b.from[0] <= a.from[1] ? b.from[0] - a.from[0] : a.from[1] - b.from[1];
}

SplitTarget target_behind(const ChainNode& a, const ChainNode& b, double step) {
  const double rest = fraction_between(a, b) - step;
  SplitTarget t;
  // Each fraction from the nearer neighbour: exact cancellation is not to be expected.
  t.from[0] = step <= rest ? a.from[0] + step : b.from[0] - rest;
  t.from[1] = step <= rest ? a.from[1] - step : b.from[1] + rest;
  t.anchor = t.from[0] <= t.from[1] ? 0 : 1;
  t.tolerance = kPlacementTolerance * std::min(step, rest);
  return t;
}

SplitTarget target_in_the_middle(const ChainNode& a, const ChainNode& b) {
  return target_behind(a, b, fraction_between(a, b) / 2);
}

void stop_beside(const Chains& chains, std::uint32_t edge) {
  const std::array<VertexId, 2> end = chains.topology().edge_vertices(edge);
  stop_at_precision("edge " + std::to_string(end[0]) + "-" + std::to_string(end[1]));
}

std::uint32_t SubsegmentSplitter::split(std::uint32_t node, const SplitTarget& target) {
  const ChainNode a = chains_.node(node), b = chains_.next(node);
  const double width = fraction_between(a, b);
  std::array<SplitTarget, 3> tries = {target, target_in_the_middle(a, b),
                                      target_in_the_middle(a, b)};
  tries[2].tolerance = 0;
  for (const SplitTarget& t : tries) {
    const VertexId v = add(a.edge, t);
    if (predicates_.dot_sign(a.vertex, v, b.vertex) < 0) {
      return chains_.insert_after(node, v, fractions(v, t));
    }
    points_.pop_back();
  }
  // Parts of an edge become that short beside something nearer than doubles can say where.
  const double place = std::max(std::min(a.from[0], a.from[1]), std::min(b.from[0], b.from[1]));
  DELMESHER_CHECK(width <= 0x1p-50 * place,
                  "no point is strictly inside a subsegment that is not too short for doubles");
  stop_beside(chains_, a.edge);
}

VertexId SubsegmentSplitter::add(std::uint32_t edge, const SplitTarget& t) {
  const SurfaceTopology& s = chains_.topology();
  const std::array<VertexId, 2> end = s.edge_vertices(edge);
  const double f = t.from[t.anchor];
  const double u = shortest_dyadic(f - t.tolerance, f + t.tolerance);
  const VertexId p = end[1 - t.anchor], q = end[t.anchor];
  // q + u (p - q) + low (p - q): a point of a triangle with two equal corners has two parameters.
  const VertexId v =
      t.low == 0 ? points_.add_on_segment(p, q, u) : points_.add_on_triangle(p, p, q, u, t.low);
  points_.set_supports(v, s.edge_planes(edge), {&edge, 1});
  return v;
}

std::array<double, 2> SubsegmentSplitter::fractions(VertexId v, const SplitTarget& t) const {
  const double u = points_.definition(v).u;
  return t.anchor == 0 ? std::array<double, 2>{u, 1 - u} : std::array<double, 2>{1 - u, u};
}

}  // namespace delmesher::cdt
