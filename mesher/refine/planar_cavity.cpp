#include "mesher/refine/planar_cavity.h"

#include <algorithm>

#include "mesher/base/check.h"
#include "mesher/refine/facet_triangulations.h"

namespace delmesher::refine {

bool PlanarCavity::contains(std::uint32_t s) const {
  return std::find(subfacets_.begin(), subfacets_.end(), s) != subfacets_.end();
}

bool PlanarCavity::excludes(std::uint32_t s) const {
  return std::find(excluded_.begin(), excluded_.end(), s) != excluded_.end();
}

// The cavity is star-shaped in theory; a point that bends an artificial edge may see a far skin
// edge from behind: such subfacets are left out.
void PlanarCavity::find(const FacetTriangulations& all, VertexId v, std::uint32_t start,
                        SubfacetEdge split) {
  excluded_.clear();
  for (;;) {
    grow(all, v, start, split);
    const auto behind = std::find_if(skin_.begin(), skin_.end(), [&](SubfacetEdge e) {
      const auto [from, to] = all.ends(e);
      return all.orient(all[start].facet, from, to, v) <= 0;
    });
    if (behind == skin_.end()) return;
    DELMESHER_CHECK(behind->subfacet() != start, "a planar cavity is not star-shaped");
    excluded_.push_back(behind->subfacet());
  }
}

void PlanarCavity::grow(const FacetTriangulations& all, VertexId v, std::uint32_t start,
                        SubfacetEdge split) {
  subfacets_.assign(1, start);
  skin_.clear();
  for (std::size_t n = 0; n < subfacets_.size(); ++n) {
    const std::uint32_t s = subfacets_[n];
    for (std::uint32_t i = 0; i < 3; ++i) {
      const SubfacetEdge next = all[s].neighbor[i];
      if (next.exists() && contains(next.subfacet())) continue;
      if (next.exists() && !excludes(next.subfacet()) && all.in_circle(next.subfacet(), v)) {
        subfacets_.push_back(next.subfacet());
        continue;
      }
      skin_.emplace_back(s, i);
    }
  }
  // An edge may have been put on the skin before the subfacet beyond it joined the cavity.
  std::erase_if(skin_, [&](SubfacetEdge e) {
    const SubfacetEdge next = all[e.subfacet()].neighbor[e.edge()];
    return e == split || (next.exists() && contains(next.subfacet()));
  });
}

}  // namespace delmesher::refine
