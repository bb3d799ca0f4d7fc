// Constrained Delaunay tetrahedrization of a valid surface or complex, possibly enriched with
// further points on and off it (section 6; Diazzi et al. 2023; Si and Gaertner 2011; Shewchuk
// 2000).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/base/validating.h"
#include "mesher/delaunay/tetrahedrization.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/topology.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::cdt {

// The steps, in their order. They begin anew if facet recovery fails (CdtCounters::facet_restarts).
enum class CdtStep : std::uint8_t {
  delaunay,  // Delaunay tetrahedrization of the vertices
  segments,  // Steiner points on missing segments
  facets,    // cavities of missing triangles, filled anew
  classify   // inside and outside
};

enum class Partition : std::uint8_t {
  sides,   // kInside where an odd number of faces separates it from the unbounded part
  regions  // each bounded part is a region of its own
};

// The input: points of a store, and for those on the surface their edge or facet.
struct CdtInput {
  const SurfaceTopology* topology = nullptr;
  // Every point that becomes a vertex: all used input vertices and the enriching points.
  std::vector<VertexId> vertices;
  // Per undirected input edge: enriching points strictly inside it, in order from the smaller end
  // vertex. Empty vector: none.
  std::vector<std::vector<VertexId>> on_edge;
  // Per facet: enriching points strictly inside it (not on its constrained edges).
  std::vector<std::vector<VertexId>> on_facet;
  Partition partition = Partition::sides;
  // Told when a step begins; empty: nobody asks.
  std::function<void(CdtStep)> on_step;
  // Check what the steps promise, and throw InternalError if it does not hold. After `segments`:
  // the tetrahedrization is Delaunay, and every subsegment is an edge. After `classify`: every
  // triangle of every facet is a face, every other face is locally Delaunay, and the two tetrahedra
  // at a face are of different regions only if it is on a facet, always if there are two sides.
  bool validate = kValidating;
};

// Counts the work of facet recovery.
struct CdtCounters {
  std::uint64_t missing_triangles = 0, patches = 0;
  std::uint64_t cavity_tetrahedra = 0, largest_cavity = 0;
  std::uint64_t isolated_vertices = 0;   // of cavities, on neither their skin nor the facet
  std::uint64_t wrapped_tetrahedra = 0;  // found by gift wrapping
  std::uint64_t hidden_vertices = 0;     // passed over by it because walls hide them
  std::uint64_t blocked_tetrahedra = 0;  // local Delaunay tetrahedra that walls enter
  std::uint64_t facet_restarts = 0;      // violations of the theory that were worked around: 0
};

struct CdtResult {
  ConformingMesh mesh;            // of the convex hull of the vertices
  std::vector<VertexId> steiner;  // points added on segments, appended to the store
  std::vector<std::vector<VertexId>>
      chain;  // per undirected non-flat input edge: its vertices end to end
  CdtCounters counters;
};

// A valid surface has a result: throws Stopped at a limit, and InternalError only for a bug.
// `delaunay` may be null, or the Delaunay tetrahedrization of nearly the same vertices; those of
// its hull have to be in `input`. It saves time and does not change the result.
CdtResult constrained_delaunay_tetrahedrization(
    const CdtInput& input, PointStore& points, Predicates& predicates, Control& control,
    std::unique_ptr<Tetrahedrization> delaunay = nullptr);

}  // namespace delmesher::cdt
