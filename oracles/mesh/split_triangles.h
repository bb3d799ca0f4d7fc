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
//
// They are found from the chains on, face by face. Where flat tetrahedra lie on the triangle, or
// another triangle is so near to it, several may be next: then the one that is between two regions
// of the file, or on the outside, if there is one such. Whatever is chosen, the above proves it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "oracles/base/box_tree.h"
#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

// In input units.
double distance_rounded_up(const ExactPoints& points, Index v, const Face& triangle);

class SplitTriangles {
 public:
  struct Split {
    std::vector<Face> faces;  // which look to where the triangle does; none if there are none such
    // There may be others: a vertex is near two sides, or near triangles that have not the side on
    // which it is, or several faces were next.
    bool is_ambiguous = false;
  };

  // `triangles`: all of the complex, by vertices of the mesh where these are at their corners; they
  // must outlive this.
  // `regions`: of tetrahedra; may be empty. `near`: in input units.
  SplitTriangles(const TetComplex& complex, std::span<const std::int64_t> regions,
                 std::span<const Face> triangles, double near);

  // Per triangle asked for.
  std::vector<Split> read(const Neighbours& neighbours, std::span<const Face> asked);
  // Of the vertices on those that were read, from where they belong; rounded up.
  double deviation() const { return deviation_; }

 private:
  struct Vertices {
    std::array<std::vector<Index>, 3> on_sides;  // in their order
    std::vector<Index> inside;
    std::map<Index, double> off;  // of all of them: from where they belong
  };
  using Edge = std::pair<Index, Index>;
  using FacesAt = std::map<Face, bool>;  // sorted; are they between two regions?
  // Faces that may be those of a triangle, turned as it is, by their edges.
  class Tiles;

  bool find_vertices(const Face& triangle, const std::vector<Index>& around,
                     Vertices& vertices) const;
  void find_triangles(const BoxTree& tree, std::span<const Index> added,
                      std::span<const Vertices> found);
  bool is_beside_others(const Face& triangle, const Vertices& vertices) const;
  bool sort_along(Index from, Index to, std::vector<Index>& chain) const;
  void collect_faces(const Neighbours& neighbours, std::span<const Vertices> found);
  Split faces_of(const Face& triangle, const Vertices& vertices) const;

  const TetComplex& complex_;
  const ExactPoints& points_;
  const std::span<const std::int64_t> regions_;
  const std::span<const Face> triangles_;
  const double near_;
  std::vector<bool> is_corner_;
  std::map<Index, FacesAt> faces_at_;  // of vertices that are near a triangle
  std::map<Index, std::vector<Face>> triangles_at_;
  double deviation_ = 0;
};

}  // namespace tetproof::oracles
