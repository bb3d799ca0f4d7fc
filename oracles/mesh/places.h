// On which side of the surface the tetrahedra of a mesh are, as wholes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "oracles/base/parallel.h"
#include "oracles/mesh/tet_complex.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::oracles {

enum class Place : std::uint8_t {
  crossed,  // the surface enters it, or its centroid is on the surface
  inside,   // contained in the solid
  outside   // has no point of the solid's interior inside
};

// What faces of a mesh cover of the surface.
struct Cover {
  std::vector<std::uint8_t> walls;  // bit i of a tetrahedron: its face opposite to corner i is one
  // Boxes around the parts of the surface that the faces do not cover, and for each the triangle
  // that it is part of.
  std::unique_ptr<const BoxTree> rest;
  std::vector<Index> triangles;
};

// Several oracles ask, in several threads; the first question is answered for all tetrahedra. All
// arguments must outlive this.
class Places {
 public:
  Places(const TetComplex& complex, const Neighbours& neighbours, const InputSurface& surface)
      : complex_(complex), neighbours_(neighbours), surface_(surface) {}
  // With faces on facets far less has to be decided. The answers are right only if the mesh is a
  // complex that fills its hull and its segments and facets are what the record says, so other
  // oracles must pass as well.
  Places(const TetComplex& complex, const Neighbours& neighbours, const InputSurface& surface,
         std::function<Cover()> cover)
      : complex_(complex), neighbours_(neighbours), surface_(surface), cover_(std::move(cover)) {}

  Place of(std::size_t t) const {
    once_([this] { find(); });
    return places_[t];
  }

 private:
  void find() const;

  const TetComplex& complex_;
  const Neighbours& neighbours_;
  const InputSurface& surface_;
  std::function<Cover()> cover_;  // or none
  mutable Once once_;
  mutable std::vector<Place> places_;
};

// For each tetrahedron the first one that is reached from it over faces that are open from both
// sides (bit i of a tetrahedron: its face opposite to corner i).
std::vector<Index> groups_over(const Neighbours& neighbours, const std::vector<std::uint8_t>& open);

}  // namespace tetproof::oracles
