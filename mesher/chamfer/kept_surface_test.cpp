// The kept part of a surface, with distances in it, and the removed part.
#include "mesher/chamfer/kept_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesher/chamfer/boundary_distance.h"
#include "mesher/chamfer/removed_surface.h"
#include "mesher/chamfer/test_model.h"
#include "mesher/chamfer/test_polyhedra.h"
#include "mesher/planar/planarized_surface.h"
#include "mesher/predicates/rational_reference.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::chamfer {
namespace {

// Edges that touch an edge of a unit square count by their far ends only: the opposite edge is
// nearest to the middle half of it, an edge beside it would be as near as a quarter.
TEST(BoundaryDistance, EdgesAtEitherEndOfAPartCountByTheirFarEnds) {
  Model model(test_polyhedra::prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1));
  const KeptSurface surface(model.topology, model.points, {});
  BoundaryDistance distance(surface);
  for (const Corner& corner : surface.corners()) {
    const std::uint32_t edge = model.topology.edge_of[corner.outgoing];
    const auto [v, w] = model.topology.edge_vertices(edge);
    const Vec3 from = surface.position(v), along = surface.edge_vector(v, w);
    const std::array<Vec3, 2> part = {add_scaled(from, 0.25, along), add_scaled(from, 0.75, along)};
    EXPECT_EQ(distance.from_edge_part(corner.facet, edge, part), surface.scale());
  }
}

// The reciprocal of subnormal coordinates is not a double.
TEST(KeptSurface, IsScaledByNormalNumbers) {
  for (const double factor : {0x1p-1060, 0x1p-500, 1.0, 0x1p1000}) {
    const Surface given =
        test_polyhedra::scaled(test_polyhedra::prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1), factor);
    Model model(given);
    const KeptSurface surface(model.topology, model.points, {});
    EXPECT_TRUE(std::isnormal(surface.scale())) << factor;
    EXPECT_TRUE(std::isnormal(1 / surface.scale())) << factor;
    for (VertexId v = 0; v < surface.vertex_count(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LE(std::fabs(surface.position(v)[axis]), 1);
        EXPECT_EQ(surface.position(v)[axis] / surface.scale(), given.vertices[v][axis]);
      }
    }
  }
}

// A box of 1e-5, 8818 from the origin: doubles are 2^-39 apart there, and the vertices of flattened
// faces lie between them. Distances on the surface have more digits than that would leave.
TEST(KeptSurface, FarFromTheOriginDistancesKeepTheirDigits) {
  Surface box = surface::test_surfaces::rotated(
      test_polyhedra::scaled(test_polyhedra::prism({{0, 0}, {3, 0}, {3, 2}, {0, 2}}, 2), 1e-5 / 3));
  for (Vec3& p : box.vertices) {
    for (double& x : p) x += 8818;
  }
  Limits limits;
  Control control(limits);
  const planar::PlanarizedSurface planarized = planar::planarize(box, 1e-9, control);
  PointStore points;
  Predicates predicates(points);
  const SurfaceTopology topology = planar::planarized_topology(box, planarized, points, predicates);
  ASSERT_EQ(topology.facet_triangles.size(), 6U);
  const KeptSurface surface(topology, points, {});
  std::size_t implicit = 0;
  for (VertexId v = 1; v < points.size(); ++v) {
    if (!points.is_explicit(v)) ++implicit;
    using namespace predicates::reference;
    const Point d = minus(point(points, v), point(points, 0));
    const double squared = mpq_class(dot(d, d)).get_d();
    const double measured =
        squared_norm(surface.edge_vector(0, v)) / surface.scale() / surface.scale();
    EXPECT_NEAR(measured / squared, 1, 0x1p-40);
  }
  EXPECT_GE(implicit, 4U);
}

// One facet of a box was dropped: points near the middle of one of its triangles are too near,
// points near another facet are not.
TEST(RemovedSurface, IsTheDroppedFacetsAndNothingElse) {
  Model model(surface::test_surfaces::box({0, 0, 0}, {1, 1, 1}));
  const ChamferResult result = model.run(untouched());
  for (FacetId f = 0; f < 6; ++f) {
    std::vector<std::uint8_t> kept(6, 1);
    kept[f] = 0;
    const RemovedSurface removed(result, kept, model.topology, model.points);
    const RemovedSurface nothing(result, {}, model.topology, model.points);
    for (std::uint32_t t = 0; t < model.topology.triangles.size(); ++t) {
      Vec3 middle = {0, 0, 0};
      for (const VertexId v : model.topology.triangles[t]) {
        for (int k = 0; k < 3; ++k) middle[k] += model.points.nearest(v)[k] / 3;
      }
      EXPECT_EQ(removed.too_near(middle, 0.5), model.topology.facet_of[t] == f) << t;
      EXPECT_FALSE(nothing.too_near(middle, 0.5));
    }
  }
}

}  // namespace
}  // namespace delmesher::chamfer
