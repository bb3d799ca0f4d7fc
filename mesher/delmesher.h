// delmesher: graded tetrahedral meshes of closed triangulated surfaces, exactly conforming.
//
// An implementation of "Surface chamfering for robust tetrahedral meshing"; section numbers in
// comments are the paper's. The library is reentrant: it has no globals, reports errors as values
// and may run in any number of threads on different inputs. delmesher_plane.h is the same in the
// plane.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "delmesher/as_paper.h"
#include "delmesher/exact_record.h"
#include "delmesher/option_bounds.h"
#include "delmesher/repair.h"
#include "delmesher/run.h"
#include "delmesher/size_source.h"
#include "delmesher/statistics.h"
#include "delmesher/surface.h"
#include "delmesher/surface_report.h"
#include "delmesher/tet_mesh.h"

namespace delmesher {

inline constexpr double kPlanarAuto = -1;

// Angles are degrees, lengths are in the units of the input. kBounds says which values make sense.
struct Options : Limits {
  // Every face angle of the refined mesh is at least this (degrees, section 5.4). 14.47 is a
  // radius-edge ratio of 2; above it the bound is best effort and insertions are capped.
  double delta = 14.47;
  // Input filter (section 7): facets closer than this fraction of the bounding-box diagonal are
  // left to the final step. 0 turns the filter off.
  double tau = 1e-4;
  // Tetrahedra wanted at most: if more are predicted, tau is doubled until it fits. The final mesh
  // conforms all the same. It may still be larger, because the prediction is within a factor of 3
  // for nine models in ten only. 0: no budget.
  std::uint64_t budget = 0;
  // Corners with an angle below this (degrees) are chamfered. The paper's proof needs 90.
  double acute = 60;
  // The threshold for corners between two edges (degrees), if it is smaller than `acute`. A smaller
  // threshold does no harm there: the two segments are split at equal distances from their common
  // end, and then they do not encroach each other, however acute their angle is.
  double corner = 20;
  // Split constraints until their open diametral balls are empty, as the paper does (sections 5.2
  // and 5.3). Otherwise they are split where the Delaunay tetrahedrization lacks them and where
  // volume points encroach them, which takes fewer tetrahedra.
  bool gabriel = false;
  // Fewer and better tetrahedra on the same surface, by local operations (section 8.3).
  bool improve = true;
  // Treat slivers in the refinement (section 5.7). The improvement then has less to mend, and ends
  // with rounder tetrahedra and better worst ones, for a tenth more of them (docs/options.md).
  bool slivers = true;
  bool approximate = false;      // stop before the enriched CDT (section 6)
  bool simplify_bridges = true;  // section 4.4
  double chamfer_radius = 0;     // how far a chamfer may reach, in input units; 0: no bound
  // Triangles that are coplanar but for rounding become one facet. The surface keeps the vertices
  // and edges of such facets; in between it may deviate by this fraction of the bounding box's
  // diagonal. 0: the surface as given, to the last bit; if meshes are improved, such triangles are
  // one facet while they are refined, and the edges between them come back at the end. kPlanarAuto:
  // as little as it takes for triangles that are bent by less than 2^-20 of the diagonal, at most
  // 2^-18; where coordinates were rounded to few digits, six times what that moves a point off a
  // plane (surface/flatness.h, surface/resolution.h), and where edges tell of more noise, 16 times
  // that (surface/edge_bends.h), at most 2^-12.
  double planar = kPlanarAuto;
  double max_edge = 0;  // largest edge wanted inside, in input units; 0: no bound
  // Smaller edges in places, in input units: nowhere along an edge inside is it longer than size +
  // size_growth * distance, of any of these sources and its distance. Empty: no bound.
  std::vector<SizeSource> size_field;
  double size_growth = 0.3;
  AsPaper as_paper;
  Region region = Region::interior;
  bool want_exact = false;      // fill Result::exact
  bool want_chamfered = false;  // fill Result::chamfered
};

struct Result {
  Status status;
  std::vector<std::string> warnings;  // e.g. "the surface was inside out and has been flipped"
  TetMesh mesh;                       // empty unless status.ok()
  Surface chamfered;                  // if Options::want_chamfered: rounded, for display
  ExactRecord exact;                  // if Options::want_exact
  Statistics statistics;
};

// Meshes a closed, manifold, oriented, non-self-intersecting surface (algorithm 2). Never throws:
// errors are in Result::status, with a message that names the option, vertex or triangle.
Result tetrahedralize(const Surface& surface, const Options& options = {});

// Constrained Delaunay tetrahedrization of the convex hull of such a surface, without regard to
// angles (Diazzi et al. 2023; Si and Gaertner 2011). Uses region, limits, progress, want_exact.
// Errors as above.
Result constrained_delaunay(const Surface& surface, const Options& options = {});

// Fewer and better tetrahedra in a conforming mesh of any origin, by local operations (section
// 8.3). The triangles of `mesh.boundary`, the faces of one tetrahedron, the faces between different
// regions or sides, and all their vertices are kept to the last bit. Every tetrahedron counts,
// inside or not. No dihedral angle below 17 degrees (or above 163) and no face angle below `delta`
// is made, unless there was one as bad. Vertices of no tetrahedron are dropped. Uses delta,
// max_edge and size_field (no longer edge is made) and limits. `inside` may be empty, which means
// all are inside; so may labels and facets. Statistics::refined is of the given mesh, `final` of
// the result; `rounding_flat` counts flat tetrahedra of the given mesh that are left. A mesh that
// is not conforming, by exact signs, is refused with StatusCode::invalid_mesh; overlaps of
// tetrahedra without a common face are not looked for.
Result improve_mesh(const TetMesh& mesh, const Options& options = {});

// Decides exactly whether a surface is valid input. Angles are judged with options.acute.
SurfaceReport check_surface(const Surface& surface, const Options& options = {});

// The paper's parameters (sections 4 and 5) and choices: delta 14.47, tau 1e-4, chamfers up to 90
// degrees, empty diametral balls, everything down to the outer box, all of AsPaper.
Options paper_options();

// Version of the library, "MAJOR.MINOR.PATCH".
const char* version();

}  // namespace delmesher
