// Facets that are planar except for rounding, and a surface on which they are planar.
//
// A flat face that is not parallel to the axes has corners that were rounded, so its triangles lie
// in as many planes. A *planar group* is an edge-connected set of triangles of one label whose
// vertices all lie within a noise bound of one plane; the bound is on the whole group, so slightly
// turning facets do not add up to a bent one. The *planarized surface* has every group in exactly
// one plane, some in another triangulation. A vertex on the planes of three groups is their meeting
// point (PointKind::on_planes); a vertex on fewer is moved along an axis or two. A vertex on more
// stays, and planes are moved to contain it, or triangles at it leave their groups. The planarized
// surface is certified: exactly planar groups of positive triangles, no two triangles of the
// surface meet again, whatever facets it has in the end keep their corners, their outlines and the
// bound (facet_laws.h), and every vertex that moves is in a facet of several triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/surface.h"
#include "mesher/predicates/points.h"
#include "mesher/surface/topology.h"

namespace delmesher::planar {

struct PlanarizedSurface {
  // Empty if nothing moves: all groups are planar as they are.
  std::vector<PlaneEquation> planes;
  // Per vertex: the numbers of its three planes, or kNone where it stays as it is.
  std::vector<std::array<std::uint32_t, 3>> planes_of;
  // The triangles of the surface, with some groups in another triangulation; empty: the same.
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double bound = 0;                // that was asked for
  std::uint64_t groups = 0;        // of more than one triangle, some not on the plane as given
  std::uint64_t given_facets = 0;  // of the surface as given
  // With Options::tolerance: edges that bend by Options::feature or more, and are within facets.
  std::uint64_t lines_lost = 0;
  double deviation = 0;     // largest distance of a vertex from the plane of one of its groups
  double displacement = 0;  // largest distance of a vertex from where it was
};

// May groups have another triangulation? With the same one a mesh of the planarized surface can go
// back to the surface as given; triangles that the moves turn over then are facets of their own.
enum class Retriangulate : std::uint8_t { no, yes };

// `surface` is valid, with finite coordinates. No vertex is farther than `bound`, in its units,
// from the planes of its facets.
PlanarizedSurface planarize(const Surface& surface, double bound, Control& control,
                            Retriangulate retriangulate = Retriangulate::yes);

// Adds the vertices of the planarized surface to an empty store, as points 0 .. vertices-1.
// `earlier`: those of another one, or an empty store; where planes are the same, the points are.
// Returns, for each vertex, whether it is.
std::vector<std::uint8_t> add_vertices(const Surface& surface, const PlanarizedSurface& planarized,
                                       PointStore& points, const PointStore& earlier = {});

// The topology of the planarized surface, on a store that is empty before. See surface/topology.h.
SurfaceTopology planarized_topology(const Surface& surface, const PlanarizedSurface& planarized,
                                    PointStore& points, Predicates& predicates);

}  // namespace delmesher::planar
