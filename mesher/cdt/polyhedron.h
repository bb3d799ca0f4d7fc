// Constrained Delaunay tetrahedrization of a polyhedron all of whose faces are constrained
// Delaunay: one side of the cavity that a missing part of a facet leaves.
//
// By Shewchuk's theorem (2000; 2008 for the perturbed, that is weighted, case) it exists, needs no
// further vertices and is unique; so tetrahedra that are found to be constrained Delaunay fit
// together, in whatever order they are found.
#pragma once

#include <array>
#include <vector>

#include "mesher/base/control.h"
#include "mesher/delaunay/tetrahedrization.h"

namespace delmesher::cdt {

using Triangle = std::array<VertexId, 3>;
using Tetrahedron = std::array<VertexId, 4>;

struct FillCounters {
  std::uint64_t wrapped = 0;  // tetrahedra found by gift wrapping
  std::uint64_t hidden = 0;   // vertices it passed over because a wall hides them
  std::uint64_t blocked = 0;  // tetrahedra of a local Delaunay tetrahedrization that a wall enters
};

class PolyhedronFiller {
 public:
  PolyhedronFiller(Predicates& predicates, Control& control)
      : predicates_(predicates), control_(control) {}

  // Appends the tetrahedra that fill the polyhedron bounded by `faces`, counter-clockwise seen from
  // outside it. A face may occur in both orientations: a dangling wall. `isolated` are the vertices
  // that are on no face. Returns false if faces or vertices are not as required, which is a bug of
  // the caller.
  bool fill(std::vector<Triangle> faces, std::vector<VertexId> isolated,
            std::vector<Tetrahedron>& tetrahedra);

  const FillCounters& counters() const { return counters_; }

 private:
  bool delaunay_part(std::vector<Triangle>& faces, std::vector<Tetrahedron>& tetrahedra);
  void collect_vertices(const std::vector<Triangle>& faces, const std::vector<VertexId>& isolated);

  Predicates& predicates_;
  Control& control_;
  std::vector<VertexId> vertices_;
  FillCounters counters_;
};

}  // namespace delmesher::cdt
