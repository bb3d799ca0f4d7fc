// Improvement of a conforming tetrahedral mesh by local operations (future work in section 8.3):
// fewer and better tetrahedra on exactly the same surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/run.h"
#include "mesher/geometry/size_field.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/surface_face.h"
#include "mesher/surface/topology.h"
#include "mesher/tetmesh/conforming_mesh.h"

namespace delmesher::improve {

// No dihedral angle flatter than this, in degrees, is made where none was before.
inline constexpr double kFlattestDihedral = 17;

// Points that go, whatever becomes of the quality, while a mesh has more tetrahedra than wanted;
// some into the volume (relocation.h).
struct Sparing {
  std::span<const std::uint8_t> edges = {};  // per edge: 1 if points on it may go; empty: none
  std::size_t tetrahedra = 0;                // wanted at most
};

struct ImproveOptions {
  double delta = 14.47;  // degrees: no face angle below it is made, unless one was there
  double max_edge = 0;   // no edge longer than this is made; 0: any
  const SizeField* sizes = nullptr;           // nor than these allow
  std::span<const double> region_edges = {};  // the same as max_edge by region; empty: none
  Region region = Region::interior;           // which tetrahedra are to be good
  // Of a planarized surface: new tetrahedra are positive on the surface as given, too.
  bool as_given = false;
  Sparing sparing = {};
  // No vertex is added to the surface, those that are not of the input leave it, and the volume is
  // filled with points (filling.h).
  bool keep_surface = false;
  // Edges that are longer than wanted get points all the same, those of the surface as well.
  bool halve_edges = false;
  // The mesh will be improved once more: the last resorts wait.
  bool unfinished = false;
};

struct ImproveResult {
  ConformingMesh mesh;
  bool changed = false;
  std::vector<VertexId> became;  // per point of the store before: its point now, kNone if gone
  std::uint64_t spared = 0;      // points that left their edges by Sparing
  std::uint64_t left = 0;        // on the surface, if it was to be kept, that are not of the input
};

// `topology`: of the surface that the mesh conforms to; null if all of its faces stay as they are.
// `given`: its vertices as given, if it is planarized. New points are appended to the store.
// Deterministic, and the same in whatever order tetrahedra and faces are given. Throws Stopped when
// the control says so.
ImproveResult improve(ConformingMesh mesh, const SurfaceTopology* topology,
                      std::span<const Vec3> given, const ImproveOptions& options,
                      PointStore& points, Predicates& predicates, Control& control);

}  // namespace delmesher::improve
