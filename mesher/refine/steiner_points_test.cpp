#include "mesher/refine/steiner_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/geometry/placement.h"
#include "mesher/geometry/vector.h"
#include "mesher/predicates/polynomials.h"
#include "mesher/refine/test_complexes.h"
#include "mesher/refine/tetrahedron_shape.h"

namespace delmesher::refine {
namespace {

struct Placing : Complex {
  RefineOptions options;
  SegmentFacets segment_facets{plc()};

  explicit Placing(const Surface& surface) : Complex(surface) {}
  SteinerPoints steiner() { return {plc(), segment_facets, topology, points, predicates, options}; }
};

TEST(SegmentFacets, TwoPerSegmentOfASurfaceAndOfTheBox) {
  const Complex complex(box());
  const SegmentFacets facets(complex.plc());
  for (std::uint32_t s = 0; s < complex.plc().segments.size(); ++s) {
    ASSERT_EQ(facets.count(s), 2);
    EXPECT_LT(facets.of(s)[0], facets.of(s)[1]);
    for (const std::uint32_t f : facets.of(s)) {
      EXPECT_TRUE(std::ranges::any_of(complex.plc().facets[f].boundary,
                                      [&](const auto& side) { return side.segment == s; }));
    }
  }
}

TEST(SegmentFacets, ThreeOfOneSegmentAreRefused) {
  Plc plc;
  plc.segments.push_back({{0, 1}});
  plc.facets.resize(3);
  for (PlcFacet& f : plc.facets) f.boundary.push_back({0, false});
  EXPECT_THROW(SegmentFacets{plc}, InternalError);
  plc.facets.resize(1);
  EXPECT_EQ(SegmentFacets(plc).count(0), 1);
}

// Generation by generation, exactly on the line and strictly inside, near the middle.
TEST(SteinerPoints, SubsegmentsAreSplitOnTheirLine) {
  for (const Surface& surface : {box(), tent(), wedge()}) {
    Placing p(surface);
    SteinerPoints steiner = p.steiner();
    const std::size_t corners = p.points.size();
    std::size_t artificial = 0;
    for (std::uint32_t s = 0; s < p.plc().segments.size(); ++s) {
      const PlcSegment& segment = p.plc().segments[s];
      const VertexId a = segment.vertex[0];
      VertexId b = segment.vertex[1];
      const auto [facet, other] = p.segment_facets.of(s);
      const bool on_line =
          segment.input_edge != kNone || p.plc().facets[facet].input_facet == kNone;
      artificial += on_line ? 0 : 1;
      for (int generation = 0; generation < 5; ++generation) {
        const double length = distance(p.points.nearest(a), p.points.nearest(b));
        const VertexId v = steiner.on_segment(s, a, b);
        EXPECT_LT(p.predicates.dot_sign(a, v, b), 0);
        EXPECT_NEAR(distance(p.points.nearest(a), p.points.nearest(v)), length / 2, length / 200);
        // In the planes of all facets there if on the line, in that of its facet at least.
        for (const std::uint32_t f : {facet, on_line ? other : facet}) {
          const auto& frame = p.plc().facets[f].frame;
          EXPECT_EQ(p.predicates.orient3d(frame[0], frame[1], frame[2], v), 0);
        }
        b = v;
      }
    }
    EXPECT_EQ(p.points.size(), corners + 5 * p.plc().segments.size());
    EXPECT_EQ(artificial > 0, p.chamfered.acute_vertices > 0);
  }
}

TEST(SteinerPoints, FacetsAreSplitInTheirPlane) {
  Placing p(box());
  SteinerPoints steiner = p.steiner();
  for (std::uint32_t f = 0; f < p.plc().facets.size(); ++f) {
    const PlcFacet& facet = p.plc().facets[f];
    const VertexId v = steiner.in_facet(f, facet.frame);
    EXPECT_EQ(p.predicates.orient3d(facet.frame[0], facet.frame[1], facet.frame[2], v), 0);
    const double radius = distance(p.points.nearest(v), p.points.nearest(facet.frame[0]));
    for (const VertexId c : facet.frame) {
      EXPECT_NEAR(distance(p.points.nearest(v), p.points.nearest(c)), radius, radius / 256);
    }
    EXPECT_EQ(p.points.planes(v).size(), 1U);
  }
}

TEST(SteinerPoints, TetrahedraAreSplitInsideTheirCircumball) {
  Placing p(box());
  SteinerPoints steiner = p.steiner();
  const VertexId flat = p.points.add_explicit(1.5, 0.5, 0);
  const VertexId high = p.points.add_explicit(1.5, 0.5, 0.5);
  const VertexId above = p.points.add_explicit(1.75, 0.5, 40);
  const Goal goal(14, false, 0);
  // Nearly a spire: the off-centre is much nearer than the circumcentre.
  const VertexId tall[4] = {0, 1, 3, above};
  ASSERT_GT(p.predicates.orient3d(tall[0], tall[1], tall[2], tall[3]), 0);
  const VolumeTargets targets = steiner.in_tetrahedron(tall, goal);
  ASSERT_EQ(targets.count, 3U);
  for (std::size_t n = 0; n < targets.count; ++n) {
    const VertexId v = steiner.in_volume(targets.place[n], targets.grid);
    EXPECT_GT(p.predicates.insphere_perturbed(tall[0], tall[1], tall[2], tall[3], v), 0) << n;
    EXPECT_LE(distance(p.points.nearest(v), targets.place[n]), targets.grid);
  }
  const double radius = distance(targets.place[1], p.points.nearest(above));
  for (const VertexId v : tall) {
    EXPECT_NEAR(distance(targets.place[1], p.points.nearest(v)), radius, 1e-9 * radius);
  }
  // Without a volume there is no circumcentre.
  const VertexId coplanar[4] = {0, 1, 2, flat};
  EXPECT_EQ(steiner.in_tetrahedron(coplanar, goal).count, 1U);
  const VertexId well_shaped[4] = {0, 1, 2, high};
  EXPECT_GE(steiner.in_tetrahedron(well_shaped, goal).count, 2U);
}

// The circumcentre relative to the first vertex, in numbers of 64 bits at least.
Vec3 reference_center(const PointStore& points, const std::array<VertexId, 4>& v) {
  using Long = polynomials::Triple<long double>;
  const auto at = [&](int i) {
    const Vec3 p = points.nearest(v[i]);
    return Long{p[0], p[1], p[2]};
  };
  const Long a = at(1) - at(0), b = at(2) - at(0), c = at(3) - at(0);
  const Long bc = cross(b, c), ca = cross(c, a), ab = cross(a, b);
  const long double aa = dot(a, a), bb = dot(b, b), cc = dot(c, c), scale = 2 * dot(a, bc);
  return {static_cast<double>((aa * bc.x + bb * ca.x + cc * ab.x) / scale),
          static_cast<double>((aa * bc.y + bb * ca.y + cc * ab.y) / scale),
          static_cast<double>((aa * bc.z + bb * ca.z + cc * ab.z) / scale)};
}

// The fourth vertex is above a point of the other three's plane, so that the circumcentre is about
// 1 / height away. In doubles it would be computed to about 2^-53 / height^2.
TEST(SteinerPoints, CircumcentresAreCertainOrNone) {
  PointStore points;
  const auto tetrahedron = [&](double height) {
    const Vec3 a = {0.3, 0.7, 0.1}, b = {0.9, -0.2, 0.4};
    return std::array<VertexId, 4>{
        points.add_explicit(0, 0, 0), points.add_explicit(a[0], a[1], a[2]),
        points.add_explicit(b[0], b[1], b[2]),
        points.add_explicit(0.2 * a[0] + 0.3 * b[0] + height, 0.2 * a[1] + 0.3 * b[1] - height,
                            0.2 * a[2] + 0.3 * b[2] + height)};
  };
  constexpr double kGrid = 0x1p-12, kFraction = 0x1p-9;
  for (const double height : {1.0, 0x1p-10, 0x1p-20, 0x1p-24, -0x1p-24, 0x1p-26}) {
    const auto v = tetrahedron(height);
    const auto center = certain_circumcentre(points, v.data(), kGrid, kFraction);
    ASSERT_TRUE(center) << height;
    EXPECT_LE(distance(*center, reference_center(points, v)), kFraction) << height;
    EXPECT_EQ(*center, snap_to_grid(*center, kGrid)) << height;
  }
  // In one plane, or so far away that neighbouring doubles are farther apart than requested.
  const std::array<VertexId, 4> flat = {points.add_explicit(0, 0, 1), points.add_explicit(1, 0, 1),
                                        points.add_explicit(0, 1, 1), points.add_explicit(1, 1, 1)};
  EXPECT_FALSE(certain_circumcentre(points, flat.data(), kGrid, kFraction));
  EXPECT_FALSE(certain_circumcentre(points, tetrahedron(0x1p-50).data(), kGrid, kFraction));
}

TEST(SteinerPoints, TheGuardStopsAtShortEdges) {
  Placing p(box());
  p.options.runaway_length = 1.5;
  SteinerPoints steiner = p.steiner();
  const auto segment_of_length = [&](double length) {
    const auto found = std::ranges::find_if(p.plc().segments, [&](const PlcSegment& s) {
      return distance(p.points.nearest(s.vertex[0]), p.points.nearest(s.vertex[1])) == length;
    });
    return static_cast<std::uint32_t>(found - p.plc().segments.begin());
  };
  const auto split = [&](std::uint32_t s) {
    return steiner.on_segment(s, p.plc().segments[s].vertex[0], p.plc().segments[s].vertex[1]);
  };
  EXPECT_NO_THROW(split(segment_of_length(2)));
  EXPECT_THROW(split(segment_of_length(1)), Runaway);
  const VertexId corner[4] = {0, 1, 3, 4};  // with an edge of length 1
  EXPECT_THROW(steiner.in_tetrahedron(corner, Goal(14, false, 0)), Runaway);
}

}  // namespace
}  // namespace delmesher::refine
