// The union of bodies: the surface around all of them, by an exact arrangement of their triangles.
//
// Input: triangles that close up. They may intersect, overlap in one plane, occur twice, and bodies
// may contain each other. With each of its two triangles turned the other way an edge closes up, so
// that every point off the surface has a winding number: how often the surface goes round it. Where
// the surface is open, or neighbours disagree about the outside, there is none, and no union.
//
// How: triangles are cut along their intersections with others, those in one plane together; equal
// points are one, and pieces that cancel are gone. A patch is a set of pieces that are connected
// over edges of two. One ray of each patch counts the winding number in front of it, and so the one
// behind it. The patches with the inside on exactly one side are the union. All of this is exact.
// Before it, parts of triangles that meet become one where they are a few ulp of the largest
// coordinate from each other (joining.h): meant to coincide, they would cross in countless points.
// After it, the new points are rounded to doubles, and what comes out goes the same way once more
// until no two of its triangles meet outside of a vertex or an edge that both have.
//
// Laws:
// - Before rounding, and if nothing was joined, a point is inside the result exactly if its winding
//   number is positive (or not zero: Inside).
// - The result closes up, with all normals outwards. No two triangles meet outside of a common
//   vertex or edge, none is without area. It is manifold but where parts of it touch, which is
//   counted; if UnionOptions::separate says so, they are moved apart (separate.h), and it is
//   manifold. If it is manifold, CGAL's polygon mesh processing and OpenMesh find it valid.
// - Vertices that are left are where they were, to the last bit; new ones are where their exact
//   place is rounded to, and `largest_move` bounds how far these and what was joined have moved.
// - No new triangle is thinner than a 2^-48 of the largest coordinate, or a line says how many are.
// - A triangle that meets no other, is at no edge of more than two and beside none that thin is the
//   same triangle if it is kept. Every other one has the label of triangles of its plane that cover
//   it.
// - Around other triangles no vertex is left within a flat side of one label, or on a straight edge
//   between two (flat_sides.h).
// - The union of a result is that result.
// - The same input gives the same result.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesher/delmesher.h"

namespace tetproof::unite {

enum class Inside : std::uint8_t {
  positive,  // where the winding number is positive
  nonzero    // also inside bodies whose triangles are turned inwards
};

struct UnionOptions {
  Inside inside = Inside::positive;
  // Where parts touch, they are moved apart, each vertex by at most this fraction of the diagonal
  // of the result; 0: they are left as they are.
  double separate = 0;
  bool walls = false;  // instead of a union: walls.h; not with the others
  // With walls: what is nearer than this counts as touching, as may what is nearer than four times
  // this. Minus a fraction of the diagonal; 0: what roundings explain.
  double snap = 0;
  std::function<bool()> go_on;  // asked many times a second; unite() stops where it says no
};

enum class UnionCode : std::uint8_t {
  done,
  touching,      // the union is there, but not manifold: parts of it touch
  unsound,       // a corner that is not a point, or triangles that do not close up
  empty,         // nothing is inside
  imprecise,     // new points are too close to each other for doubles
  out_of_range,  // coordinates become subnormal
  inseparable,   // parts touch, and could not be moved apart
  stopped
};

// What was done, for whoever wants more than words.
struct UnionCounts {
  std::uint64_t welded = 0, degenerate = 0;           // vertices, triangles of the input
  std::uint64_t bodies_before = 0, bodies_after = 0;  // that are connected over edges
  std::uint64_t pairs = 0, coplanar_pairs = 0;        // of triangles that meet
  std::uint64_t cut = 0, new_points = 0;              // triangles, points of the arrangement
  std::uint64_t dropped = 0;                          // pieces that are not in the result
  std::uint64_t flat_vertices = 0;  // given and new ones that the shape does not need
  std::uint64_t needles = 0;        // triangles as thin as roundings, removed
  std::uint64_t inside_out = 0;     // patches with a negative winding number behind
  std::uint64_t touching_edges = 0, touching_vertices = 0;
  std::uint64_t halved_edges = 0, copies = 0;  // by moving parts apart
  double largest_separation = 0;               // how far a vertex was moved for that, at most
  int rounds = 0;                              // of cutting and rounding
  double volume_before = 0, volume_after = 0;  // before: overlaps count once for each body
  double largest_move = 0;                     // by joining and rounding
};

struct UnionResult {
  UnionCode code = UnionCode::done;
  std::string message;            // why there is no union, or what is left of it; a line
  std::vector<std::string> done;  // what was done, a line each
  UnionCounts counts;
  delmesher::Surface surface;  // with done and touching
};

// What must not happen: a mistake in this program, or in a library.
struct InternalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws std::bad_alloc and InternalError, else nothing.
UnionResult unite(const delmesher::Surface& surface, const UnionOptions& options = {});

}  // namespace tetproof::unite
