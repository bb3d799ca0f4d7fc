#include "mesher/policies/as_given.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mesher/cdt/cdt_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/geometry/vector.h"
#include "mesher/policies/planes.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::policies {
namespace {

using namespace predicates;  // NOLINT(google-build-using-namespace)
using surface::test_surfaces::in_single_precision;
using surface::test_surfaces::rotated;

Options as_it_is() {
  Options options;
  options.planar = 0;
  return options;
}

// A mesh of the stand-in of a surface, with further points.
struct Case {
  explicit Case(const Surface& surface) {
    const ValidityResult validity = check_validity(surface, true, control);
    EXPECT_TRUE(validity.report.status.ok());
    session.diagonal = validity.report.bbox_diagonal;
    enter_surface(surface, validity, Planes::while_refined, session);
    EXPECT_FALSE(session.given.empty());
    input.topology = &session.topology;
    input.on_edge.resize(session.topology.edge_count());
    input.on_facet.resize(session.topology.facet_triangles.size());
    for (VertexId v = 0; v < session.given.size(); ++v) input.vertices.push_back(v);
  }
  cdt::CdtResult mesh() {
    return cdt::constrained_delaunay_tetrahedrization(input, session.points, session.predicates,
                                                      control);
  }

  void put_points_everywhere() {
    put_on_edges();
    put_in_facets();
    put_in_volume();
  }
  void put_on_edges() {
    const SurfaceTopology& s = session.topology;
    for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
      if (s.edge_is_flat[e] != 0) continue;
      const auto [a, b] = s.edge_vertices(e);
      const VertexId v = session.points.add_on_segment(a, b, 0.375);
      input.on_edge[e].push_back(v);
      input.vertices.push_back(v);
    }
  }
  // In the middle of every triangle, and near to its first edge.
  void put_in_facets() {
    const SurfaceTopology& s = session.topology;
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      const auto& [a, b, c] = s.triangles[t];
      for (const double u : {0.25, 0.4375}) {
        const VertexId v = session.points.add_on_triangle(a, b, c, u, 0.5);
        input.on_facet[s.facet_of[t]].push_back(v);
        input.vertices.push_back(v);
      }
    }
  }
  // Below the middle of every triangle, some so near that the surface as given may be beyond them.
  void put_in_volume() {
    const SurfaceTopology& s = session.topology;
    double depth = 0x1p-60;
    for (const auto& [a, b, c] : s.triangles) {
      const Vec3 p = session.points.nearest(a), u = subtract(session.points.nearest(b), p),
                 v = subtract(session.points.nearest(c), p), n = cross(u, v);
      const Vec3 x = add_scaled(add_scaled(add_scaled(p, 0.3, u), 0.4, v),
                                -depth * session.diagonal / norm(n), n);
      input.vertices.push_back(session.points.add_explicit(x[0], x[1], x[2]));
      depth = depth > 0x1p-10 ? 0x1p-60 : depth * 0x1p+8;
    }
  }

  std::string wrong(const cdt::CdtResult& result) {
    return cdt::rational::Checker(session.topology, session.points, result).run();
  }
  std::size_t vertices(const cdt::CdtResult& result) const {
    std::set<VertexId> used;
    for (const auto& t : result.mesh.tetrahedra) used.insert(t.begin(), t.end());
    return used.size();
  }

  Options options = as_it_is();
  Control control{options};
  Session session{options, control};
  cdt::CdtInput input;
};

std::vector<Surface> surfaces() {
  using namespace cdt::test_models;
  const Surface plate = perforated_plate(5, 0.25, 2), fans = twisted_prism(9, 0, 0.1, false);
  return {rotated(plate), in_single_precision(rotated(plate)), rotated(fans),
          in_single_precision(rotated(fans))};
}

TEST(AsGiven, IsTetrahedrizedWithTheVerticesOfTheStandIn) {
  for (const Surface& surface : surfaces()) {
    Case c(surface);
    c.put_points_everywhere();
    const std::size_t facets = c.session.topology.facet_triangles.size();
    const cdt::CdtResult mesh = c.mesh(), anew = tetrahedrize_as_given(mesh.mesh, c.session);
    EXPECT_EQ(c.wrong(anew), "");
    EXPECT_GT(c.session.topology.facet_triangles.size(), facets);
    EXPECT_TRUE(c.session.given.empty());
    for (VertexId v = 0; v < surface.vertices.size(); ++v) {
      EXPECT_EQ(c.session.points.nearest(v), surface.vertices[v]);
    }
    EXPECT_GT(c.vertices(anew), c.vertices(mesh) * 3 / 4);
  }
}

// A point beside an edge that comes back is put on it.
TEST(AsGiven, PointsNearReturningEdgesAreOnThem) {
  Case c(surfaces().front());
  c.put_points_everywhere();
  const cdt::CdtResult mesh = c.mesh();
  const std::size_t before = c.session.points.size();
  tetrahedrize_as_given(mesh.mesh, c.session);
  std::size_t on_edges = 0;
  for (auto v = static_cast<VertexId>(before); v < c.session.points.size(); ++v) {
    on_edges += c.session.points.definition(v).kind == PointKind::on_segment;
  }
  EXPECT_GT(on_edges, 10U);
}

// In the volume beside the stand-in, but on the surface as given: in the middle of edges, which is
// a double where their ends are single.
TEST(AsGiven, PointsThatTheSurfaceComesUponAreLeftOut) {
  Case c(surfaces()[1]);
  const SurfaceTopology& s = c.session.topology;
  std::size_t added = 0;
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    if (s.edge_is_flat[e] == 0) continue;
    const auto [a, b] = s.edge_vertices(e);
    Vec3 x = c.session.given[a];
    for (std::size_t k = 0; k < 3; ++k) x[k] = (x[k] + c.session.given[b][k]) / 2;
    const VertexId v = c.session.points.add_explicit(x[0], x[1], x[2]);
    const auto& [p, q, r] = s.triangles[s.edge_half_edges(e)[0] / 3];
    if (c.session.predicates.orient3d(p, q, r, v) == 0) continue;  // nothing moves there
    c.input.vertices.push_back(v);
    ++added;
  }
  EXPECT_GT(added, 10U);
  EXPECT_EQ(c.wrong(tetrahedrize_as_given(c.mesh().mesh, c.session)), "");
}

// In a facet, nearer to an edge that stays than a point of another triangle can be placed: the
// triangle to which it is given, a b c, is the other half of a square.
TEST(AsGiven, PointsThatComeUponAnEdgeAreLeftOut) {
  Case c(rotated(surface::test_surfaces::box({0, 0, 0}, {1, 1, 1})));
  const SurfaceTopology& s = c.session.topology;
  std::size_t added = 0;
  for (std::uint32_t h = 0; h < 3 * s.triangles.size(); ++h) {
    if (s.edge_is_flat[s.edge_of[h]] == 0) continue;
    const VertexId a = s.to(h), b = s.to(SurfaceTopology::next(h)), d = s.from(h);
    const VertexId v = c.session.points.add_on_triangle(a, b, d, 0.5, -0.5 + 0x1p-44);
    c.input.on_facet[s.facet_of[h / 3]].push_back(v);
    c.input.vertices.push_back(v);
    ++added;
  }
  EXPECT_EQ(added, 12U);
  EXPECT_EQ(c.wrong(tetrahedrize_as_given(c.mesh().mesh, c.session)), "");
}

}  // namespace
}  // namespace delmesher::policies
