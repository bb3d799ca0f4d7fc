// Distances between the elements of a valid surface as the oracles see them: rational, over all
// pairs, and without the mesher's code.
#pragma once

#include <string>
#include <vector>

#include "mesher/delmesher.h"
#include "oracles/surface/input_surface.h"

namespace tetproof::fuzz {

class FeatureSizes {
 public:
  // Empty on success, else why the oracles cannot read the surface.
  std::string assign(const delmesher::Surface& surface);

  const oracles::InputSurface& surface() const { return surface_; }
  double largest_coordinate() const { return surface_.largest_coordinate(); }

  // The smallest distance between two elements (vertices, edges between two facets, facets) that
  // share no point, in input units, right to a few roundings.
  double smallest() const;

  // Are two triangles closer than `distance` (input units)? Their facets should have no common
  // vertex.
  bool closer(oracles::Index triangle, oracles::Index other, double distance) const;
  // Do their facets have a vertex in common?
  bool facets_touch(oracles::Index triangle, oracles::Index other) const;

 private:
  struct Nearest;
  using Box = oracles::BoxTree::Box;

  double length_of(const mpq_class& squared) const;
  Box box(std::initializer_list<oracles::Index> corners) const;
  bool touches(oracles::Index vertex, oracles::Index facet) const;
  void examine_vertices(Nearest& nearest) const;
  void examine_edges(Nearest& nearest) const;

  oracles::ExactPoints points_;
  oracles::InputSurface surface_;
  std::vector<std::vector<oracles::Index>> facet_vertices_;  // sorted
};

}  // namespace tetproof::fuzz
