// The exact form of a run: everything an independent program needs to decide every claim without
// rounding. mesher/io/exact_format.md describes it as a file.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "run.h"

namespace delmesher {

// The exact definition of a point. i, j and k are indices of points of the same list, which are
// explicit or on planes; for a point on planes they are indices of ExactRecord::planes.
struct ExactPoint {
  enum class Kind : std::uint8_t {
    explicit_point,  // (x, y, z)
    on_segment,      // t p_i + (1 - t) p_j, t = x
    on_triangle,     // u p_i + v p_j + (1 - u - v) p_k, u = x, v = y
    on_planes        // where three planes meet
  };
  Kind kind = Kind::explicit_point;
  std::uint32_t i = 0, j = 0, k = 0;
  double x = 0, y = 0, z = 0;
};

// The exact form of a run (command-line option --exact): everything an independent program needs
// to decide every claim without rounding. Point indices are into `points`.
struct ExactRecord {
  struct Parameters {  // the promises of the run
    double delta = 0;  // face angles of the refined mesh, degrees; 0: not recorded
    double acute = 0;  // corners are chamfered below this, where none of `corners` says otherwise
    // The same for two edges at a vertex that is not chamfered; 0: as acute.
    double corner = 0;
    double tolerance = 0;  // of the filter, in input units
    Region region = Region::interior;
    bool gabriel = true;  // no vertex is in the open diametral ball of a constraint
    // No vertex of a facet as given is farther from the plane of the facet, in input units; 0: the
    // surface is as given.
    double planar = 0;
  } parameters;
  struct Plane {
    bool spanned = false;  // by the three points; else normal . (x - through[0]) = 0
    std::array<double, 3> normal{};
    std::array<std::array<double, 3>, 3> through{};
  };
  // What explicit points, and the points that planes go through, are relative to: exact coordinates
  // are sums. Not 0 for surfaces far from the origin, which are meshed beside it.
  std::array<double, 3> origin{};
  std::vector<Plane> planes;  // of points on planes
  // Of the surface that was meshed, where a planar facet has another triangulation than as given;
  // empty: those of the input. The same number of triangles, and the same numbers in each facet,
  // oriented as in the input.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // The input vertices first, in input order: explicit as given, or on planes where they were moved
  // so that facets are planar. In place of moved vertices the mesh has the vertices as given.
  std::vector<ExactPoint> points;
  struct Facet {
    std::uint32_t id;  // smallest input triangle index
    std::int32_t label;
    // 0: kept. Dropped by the filter: 1 for elements that are too close in the input, 2 for
    // features that chamfering made too small, after all facets of 1.
    std::uint8_t filtered;
    std::vector<std::uint32_t> triangles;  // input triangles
  };
  std::vector<Facet> facets;
  struct Chain {                          // a straight (input) or nearly straight edge
    bool artificial;                      // created by the chamfering
    std::uint32_t facet;                  // for artificial ones: the facet's id
    std::vector<std::uint32_t> vertices;  // from end to end, in the refined mesh
  };
  std::vector<Chain> segments;
  struct Corner {  // a chamfered input vertex
    std::uint32_t vertex;
    double distance;  // chamfer distance along its edges, rounded to nearest
  };
  std::vector<Corner> corners;
  // Points made by chamfering, each with the input vertex that it was made for.
  std::vector<std::array<std::uint32_t, 2>> chamfer_points;
  struct Tet {
    std::array<std::uint32_t, 4> vertices;
    bool inside;
  };
  std::vector<Tet> refined;  // every tetrahedron down to the outer box
  std::vector<std::array<std::uint32_t, 4>> refined_facets;  // a, b, c, facet id
  struct Ball {  // a volume Steiner point and the tetrahedron in whose circumball it was put
    std::uint32_t vertex;
    std::array<std::uint32_t, 4> tetrahedron;
  };
  std::vector<Ball> balls;
  std::vector<Tet> final;
  std::vector<std::array<std::uint32_t, 4>> final_facets;  // a, b, c, facet id
  // `final` before local operations, those of the improvement and of repairs of rounding: the
  // constrained Delaunay mesh; empty if there were none.
  std::vector<Tet> unrepaired;
  // `final_facets` then; empty if they were the same.
  std::vector<std::array<std::uint32_t, 4>> unrepaired_facets;
  // Indices into `points` of the vertices of TetMesh, in its order.
  std::vector<std::uint32_t> mesh_vertices;
};

}  // namespace delmesher
