// The faces of a surface: sets of triangles of one label, which an angle can make.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "run.h"
#include "surface.h"

namespace delmesher {

// Labels the triangles of a surface without labels (or with one for all) by its sharp edges: a face
// grows over edges at which two triangles bend by less than `degrees`, above 0 and at most 90.
// Labels are 1, 2, ... in the order of the faces' smallest triangles; label N is called face_N.
//
// Laws:
//  (1) Two triangles that have an edge in common, run along it in opposite directions and bend
//      there by less than `degrees`, decided exactly, have one label, and labels differ no more
//      than that makes them.
//  (2) So the faces do not depend on the order of triangles and of their corners, only the numbers
//      do; nor on which side is out.
//  (3) A smaller angle splits faces and joins none.
//  (4) Where the surface is closed and manifold, the edges between labels form closed loops: no
//      vertex has just one of them. A sharp edge that ends in a face is not between labels.
//
// A surface that has several labels is rejected with StatusCode::invalid_options, as is an angle
// out of range: what was labelled by hand says more than an angle. Indices out of range and
// infinite coordinates are StatusCode::invalid_surface. A rejected surface is left as it was.
Status label_by_angle(Surface& surface, double degrees);

// The triangles of one label.
struct LabelledFace {
  enum class Shape : std::uint8_t { planar, cylindrical, other };
  std::int32_t label = 0;
  std::uint64_t triangles = 0;
  double area = 0;
  std::array<double, 3> lower{}, upper{};  // bounding box
  Shape shape = Shape::other;              // within a thousandth of the face's box
  // Of length 1: planar faces have a normal, outwards; cylindrical ones the direction of their
  // axis, whose largest component is positive. Others: zero.
  std::array<double, 3> direction{};
};

// The faces of a valid surface by label, measured in doubles. Empty without labels.
std::vector<LabelledFace> labelled_faces(const Surface& surface);

}  // namespace delmesher
