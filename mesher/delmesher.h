// delmesher: graded tetrahedral meshes of closed triangulated surfaces, exactly conforming.
//
// An implementation of "Surface chamfering for robust tetrahedral meshing"; section numbers in
// comments are the paper's. The library is reentrant: it has no globals, reports errors as values
// and may run in any number of threads on different inputs. delmesher_plane.h is the same in the
// plane.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "delmesher/exact_record.h"
#include "delmesher/labelled_faces.h"
#include "delmesher/options.h"
#include "delmesher/repair.h"
#include "delmesher/run.h"
#include "delmesher/statistics.h"
#include "delmesher/surface.h"
#include "delmesher/surface_report.h"
#include "delmesher/tet_mesh.h"

namespace delmesher {

struct Result {
  Status status;
  std::vector<std::string> warnings;  // e.g. "the surface was inside out and has been flipped"
  TetMesh mesh;                       // empty unless status.ok()
  Surface chamfered;                  // if Options::want_chamfered: rounded, for display
  std::vector<MeshRegion> regions;    // but with Regions::solid: number N is regions[N - 1]
  std::map<std::int32_t, std::string> wall_names;  // of labels of sides (Options::split_walls)
  ExactRecord exact;                               // if Options::want_exact
  Statistics statistics;
};

// Meshes a closed, manifold, oriented, non-self-intersecting surface (algorithm 2); with
// other Regions any set of triangles that meet in common vertices and edges alone, repeated ones
// counting once, and bound a region. Never throws: errors are in Result::status, with a message
// that names the option, vertex or triangle.
Result tetrahedralize(const Surface& surface, const Options& options = {});

// Constrained Delaunay tetrahedrization of the convex hull of such a surface, without regard to
// angles (Diazzi et al. 2023; Si and Gaertner 2011). Errors as above.
Result constrained_delaunay(const Surface& surface, const CdtOptions& options = {});

// Fewer and better tetrahedra in a conforming mesh of any origin, by local operations (section
// 8.3). The triangles of `mesh.boundary`, the faces of one tetrahedron, the faces between different
// regions or sides, and all their vertices are kept to the last bit. Every tetrahedron counts,
// inside or not. No dihedral angle below 17 degrees (or above 163) and no face angle below `delta`
// is made, unless there was one as bad. Vertices of no tetrahedron are dropped. `inside` may be
// empty, which means all are inside; so may labels and facets. Statistics::refined is of the given
// mesh, `final` of the result; `rounding_flat` counts flat tetrahedra of the given mesh that are
// left. A mesh that is not conforming, by exact signs, is rejected with StatusCode::invalid_mesh;
// overlaps of tetrahedra without a common face are not looked for.
Result improve_mesh(const TetMesh& mesh, const ImproveOptions& options = {});

struct RemeshResult {
  Status status;
  std::vector<std::string> warnings;
  Surface surface;       // empty unless status.ok(); turned outwards
  double tolerance = 0;  // the length
};

// Another surface within options.tolerance of a valid one, in both directions: with few and round
// triangles, or with edges of a wanted length, valid again, with the same topology and labels.
RemeshResult remesh_surface(const Surface& surface, const RemeshOptions& options = {});

// Decides exactly whether a surface is valid input. Angles are judged with options.acute.
SurfaceReport check_surface(const Surface& surface, const CheckOptions& options = {});

// The paper's parameters (sections 4 and 5) and choices: delta 14.47, tau 1e-4, chamfers up to 90
// degrees, empty diametral balls, everything down to the outer box, all of AsPaper.
Options paper_options();

// Version of the library, "MAJOR.MINOR.PATCH".
const char* version();

}  // namespace delmesher
