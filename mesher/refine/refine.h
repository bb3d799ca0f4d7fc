// Delaunay refinement of a piecewise linear complex (section 5, algorithm 1).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/validating.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/geometry/box_tree.h"
#include "mesher/geometry/local_frame.h"
#include "mesher/geometry/size_field.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/plc.h"
#include "mesher/surface/solid.h"
#include "mesher/surface/topology.h"

namespace delmesher::refine {

// The largest bound on face angles that is guaranteed, in degrees: asin(1/4), which is a
// radius-edge ratio of 2. The proof of termination needs a ratio above that (section 5.4). A larger
// bound is best effort. The 20.7 degrees of the paper are the bound in the plane.
inline constexpr double kGuaranteedDelta = 14.4775;

// The steps of algorithm 1, in its order.
enum class RefineStep : std::uint8_t {
  delaunay,    // Delaunay tetrahedrization of the complex's vertices
  segments,    // until every subsegment is an edge of it
  facets,      // until every subfacet is a face of it
  tetrahedra,  // until none is bad
};

struct RefineOptions {
  double delta = 14.47;  // degrees
  bool slivers = true;
  double max_edge = 0;               // 0: no bound
  const SizeField* sizes = nullptr;  // of edges; null or empty: no bound
  // Split the bad tetrahedron with the largest radius-edge ratio first (section 5.4); otherwise by
  // levels of badness.
  bool largest_ratio_first = false;
  // Split at the circumcentre (section 5.6); otherwise at an off-centre where there is one.
  bool circumcentres = false;
  Region region = Region::interior;  // where bad tetrahedra are split
  // Guard, a length in units of the input; 0: none. The features of the complex are a few hundred
  // times as long. A subsegment or volume edge below it means that acute corners split each other
  // for ever, and the refinement stops.
  double runaway_length = 0;
  // Split subsegments and subfacets until their open diametral balls are empty. Otherwise the ones
  // that the tetrahedrization has are split only when a volume point encroaches them.
  bool gabriel = true;
  // Per input vertex: 1 for an apex, where segments meet at an acute angle. They are split at equal
  // distances from it, on concentric shells, and so do not encroach each other. Empty: no apex.
  std::vector<std::uint8_t> apex;
  // Boxes that cover the part of the input surface that was cut off or dropped.
  std::vector<Box> removed;
  std::function<void(RefineStep)> on_step;  // called when a step begins, unless empty
  bool want_balls = false;                  // fill RefineResult::ball
  bool validate = kValidating;  // check the invariants after each step (Refiner::validate)
};

struct RefinedFace {
  std::array<VertexId, 3> vertices;  // counter-clockwise seen from outside
  std::uint32_t facet;               // of the complex
};

struct RefineResult {
  bool runaway = false;  // the guard stopped the refinement; everything else is then empty
  std::vector<std::array<VertexId, 4>> tetrahedra;  // all of them down to the outer box
  std::vector<Side> side;                           // per tetrahedron
  // Per tetrahedron, a bit for each face: bits 0 to 3 if a tetrahedron before it has that face too,
  // bits 4 to 7 if both are also inside, or neither is.
  std::vector<std::uint8_t> repeated_faces;
  std::unique_ptr<Tetrahedrization> delaunay;  // the tetrahedra once more, with their neighbours
  std::vector<RefinedFace> faces;
  std::vector<std::vector<VertexId>> chain;     // per segment of the complex, end to end
  std::vector<std::vector<VertexId>> on_facet;  // per facet: points inserted inside it
  std::vector<VertexId> in_volume;
  // Per point in the volume: the tetrahedron in whose circumball it was put (section 5.6); empty
  // unless asked for.
  std::vector<std::array<VertexId, 4>> ball;
  std::uint64_t on_segments = 0, on_facets = 0;
  bool capped = false;  // slivers, or angles above kGuaranteedDelta, were given up at the cap
};

// Appends the outer box (section 5.1) to the complex: six rectangles around all input points.
void add_outer_box(const SurfaceTopology& topology, PointStore& points, Plc& plc,
                   const LocalFrame& frame = {});

// Refines the complex, which must include the outer box. Appends Steiner points to the store.
// Terminates if the complex satisfies the projection condition and delta is at most
// kGuaranteedDelta; otherwise the limits of `control` end it.
RefineResult refine(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
                    Predicates& predicates, const RefineOptions& options, Control& control);

}  // namespace delmesher::refine
