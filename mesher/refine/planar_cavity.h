// The planar cavity of a new point of a facet: the subfacets whose circumcircles contain it, and
// the edges around them.
//
// Laws: the cavity is connected and does not reach beyond subsegments; the point sees every edge of
// the skin from its inner side, so that the triangles from the point to the skin fill the cavity.
#pragma once

#include <cstdint>
#include <vector>

#include "mesher/refine/subfacet_edge.h"

namespace delmesher::refine {

class FacetTriangulations;

class PlanarCavity {
 public:
  // `start`: a subfacet that contains v. `split`: the edge of it on which v lies, or none; it is
  // not on the skin.
  void find(const FacetTriangulations& all, VertexId v, std::uint32_t start, SubfacetEdge split);

  // In the order in which they were met, as the skin is.
  const std::vector<std::uint32_t>& subfacets() const { return subfacets_; }
  const std::vector<SubfacetEdge>& skin() const { return skin_; }

 private:
  void grow(const FacetTriangulations& all, VertexId v, std::uint32_t start, SubfacetEdge split);
  bool contains(std::uint32_t s) const;
  bool excludes(std::uint32_t s) const;

  std::vector<std::uint32_t> subfacets_;
  std::vector<SubfacetEdge> skin_;
  std::vector<std::uint32_t> excluded_;
};

}  // namespace delmesher::refine
