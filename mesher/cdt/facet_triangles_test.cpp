#include "mesher/cdt/facet_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"

namespace delmesher::cdt {
namespace {

using namespace test_models;

// A slab of cells with a hole through it, so that facets are convex, with a point off their plane
// on the inner side alone, and not, with holes.
class FacetTrianglesOfASlab : public testing::Test {
 protected:
  FacetTrianglesOfASlab() {
    for (FacetId f = 0; f < model_.topology.facet_triangles.size(); ++f) {
      const Chains chains(model_.input, model_.points);
      facets_.push_back(FacetTriangulator(model_.input, chains, model_.predicates).triangulate(f));
    }
  }

  Model model_{voxels({{{0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1}}},
                      [](int i, int j, int) { return i != 1 || j != 1; })};
  std::vector<PlanarTriangulation> facets_;
};

TEST_F(FacetTrianglesOfASlab, LookOutwards) {
  ASSERT_TRUE(model_.valid);
  ASSERT_EQ(facets_.size(), 10U);
  for (FacetId f = 0; f < facets_.size(); ++f) {
    const int axis = model_.topology.facet_axis[f], sign = model_.topology.facet_axis_sign[f];
    for (const auto& t : facets_[f].triangles) {
      EXPECT_EQ(model_.predicates.orient2d(axis, t[0], t[1], t[2]), sign);
    }
  }
}

TEST_F(FacetTrianglesOfASlab, NeighboursShareTheirEdgeAndSayWhichItIs) {
  std::size_t shared = 0;
  for (const PlanarTriangulation& facet : facets_) {
    ASSERT_EQ(facet.neighbors.size(), facet.triangles.size());
    for (std::uint32_t t = 0; t < facet.triangles.size(); ++t) {
      for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t side = facet.neighbors[t][i];
        if (side == kNone) continue;
        ++shared;
        ASSERT_LT(side / 3, facet.triangles.size());
        EXPECT_EQ(facet.neighbors[side / 3][side % 3], 3 * t + i);
        const auto &here = facet.triangles[t], &there = facet.triangles[side / 3];
        EXPECT_EQ(here[(i + 1) % 3], there[(side % 3 + 2) % 3]);
        EXPECT_EQ(here[(i + 2) % 3], there[(side % 3 + 1) % 3]);
      }
    }
  }
  EXPECT_GT(shared, 40U);
}

}  // namespace
}  // namespace delmesher::cdt
