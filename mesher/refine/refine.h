// Delaunay refinement of a piecewise linear complex (section 5, algorithm 1).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/validating.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/bvh.h"
#include "mesher/surface/plc.h"
#include "mesher/surface/solid.h"
#include "mesher/surface/topology.h"

namespace delmesher::refine {

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
  Region region = Region::interior;  // where bad tetrahedra are split
  // No edge of the complex's features is shorter than a few hundred of these (absolute): a
  // subsegment or volume edge below it means that acute corners feed each other for ever. 0: no
  // guard.
  double runaway_length = 0;
  // Split subsegments and subfacets until their open diametral balls are empty. Otherwise one that
  // is in the tetrahedrization is left alone until a volume point encroaches it.
  bool gabriel = true;
  // Per input vertex: 1 if segments meet there at an acute angle; they are split at equal distances
  // from it (on concentric shells), so that they do not encroach each other. Empty: none.
  std::vector<std::uint8_t> apex;
  // Boxes that cover the part of the input surface that the complex lacks.
  std::vector<Box> removed;
  std::function<void(RefineStep)> on_step;  // told when a step begins; empty: nobody asks
  bool want_balls = false;                  // fill RefineResult::ball
  bool validate = kValidating;  // check the invariants after each step (Refiner::validate)
};

struct RefinedFace {
  std::array<VertexId, 3> vertices;  // counter-clockwise seen from outside
  std::uint32_t facet;               // of the complex
};

struct RefineResult {
  // Where the guard stopped the refinement; everything else is then empty.
  std::optional<Vec3> runaway;
  std::vector<std::array<VertexId, 4>> tetrahedra;  // all of them down to the outer box
  std::vector<Side> side;                           // per tetrahedron
  // Per tetrahedron: which faces earlier ones have too (bits 0 to 3), and which of these are inside
  // or not alike (bits 4 to 7).
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
};

// Appends the outer box (section 5.1) to the complex: six rectangles around all input points.
void add_outer_box(const SurfaceTopology& topology, PointStore& points, Plc& plc);

// Refines the complex, which must include the outer box. Ends for complexes satisfying the
// projection condition and delta below 14.48 degrees; the control's limits hold otherwise. Appends
// Steiner points to the store.
RefineResult refine(const Plc& plc, const SurfaceTopology& topology, PointStore& points,
                    Predicates& predicates, const RefineOptions& options, Control& control);

}  // namespace delmesher::refine
