// Is a triangulated surface a valid input? Asked of CGAL and of OpenMesh, as a second opinion on
// the mesher's own check.
#pragma once

#include <string>

#include "oracles/files/polyhedron.h"

namespace tetproof::oracles {

struct SurfaceOpinion {
  // Each is decided only if those above it hold.
  bool manifold = false;  // oriented consistently, edges of at most two triangles, one fan a vertex
  bool closed = false;
  bool free_of_intersections = false;  // and of degenerate triangles
  bool decides_intersections = true;   // OpenMesh knows no geometry
  std::string reason;                  // what is wrong, with an element where the library names one

  bool valid() const {
    return manifold && closed && (free_of_intersections || !decides_intersections);
  }
};

struct SurfaceQuestions {
  bool intersections = true;  // and degenerate triangles
};
SurfaceOpinion cgal_surface_opinion(const Polyhedron& surface,
                                    const SurfaceQuestions& questions = {});
// What is wrong with a complex of triangles: one without area, or two that meet elsewhere than in
// common vertices or an edge and are not the same. Vertices at one place are one. Empty: nothing.
std::string cgal_complex_defect(const Polyhedron& complex);
SurfaceOpinion openmesh_surface_opinion(const Polyhedron& surface);

}  // namespace tetproof::oracles
