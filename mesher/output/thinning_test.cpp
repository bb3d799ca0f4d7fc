#include "mesher/output/thinning.h"

#include <gtest/gtest.h>

#include <map>

#include "mesher/cdt/model_reference.h"
#include "mesher/cdt/test_models.h"

namespace delmesher::output::thinning_test {

namespace rational = cdt::rational;

namespace {

using namespace cdt::test_models;

std::size_t input_vertices(const Model& model) {
  return model.topology.vertex_half_edge.size();
}

std::size_t thin(Model& model, std::span<const VertexId> around, int rings, ConformingMesh& mesh) {
  return thin_out(around, rings, input_vertices(model), {}, model.points, model.predicates,
                  model.control, mesh);
}

std::string wrong(const Model& model, const ConformingMesh& mesh) {
  return rational::Checker(model.topology, model.points, mesh).run();
}

// The rest conforms as before and fills the same hull, whatever has gone.
TEST(Thinning, KeepsTheSurfaceAndTheHull) {
  std::uint32_t seed = 1;
  for (const Surface& s : one_of_each()) {
    for (const int density : {1, 3}) {
      Model model(s);
      ASSERT_TRUE(model.valid);
      cdt::test_models::enrich(model, density, seed++);
      ConformingMesh mesh = model.run().mesh;
      const mpq_class hull = volume(model.points, mesh);
      const std::set<VertexId> before = vertices(mesh);
      const std::vector<VertexId> all(before.begin(), before.end());
      const std::size_t gone = thin(model, all, 0, mesh);
      EXPECT_EQ(wrong(model, mesh), "");
      EXPECT_EQ(volume(model.points, mesh), hull);
      const std::set<VertexId> after = vertices(mesh);
      EXPECT_EQ(after.size() + gone, before.size());
      // Most of the enriching points can go; the input's vertices stay.
      EXPECT_LT(2 * after.size(), before.size() + input_vertices(model));
      for (VertexId v = 0; v < input_vertices(model); ++v) EXPECT_TRUE(after.contains(v)) << v;
    }
  }
}

// Points on every edge that is not flat, at these parameters from its larger end.
void split_edges(Model& model, std::initializer_list<double> parameters) {
  const SurfaceTopology& s = model.topology;
  model.input.on_edge.resize(s.edge_count());
  for (std::uint32_t e = 0; e < s.edge_count(); ++e) {
    if (s.edge_is_flat[e] != 0) continue;
    const auto end = s.edge_vertices(e);
    for (const double t : parameters) {
      const VertexId v = model.points.add_on_segment(end[1], end[0], t);
      model.points.set_supports(v, s.edge_planes(e), {&e, 1});
      model.input.on_edge[e].push_back(v);
      model.input.vertices.push_back(v);
    }
  }
}

// Without a box around, the hull is the surface's own.
TEST(Thinning, KeepsAHullThatIsTheSurface) {
  Model model(box(0, 1));
  ASSERT_TRUE(model.valid);
  split_edges(model, {0.5});
  ConformingMesh mesh = model.run().mesh;
  const std::set<VertexId> before = vertices(mesh);
  const std::vector<VertexId> all(before.begin(), before.end());
  EXPECT_GT(thin(model, all, 0, mesh), 0U);
  EXPECT_EQ(wrong(model, mesh), "");
  EXPECT_EQ(volume(model.points, mesh), 6);
}

// How many tetrahedra are inverted or flat on nearest doubles.
std::size_t bad_as_written(const Model& model, const ConformingMesh& mesh) {
  return static_cast<std::size_t>(
      std::count_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), [&](const auto& t) {
        rational::Vector x[4];
        for (int i = 0; i < 4; ++i) {
          const Vec3 p = model.points.nearest(t[i]);
          x[i] = {mpq_class(p[0]), mpq_class(p[1]), mpq_class(p[2])};
        }
        return sgn(rational::volume(x[0], x[1], x[2], x[3])) <= 0;
      }));
}

// Points on edges less than an ulp apart.
TEST(Thinning, LeavesNoMoreThatDoublesInvert) {
  Model model(box(1.1, 2.3));
  ASSERT_TRUE(model.valid);
  split_edges(model, {0.3, 0.3 + 0x1p-53, 0.3 + 0x1p-52});
  ConformingMesh mesh = model.run().mesh;
  const std::size_t bad = bad_as_written(model, mesh);
  EXPECT_GT(bad, 0U);  // otherwise the test says nothing
  const std::set<VertexId> before = vertices(mesh);
  const std::vector<VertexId> all(before.begin(), before.end());
  EXPECT_GT(thin(model, all, 0, mesh), 0U);
  EXPECT_EQ(wrong(model, mesh), "");
  EXPECT_LT(bad_as_written(model, mesh), bad);
}

// Schoenhardt's polyhedron cannot be tetrahedrized without further vertices.
TEST(Thinning, LeavesWhatIsNeeded) {
  Model model(twisted_prism(3, 0.5, 1, true));
  ASSERT_TRUE(model.valid);
  cdt::test_models::enrich(model, 2, 1);
  ConformingMesh mesh = model.run().mesh;
  const std::set<VertexId> before = vertices(mesh);
  const std::vector<VertexId> all(before.begin(), before.end());
  EXPECT_GT(thin(model, all, 0, mesh), 0U);
  EXPECT_EQ(wrong(model, mesh), "");
  std::set<VertexId> inside;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.region[t] != kOutside)
      inside.insert(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
  }
  EXPECT_GT(inside.size(), 6U);
}

TEST(Thinning, ReachesAsFarAsItIsTold) {
  Model model(box(0, 1));
  ASSERT_TRUE(model.valid);
  cdt::test_models::enrich(model, 3, 7);
  const ConformingMesh given = model.run().mesh;
  const std::set<VertexId> before = vertices(given);
  std::map<VertexId, int> distance{{0, 0}};  // from the input vertex 0, in edges
  for (int ring = 1; ring <= 2; ++ring) {
    const auto reached = distance;
    for (const auto& t : given.tetrahedra) {
      if (std::none_of(t.begin(), t.end(), [&](VertexId v) { return reached.contains(v); }))
        continue;
      for (const VertexId v : t) distance.try_emplace(v, ring);
    }
  }
  const std::vector<VertexId> around{0};
  for (const int rings : {0, 1, 2}) {
    ConformingMesh mesh = given;
    const std::size_t gone = thin(model, around, rings, mesh);
    EXPECT_EQ(gone > 0, rings > 0);
    const std::set<VertexId> after = vertices(mesh);
    for (const VertexId v : before) {
      const bool near = distance.contains(v) && distance[v] <= rings;
      EXPECT_TRUE(near || after.contains(v)) << v;
    }
    EXPECT_EQ(wrong(model, mesh), "");
  }
}

}  // namespace
}  // namespace delmesher::output::thinning_test
