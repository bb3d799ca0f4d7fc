// The input of the plane: checked exactly, triangulated, and its faces classified.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delmesher/planar_graph.h"
#include "mesher/plane/triangulation.h"

namespace delmesher::plane {

// An input segment, or the part of one between two vertices that lie on it, or a side of the outer
// box.
struct Piece {
  VertexId a, b;
  std::uint32_t segment;  // of the input, or kNone for a side of the box
  // Is the face on that side, seen from a towards b, inside?
  bool inside_left = false, inside_right = false;
};

inline constexpr std::size_t kBoxPieces = 4;  // the first of the pieces

struct InputGraph {
  const PlanarGraph* input;
  // Coordinates are multiplied by 2^-scale, so that the largest is around 1.
  int scale = 0;
  // Smallest positive double of the input, in the units of the store. New points are multiples of
  // it, or they could not be given back exactly.
  double unit = 0;
  VertexId vertices = 0;  // ids of the input vertices are below; the corners of the box follow
  // Ids follow a curve that fills the plane, so that vertices close together in the plane are
  // mostly close together in memory. `id`: of each number in the input; `number`: of each id.
  std::vector<VertexId> id, number;
  std::vector<Piece> pieces;
  Triangulation base;  // constrained Delaunay triangulation of everything, with the box
  std::vector<std::uint8_t> inside;  // per triangle of the base
  std::vector<std::string> warnings;
  double diagonal = 0;  // of the bounding box, in input units

  // The number that callers know a point by.
  VertexId number_of(VertexId v) const { return v < vertices ? number[v] : v; }
  bool is_box_corner(VertexId v) const { return v >= vertices && v < vertices + 4; }
};

// Throws Stopped if numbers are out of range or not finite.
void check_numbers(const PlanarGraph& graph);

// Fills the store, which must be empty. Throws Stopped with StatusCode::invalid_surface if the
// graph is not one: the message names the offending vertices or segments.
InputGraph build_graph(const PlanarGraph& input, PointStore& points, PlanePredicates& predicates,
                       Control& control);

// Which triangles of a triangulation of the graph are inside, and the attributes of their regions.
struct Faces {
  std::vector<std::uint8_t> inside;
  std::vector<double> attributes;  // empty if the graph has no regions
};
// `notes`, if any, receives remarks on odd hole and region points.
Faces find_faces(const InputGraph& graph, Triangulation& mesh, PointStore& points,
                 std::vector<std::string>* notes);

// The nearest coordinate that the input could have.
inline double to_unit(const InputGraph& graph, double x) {
  return graph.scale < 0 ? std::ldexp(std::ldexp(x, graph.scale), -graph.scale) : x;
}

// The coordinates of an input point as the store has them.
inline std::array<double, 2> to_store(const InputGraph& graph, const std::array<double, 2>& p) {
  return {std::ldexp(p[0], -graph.scale), std::ldexp(p[1], -graph.scale)};
}

}  // namespace delmesher::plane
