// Closed surfaces of sides of triangles that have no tetrahedra: around what a mesh does not have,
// or the outside.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "oracles/base/exact_points.h"
#include "oracles/base/exact_sum.h"
#include "oracles/base/union_find.h"
#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

// A side of a triangle: in front, where its corners are seen counter-clockwise, or behind.
inline Index side(Index triangle, bool behind) {
  return 2 * triangle + (behind ? 1 : 0);
}

// Sides that are connected around edges where nothing but an empty wedge is between two of them.
struct Shell {
  std::vector<Index> sides;
  ExactSum volume;            // positive if what is on its side is within
  std::vector<Index> points;  // region points of the part within
};

class Shells {
 public:
  // `empty`: per side, has it no tetrahedron? The other arguments must outlive this.
  Shells(const ExactPoints& points, const std::vector<Face>& triangles,
         std::vector<std::uint8_t> empty);

  // Pairs of triangles beside each other around an edge, of which only one has a tetrahedron in the
  // wedge between them.
  const std::vector<std::array<Index, 2>>& broken_wedges() const { return broken_wedges_; }

  // By the least of their sides that stands for all.
  std::map<Index, Shell>& all() { return shells_; }
  std::vector<Face> faces_of(const Shell& shell) const;

  // The smallest with a part within that surrounds something; null: none does.
  template <class Surrounds>
  Shell* innermost(const Surrounds& surrounds) {
    Shell* found = nullptr;
    for (auto& [number, shell] : shells_) {
      const bool smaller = found == nullptr || difference(shell.volume, found->volume, 0) < 0;
      if (shell.volume.sign() > 0 && smaller && surrounds(shell)) found = &shell;
    }
    return found;
  }

  // The volume of the part within a shell: shells that it surrounds, and no smaller one does, are
  // those of cavities.
  ExactSum without_cavities(const Shell& outer);

 private:
  struct AtEdge {
    Index triangle, apex;
    bool runs_along;  // does the triangle run from the smaller to the larger end?
  };

  void connect(UnionFind& sets);
  void sort_around(Index low, Index high, std::vector<AtEdge>& around) const;
  bool surrounds(const Shell& shell, Index what) const;
  void add_side(Index s, ExactSum& sum) const;

  const ExactPoints& points_;
  const std::vector<Face>& triangles_;
  std::vector<std::uint8_t> empty_;
  std::vector<std::array<Index, 2>> broken_wedges_;
  std::map<Index, Shell> shells_;
};

}  // namespace tetproof::oracles
