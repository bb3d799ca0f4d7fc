// What the steps on the mesh as it was written have in common.
#pragma once

#include <span>

#include "oracles/mesh/tet_complex.h"
#include "oracles/plan.h"

namespace tetproof::oracles {

class FileStep : public Step {
 public:
  using Step::Step;

 protected:
  // Are all coordinates of the file finite?
  bool check_finite();
  // Nodes of edges, the numbers of vertices and tetrahedra, and what the file says of its planar
  // facets.
  void check_contents();
  // The tetrahedra on points, which have the vertices of the input first; their neighbours and
  // signs. False if nothing else can be asked. `is_part`: as of check_complex.
  bool check_tetrahedra(const ExactPoints& points, bool is_part, TetComplex& complex,
                        Neighbours& neighbours);
  // Points of the input that no triangle has. `near`: as of check_loose_points.
  void check_points(const TetComplex& complex, double near);
  // Edges that are longer than promised. `surface`: faces whose edges the mesh may have to keep.
  void check_lengths(const TetComplex& complex, std::span<const Face> surface);
  // `longest`: the longest edge promised, per tetrahedron, instead of that of the promise. `fine`:
  // no face of the surface has a longer one.
  void check_lengths(const TetComplex& complex, std::span<const double> longest, bool fine);
  // Names the listed triangles that are not turned as they should be, where these are only counted.
  void tell_turned(const OracleReport& list, const char* how);
  // Names what has not been kept as unproven, instead of failing.
  void say_first(const std::string& what, OracleReport& oracle);

 private:
  void turn_all(TetComplex& complex) const;
};

}  // namespace tetproof::oracles
