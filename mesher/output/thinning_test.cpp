#include "mesher/output/thinning.h"

#include <gtest/gtest.h>

#include <map>

#include "mesher/cdt/test_model.h"
#include "mesher/cdt/test_models.h"

namespace delmesher {
namespace {

using namespace test_models;

std::size_t input_vertices(const Model& model) {
  return model.topology.vertex_half_edge.size();
}

std::size_t thin(Model& model, std::span<const VertexId> around, int rings, CdtResult& mesh) {
  return thin_out(around, rings, input_vertices(model), model.points, model.predicates,
                  model.control, mesh);
}

std::set<VertexId> vertices(const CdtResult& mesh) {
  std::set<VertexId> used;
  for (const auto& t : mesh.tetrahedra) used.insert(t.begin(), t.end());
  return used;
}

// Six times the volume of all tetrahedra, exactly.
mpq_class volume(const Model& model, const CdtResult& mesh) {
  mpq_class sum = 0;
  for (const auto& t : mesh.tetrahedra) {
    rational::Vector x[4];
    for (int i = 0; i < 4; ++i) x[i] = rational::exact(model.points, t[i]);
    sum += rational::volume(x[0], x[1], x[2], x[3]);
  }
  return sum;
}

std::string wrong(const Model& model, const CdtResult& mesh) {
  return rational::Checker(model.topology, model.points, mesh, false).run();
}

// What is left conforms as before and fills the same hull, whatever has gone.
TEST(Thinning, KeepsTheSurfaceAndTheHull) {
  Surface labelled =
      voxels({{{0, 1, 2, 3}, {0, 1, 2}, {0, 0.5}}}, [](int, int, int) { return true; });
  for (std::size_t t = 0; t < labelled.triangles.size(); ++t) {
    labelled.labels.push_back(labelled.vertices[labelled.triangles[t][0]][0] < 2 ? 1 : 0);
  }
  Surface nested = box(0, 8);
  append(nested, inside_out(box(1, 7)));
  std::uint32_t seed = 1;
  for (const Surface& s : {box(0, 1), perforated_plate(5, 0.25, 2), star(1, 0.1, 5),
                           chazelle(2, 0.5), twisted_prism(5, 0.1, 1, true), labelled, nested}) {
    for (const int density : {1, 3}) {
      Model model(s);
      ASSERT_TRUE(model.valid);
      enrich(model, density, seed++);
      CdtResult mesh = model.run();
      const mpq_class hull = volume(model, mesh);
      const std::set<VertexId> before = vertices(mesh);
      const std::vector<VertexId> all(before.begin(), before.end());
      const std::size_t gone = thin(model, all, 0, mesh);
      EXPECT_EQ(wrong(model, mesh), "");
      EXPECT_EQ(volume(model, mesh), hull);
      const std::set<VertexId> after = vertices(mesh);
      EXPECT_EQ(after.size() + gone, before.size());
      // Most of what enriched the mesh can go; the input's vertices stay.
      EXPECT_LT(2 * after.size(), before.size() + input_vertices(model));
      for (VertexId v = 0; v < input_vertices(model); ++v) EXPECT_TRUE(after.contains(v)) << v;
    }
  }
}

// Without a box around, the hull is the surface's own.
TEST(Thinning, KeepsAHullThatIsTheSurface) {
  Model model(box(0, 1));
  ASSERT_TRUE(model.valid);
  model.input.on_edge.resize(model.topology.edge_count());
  for (std::uint32_t e = 0; e < model.topology.edge_count(); ++e) {
    if (model.topology.edge_is_flat[e] != 0) continue;
    const auto end = model.topology.edge_vertices(e);
    const VertexId v = model.points.add_on_segment(end[0], end[1], 0.5);
    const auto h = model.topology.edge_half_edges(e);
    std::vector<PlaneId> planes;
    for (const auto side : h) {
      planes.push_back(model.topology.facet_plane[model.topology.facet_of_half_edge(side)]);
    }
    std::sort(planes.begin(), planes.end());
    model.points.set_supports(v, planes, {&e, 1});
    model.input.on_edge[e] = {v};
    model.input.vertices.push_back(v);
  }
  CdtResult mesh = model.run();
  const std::set<VertexId> before = vertices(mesh);
  const std::vector<VertexId> all(before.begin(), before.end());
  EXPECT_GT(thin(model, all, 0, mesh), 0U);
  EXPECT_EQ(wrong(model, mesh), "");
  EXPECT_EQ(volume(model, mesh), 6);
}

// Schoenhardt's polyhedron cannot be tetrahedrized without further vertices.
TEST(Thinning, LeavesWhatIsNeeded) {
  Model model(twisted_prism(3, 0.5, 1, true));
  ASSERT_TRUE(model.valid);
  enrich(model, 2, 1);
  CdtResult mesh = model.run();
  const std::set<VertexId> before = vertices(mesh);
  const std::vector<VertexId> all(before.begin(), before.end());
  EXPECT_GT(thin(model, all, 0, mesh), 0U);
  EXPECT_EQ(wrong(model, mesh), "");
  std::set<VertexId> inside;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.inside[t] != 0) inside.insert(mesh.tetrahedra[t].begin(), mesh.tetrahedra[t].end());
  }
  EXPECT_GT(inside.size(), 6U);
}

TEST(Thinning, ReachesAsFarAsItIsTold) {
  Model model(box(0, 1));
  ASSERT_TRUE(model.valid);
  enrich(model, 3, 7);
  const CdtResult given = model.run();
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
    CdtResult mesh = given;
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
}  // namespace delmesher
