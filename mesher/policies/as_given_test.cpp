#include "mesher/policies/as_given.h"

#include <gtest/gtest.h>

#include <set>

#include "mesher/cdt/cdt_reference.h"
#include "mesher/cdt/test_models.h"
#include "mesher/surface/test_surfaces.h"

namespace delmesher::policies {
namespace {

using namespace predicates;  // NOLINT(google-build-using-namespace)
using surface::test_surfaces::in_single_precision;
using surface::test_surfaces::rotated;

// The planarized surface of a surface, with points to mesh it with.
struct Case {
  explicit Case(const Surface& surface) {
    options.planar = 0;
    const ValidityResult validity = check_validity(surface, true, control);
    session.diagonal = validity.report.bbox_diagonal;
    enter_surface(surface, validity, Planes::while_refined, session);
    EXPECT_TRUE(session.surface.is_planarized());
    input.topology = &topology();
    input.on_edge.resize(topology().edge_count());
    input.on_facet.resize(topology().facet_triangles.size());
    for (VertexId v = 0; v < session.input_vertices(); ++v) input.vertices.push_back(v);
  }
  const SurfaceTopology& topology() const { return session.surface.topology(); }

  void put_on_edges() {
    for (std::uint32_t e = 0; e < topology().edge_count(); ++e) {
      if (topology().edge_is_flat[e] != 0) continue;
      const auto [a, b] = topology().edge_vertices(e);
      input.on_edge[e].push_back(session.points.add_on_segment(a, b, 0.375));
      input.vertices.push_back(input.on_edge[e].back());
    }
  }
  void put_in_facets() {
    for (std::uint32_t t = 0; t < topology().triangles.size(); ++t) {
      const auto& [a, b, c] = topology().triangles[t];
      const VertexId v = session.points.add_on_triangle(a, b, c, 0.25, 0.5);
      input.on_facet[topology().facet_of[t]].push_back(v);
      input.vertices.push_back(v);
    }
  }
  void put_in_volume(const Vec3& x) {
    input.vertices.push_back(session.points.add_explicit(x[0], x[1], x[2]));
  }

  ConformingMesh mesh() {
    return cdt::constrained_delaunay_tetrahedrization(input, session.points, session.predicates,
                                                      control)
        .mesh;
  }
  // By rational arithmetic: which law of a constrained tetrahedrization of the surface is broken.
  std::string wrong(const cdt::CdtResult& result) const {
    return cdt::rational::Checker(topology(), session.points, result).run();
  }

  Options options;
  Control control{options};
  Session session{options, control};
  cdt::CdtInput input;
};

std::set<VertexId> vertices_of(const ConformingMesh& mesh) {
  std::set<VertexId> used;
  for (const auto& t : mesh.tetrahedra) used.insert(t.begin(), t.end());
  return used;
}

std::vector<Surface> surfaces() {
  using namespace cdt::test_models;
  const Surface plate = perforated_plate(5, 0.25, 2), fans = twisted_prism(9, 0, 0.1, false);
  return {rotated(plate), in_single_precision(rotated(plate)), rotated(fans),
          in_single_precision(rotated(fans))};
}

TEST(AsGiven, IsTetrahedrizedWithThePointsOnEdgesAndInTheVolume) {
  for (const Surface& surface : surfaces()) {
    Case c(surface);
    c.put_on_edges();
    for (int n = 0; n < 8; ++n) {
      const auto side = [&](int axis) { return ((n >> axis) & 1) != 0 ? 100.0 : -100.0; };
      c.put_in_volume({side(0), side(1), side(2)});
    }
    const std::vector<VertexId> kept = c.input.vertices;
    c.put_in_facets();
    const std::size_t facets = c.topology().facet_triangles.size();
    const cdt::CdtResult again = tetrahedrize_as_given(c.mesh(), as_given(c.session), c.session);
    EXPECT_EQ(c.wrong(again), "");
    EXPECT_GT(c.topology().facet_triangles.size(), facets);
    EXPECT_FALSE(c.session.surface.is_planarized());
    for (VertexId v = 0; v < surface.vertices.size(); ++v) {
      EXPECT_EQ(c.session.points.nearest(v), surface.vertices[v]);
    }
    std::set<VertexId> expected(kept.begin(), kept.end());
    expected.insert(again.steiner.begin(), again.steiner.end());
    EXPECT_EQ(vertices_of(again.mesh), expected);
  }
}

// In the volume beside the planarized surface, but on the surface as given: in the middle of edges,
// which is a double where their ends are single.
TEST(AsGiven, PointsThatTheSurfaceComesUponAreLeftOut) {
  Case c(surfaces()[1]);
  const SurfaceTopology& s = c.topology();
  std::size_t added = 0;
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    if (s.edge_is_flat[e] == 0) continue;
    const auto [a, b] = s.edge_vertices(e);
    Vec3 x = c.session.surface.given_vertices()[a];
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = (x[k] + c.session.surface.given_vertices()[b][k]) / 2;
    const auto& [p, q, r] = s.triangles[s.edge_half_edges(e)[0] / 3];
    c.put_in_volume(x);
    if (c.session.predicates.orient3d(p, q, r, c.input.vertices.back()) == 0) {
      c.input.vertices.pop_back();  // nothing moves there
    } else {
      ++added;
    }
  }
  EXPECT_GT(added, 10U);
  EXPECT_EQ(c.wrong(tetrahedrize_as_given(c.mesh(), as_given(c.session), c.session)), "");
}

}  // namespace
}  // namespace delmesher::policies
