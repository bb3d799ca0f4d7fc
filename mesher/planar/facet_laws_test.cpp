#include "mesher/planar/facet_laws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/planar/planar_growth.h"
#include "mesher/planar/planarized_surface.h"
#include "mesher/predicates/predicates.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::planar {
namespace {

using namespace surface::test_surfaces;  // NOLINT(google-build-using-namespace)

// A surface, its neighbours, and its points.
struct Changed {
  Surface given;
  std::vector<std::uint32_t> given_opposite;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> opposite;
  PointStore points;
  Predicates predicates{points};

  Changed(const Surface& as_given, const Surface& changed)
      : given(as_given),
        given_opposite(MeasuredSurface(as_given).opposite()),
        triangles(changed.triangles),
        opposite(MeasuredSurface(changed).opposite()) {
    add_vertices(changed, {}, points);
  }
  ChangedSurface surface() const { return {given, given_opposite, triangles, opposite}; }
};

TEST(FacetLaws, FacetsAreConnectedCoplanarAndOfOneLabel) {
  Surface s = box({0, 0, 0}, {1, 2, 3}, 2);
  Changed whole(s, s);
  const auto six = facets_of(whole.surface(), whole.predicates);
  ASSERT_EQ(six.size(), 6U);
  for (std::uint32_t f = 0; f < 6; ++f) {
    ASSERT_EQ(six[f].size(), 8U);
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(six[f][i], 8 * f + i);
  }
  s.labels.assign(s.triangles.size(), 0);
  s.labels[0] = 1;
  Changed labelled(s, s);
  EXPECT_EQ(facets_of(labelled.surface(), labelled.predicates).size(), 7U);
  // Two boxes with a face each in one plane are not connected by that.
  const Surface two = joined(box({0, 0, 0}, {1, 1, 1}), box({2, 0, 0}, {3, 1, 1}));
  Changed apart(two, two);
  EXPECT_EQ(facets_of(apart.surface(), apart.predicates).size(), 12U);
}

// Triangles h / 3 and its neighbour, with the other diagonal.
Surface flipped(Surface s, std::uint32_t h) {
  const std::uint32_t g = MeasuredSurface(s).opposite()[h], t = h / 3, u = g / 3;
  const VertexId a = s.triangles[t][h % 3], b = s.triangles[t][(h % 3 + 1) % 3],
                 c = s.triangles[t][(h % 3 + 2) % 3], d = s.triangles[u][(g % 3 + 2) % 3];
  s.triangles[t] = {a, d, c};
  s.triangles[u] = {d, b, c};
  return s;
}

TEST(FacetLaws, AFlipInsideAFacetKeepsItsOutlineAndOneAcrossDoesNot) {
  const Surface s = box({0, 0, 0}, {1, 1, 1});
  const std::vector<std::uint32_t> face = {0, 1};
  int inside = 0;
  for (std::uint32_t h = 0; h < 3; ++h) {
    const bool within = MeasuredSurface(s).opposite()[h] / 3 == 1;
    inside += within ? 1 : 0;
    const Changed changed(s, flipped(s, h));
    EXPECT_EQ(keeps_outline(changed.surface(), face), within) << h;
  }
  EXPECT_EQ(inside, 1);
  // Only the corners: an inner one that no triangle has any more.
  const Surface fine = box({0, 0, 0}, {1, 1, 1}, 2);
  Surface without = fine;
  for (std::uint32_t t = 0; t < 8; ++t) {
    for (VertexId& v : without.triangles[t]) {
      if (fine.vertices[v] == Point{0, 0.5, 0.5}) v = fine.triangles[0][0];
    }
  }
  const std::vector<std::uint32_t> first = {0, 1, 2, 3, 4, 5, 6, 7};
  const std::vector<std::uint32_t> same = MeasuredSurface(fine).opposite();
  EXPECT_TRUE(keeps_outline({fine, same, fine.triangles, same}, first));
  EXPECT_FALSE(keeps_outline({fine, same, without.triangles, same}, first));
  // Only the sides: a triangle turned round.
  Surface turned = fine;
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);
  EXPECT_FALSE(keeps_outline({fine, same, turned.triangles, same}, first));
}

// A prism over the triangle (0, 0), (4, -3), (4, 3), whose side along (4, 3) is given bent
// outwards: its normal is (-3, 4, 0) / 5, exactly, so a corner moved by (-3, 4, 0) k is at 5 |k|.
TEST(FacetLaws, ACornerAtTheBoundIsNearAndOneBeyondIsFar) {
  Surface flat;
  flat.vertices = {{0, 0, 0}, {4, -3, 0}, {4, 3, 0}, {0, 0, 1}, {4, -3, 1}, {4, 3, 1}};
  flat.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                    {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
  const std::vector<std::uint32_t> side = {6, 7};
  for (const double k : {0x1p-30, -0x1p-30}) {
    Surface given = flat;
    given.vertices[5][0] -= 3 * k;
    given.vertices[5][1] += 4 * k;
    Changed changed(given, flat);
    const double height = 5 * std::fabs(k);
    const auto far = [&](double bound) {
      return far_from_plane(changed.surface(), side, bound, changed.points);
    };
    EXPECT_EQ(far(height), std::vector<std::uint32_t>{});
    EXPECT_EQ(far(std::nextafter(height, 0)), std::vector<std::uint32_t>{7});
    EXPECT_EQ(far(0), std::vector<std::uint32_t>{7});
    EXPECT_EQ(changed.points.size(), 6U);
  }
}

}  // namespace
}  // namespace delmesher::planar
