// Removes an edge: the ring of tetrahedra around it is tetrahedrized anew, without the edge
// (Shewchuk 2002, "Two discrete optimization algorithms for the topological improvement of
// tetrahedral meshes"). An edge within a facet has a ring of two halves, each of which gets its
// own; the two triangles of the facet beside it become the other two of their quadrilateral.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesher/improve/state.h"

namespace delmesher::improve {

class EdgeRemoval {
 public:
  explicit EdgeRemoval(State& state) : state_(state) {}

  // Removes edge i-j of t if that makes the worst tetrahedron of the ring better. `failed`: per
  // slot, the clock plus 1 when the edges of its tetrahedron had been tried; whatever tetrahedron
  // of the ring they were tried from, there is no use in trying again before one of their ends
  // changes.
  bool run(TetId t, int i, int j, std::span<const std::uint32_t> failed);
  // Removes it if the tetrahedra are rounder on average afterwards, and the worst of them stay good
  // enough.
  bool round_off(TetId t, int i, int j, std::span<const std::uint32_t> failed);
  // Removes edge i-j of t, which lies within a facet, if what replaces the ring is positive,
  // however bad.
  bool flip(TetId t, int i, int j);

 private:
  // The longest ring that is considered.
  static constexpr int kLongest = 9;
  // The same for roundness, and its longest polygon: of longer ones hardly any becomes rounder.
  static constexpr int kLongestForRoundness = 6, kLargestForRoundness = 4;

  // The measure by which fillings of a polygon are compared.
  enum class Aim : std::uint8_t { best_worst, roundest };

  // The value of a filling; nothing has been found while its worst is flat. `roundness`: how much
  // rounder than is asked for on average, summed over its tetrahedra, if that is the aim.
  struct Filling {
    Quality worst;
    double roundness = 0;
  };

  // A polygon of the ring's vertices, from the first to the last; between two triangles of a facet,
  // or all around.
  struct Polygon {
    int size = 0;
    RegionId region = kOutside;
    std::array<VertexId, kLongest + 1> vertex;
    // Of the best triangulation of vertices i to j: the third vertex of the triangle at i-j.
    std::array<std::array<std::int8_t, kLongest + 1>, kLongest + 1> middle;
  };

  bool find_ring(TetId t, std::span<const std::uint32_t> failed);
  bool is_known(TetId t, std::span<const std::uint32_t> failed) const;
  bool collect_ring(TetId first, std::span<const std::uint32_t> failed);
  TetId beginning(TetId t) const;
  bool split_ring();
  bool refill(double least_roundness);
  Filling triangulate(Polygon& polygon);
  bool improves(const Filling& filling, const Filling& best) const;
  static double roundness(const Quality& q);
  void collect(const Polygon& polygon);

  State& state_;
  VertexId a_ = 0, b_ = 0;
  std::vector<TetId> ring_;         // tetrahedra a, b, vertex[n], vertex[n + 1]
  std::vector<VertexId> vertex_;    // one more than tetrahedra if the ring is open
  std::vector<FacetId> facet_;      // of the face a, b, vertex[n]
  std::size_t longest_ = kLongest;  // ring that is considered now
  Aim aim_ = Aim::best_worst;
  Quality least_;                   // the quality that the new tetrahedra have to reach
  std::vector<std::size_t> walls_;  // numbers of the faces of the surface
  std::vector<Polygon> polygons_;
  std::array<std::array<Filling, kLongest + 1>, kLongest + 1> best_;  // of triangulate()
  std::vector<CreatedTet> created_;
  std::vector<SurfaceFace> faces_;
};

}  // namespace delmesher::improve
