// Triangles of a complex that the mesh has as several faces each, because vertices were left on
// them; rounded in a file.
//
// Faces are those of a triangle, but for vertices that are at most `near` from their places, if
//  - each edge of it is a chain of vertices so near to it, in their order along it. It is that of
//    all triangles at the edge, because all vertices there are in it;
//  - all other corners of the faces are so near to the triangle;
//  - their edges are those of the chains, each of one face, and others, each of two, that have them
//    in opposite directions;
//  - seen along its normal, all of them look to where the triangle does.
// Then they cover, seen so, exactly once what the chains go round, and they have its boundary: the
// complex in which they replace it is the input with these vertices, moved by so much.
#pragma once

#include <array>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

class SplitTriangles {
 public:
  struct Split {
    std::vector<Face> faces;  // which look to where the triangle does; none if there are none such
    // A vertex is near two sides, or faces lie on each other: on flat tetrahedra.
    bool is_ambiguous = false;
  };

  // `triangles`: all of the complex, by vertices of the mesh where these are at their corners.
  // `near`: in input units.
  SplitTriangles(const TetComplex& complex, std::span<const Face> triangles, double near);

  // Per triangle asked for.
  std::vector<Split> read(const Neighbours& neighbours, std::span<const Face> asked);
  // Of the vertices on those that were read, from where they belong; rounded up.
  double deviation() const { return deviation_; }

 private:
  struct Vertices {
    std::array<std::vector<Index>, 3> on_sides;  // in their order
    std::vector<Index> inside;
    double deviation = 0;
  };

  bool find_vertices(const Face& triangle, const std::vector<Index>& around,
                     Vertices& vertices) const;
  bool sort_along(Index from, Index to, std::vector<Index>& chain) const;
  void collect_faces(const Neighbours& neighbours, std::span<const Vertices> found);
  Split faces_of(const Face& triangle, const Vertices& vertices) const;

  const TetComplex& complex_;
  const ExactPoints& points_;
  const double near_;
  std::vector<bool> is_corner_;
  std::map<Index, std::set<Face>> faces_at_;  // of vertices that are near a triangle, sorted
  double deviation_ = 0;
};

}  // namespace tetproof::oracles
