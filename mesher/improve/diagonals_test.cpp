#include "mesher/improve/diagonals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/geometry/placement.h"
#include "mesher/planar/flatness.h"
#include "mesher/planar/planarized_surface.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::improve {
namespace {

using cdt::test_models::Model;
using surface::test_surfaces::ellipse;
using surface::test_surfaces::in_single_precision;
using surface::test_surfaces::prism;
using surface::test_surfaces::rotated;

SurfaceTopology planarized(const Surface& s, PointStore& points, Predicates& predicates) {
  Limits limits;
  Control control{limits};
  const double bound = 2 * planar::flatness(s, control);
  return planar::planarized_topology(
      s, planar::planarize(s, bound, control, planar::Retriangulate::no), points, predicates);
}

// A mesh of the planarized surface of a surface, with points of all kinds.
struct Case {
  Case(const Surface& surface, int density, std::uint32_t seed) : model(surface, planarized) {
    EXPECT_TRUE(model.valid);
    if (density > 0) cdt::test_models::enrich(model, density, seed);
    mesh = model.run().mesh;
    given_points = std::make_unique<PointStore>();
    Predicates predicates(*given_points);
    as_given = build_topology(model.surface, *given_points, predicates);
  }

  DiagonalsResult enter(const std::function<void(ConformingMesh&)>& change = {}) {
    const ImproveOptions options{.region = Region::hull};
    ImproveResult improved = improve(mesh, &model.topology, model.surface.vertices, options,
                                     model.points, model.predicates, model.control);
    if (change) change(improved.mesh);
    DiagonalsResult entered =
        enter_diagonals(std::move(improved.mesh), model.topology, as_given, model.surface.vertices,
                        options, model.points, model.predicates, model.control);
    mesh = entered.mesh;
    return entered;
  }
  // What is wrong with it as a mesh of the surface as given, by rational arithmetic.
  std::string wrong() {
    PointStore& points = *given_points;
    for (auto v = static_cast<VertexId>(points.size()); v < model.points.size(); ++v) {
      const Vec3 x = model.points.nearest(v);
      if (model.points.is_explicit(v)) {
        points.add_explicit(x[0], x[1], x[2]);
      } else {
        points.add(model.points.definition(v));
      }
    }
    return cdt::rational::Checker(as_given, points, mesh).run();
  }

  Model model;
  ConformingMesh mesh;
  std::unique_ptr<PointStore> given_points;
  SurfaceTopology as_given;
};

std::vector<Surface> surfaces() {
  using namespace cdt::test_models;
  const Surface plate = perforated_plate(5, 0.25, 2), star_shaped = star(1, 0.1, 5);
  const Surface steps = voxels({{{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 0.5, 1, 3}}},
                               [](int i, int j, int k) { return k <= i || j == 1; });
  return {rotated(plate), in_single_precision(rotated(plate)), rotated(star_shaped), rotated(steps),
          in_single_precision(rotated(steps))};
}

TEST(Diagonals, TheMeshConformsToTheSurfaceAsGiven) {
  std::uint64_t diagonals = 0;
  for (const Surface& surface : surfaces()) {
    for (const int density : {0, 1, 3}) {
      Case c(surface, density, 7);
      const DiagonalsResult entered = c.enter();
      EXPECT_EQ(entered.missing, 0U);
      EXPECT_EQ(c.wrong(), "");
      diagonals += entered.diagonals;
    }
  }
  EXPECT_GT(diagonals, 100U);
}

// Without them it does not.
TEST(Diagonals, AreMissedWhereTheyAreNotEntered) {
  Case c(surfaces().front(), 1, 7);
  EXPECT_NE(c.wrong(), "");
}

// At one edge across, the four vertices of a tetrahedron are within 1e-9 of a plane.
TEST(Diagonals, RoomIsMadeBetweenNeedles) {
  Case c(in_single_precision(rotated(prism(ellipse(60), 0.1))), 6, 3);
  EXPECT_EQ(c.enter().missing, 0U);
  EXPECT_EQ(c.wrong(), "");
}

// A triangle of the facet of the planarized surface that is another one as given than the point's
// own.
std::uint32_t other_triangle(const Case& c, const PointDefinition& d, FacetId facet) {
  const std::vector<std::uint32_t>& triangles = c.model.topology.facet_triangles[facet];
  const auto own = std::ranges::find_if(triangles, [&](std::uint32_t t) {
    return std::ranges::is_permutation(c.model.topology.triangles[t], d.corner);
  });
  if (own == triangles.end()) return kNone;
  const auto other = std::ranges::find_if(triangles, [&](std::uint32_t t) {
    return c.as_given.facet_of[t] != c.as_given.facet_of[*own];
  });
  return other == triangles.end() ? kNone : *other;
}

// Puts points in the place of the mesh's that are given by such triangles. How many?
std::uint64_t give_by_other_triangles(Case& c, ConformingMesh& mesh) {
  std::map<VertexId, VertexId> became;
  PointStore& points = c.model.points;
  for (const SurfaceFace& face : mesh.boundary) {
    for (const VertexId v : face.vertices) {
      const PointDefinition d = points.definition(v);
      if (d.kind != PointKind::on_triangle || became.contains(v)) continue;
      const std::uint32_t t = other_triangle(c, d, face.facet);
      if (t == kNone) continue;
      const auto& [p, q, r] = c.model.topology.triangles[t];
      const std::vector<PlaneId> planes(points.planes(v).begin(), points.planes(v).end());
      became[v] = points.add(place_on_triangle(points, p, q, r, points.nearest(v), 1e-12));
      points.set_supports(became[v], planes, {});
    }
  }
  const auto follow = [&](auto& list) {
    for (VertexId& v : list) {
      if (became.contains(v)) v = became[v];
    }
  };
  for (Tet& t : mesh.tetrahedra) follow(t);
  for (SurfaceFace& face : mesh.boundary) follow(face.vertices);
  return became.size();
}

// Placed to a tolerance, a point may lie beyond the edge of the triangle that gives it. As given it
// would be off the facet.
TEST(Diagonals, PointsGivenByOtherFacetsArePlacedAnew) {
  std::uint64_t changed = 0;
  for (const Surface& surface : surfaces()) {
    Case c(surface, 3, 7);
    const DiagonalsResult entered =
        c.enter([&](ConformingMesh& mesh) { changed += give_by_other_triangles(c, mesh); });
    EXPECT_EQ(entered.missing, 0U);
    EXPECT_EQ(c.wrong(), "");
  }
  EXPECT_GT(changed, 20U);
}

// Points that were moved or are new lie on the diagonals themselves.
TEST(Diagonals, NewPointsAreOnSegments) {
  Case c(surfaces().front(), 3, 7);
  const std::size_t before = c.model.points.size();
  c.enter();
  std::set<VertexId> used;
  for (const SurfaceFace& face : c.mesh.boundary) {
    used.insert(face.vertices.begin(), face.vertices.end());
  }
  std::uint64_t on_segments = 0;
  for (const VertexId v : used) {
    if (v < before) continue;
    on_segments += c.model.points.definition(v).kind == PointKind::on_segment;
  }
  EXPECT_GT(on_segments, 0U);
}

}  // namespace
}  // namespace delmesher::improve
