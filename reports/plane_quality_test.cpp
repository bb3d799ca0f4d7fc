#include "reports/plane_quality.h"

#include <gtest/gtest.h>

#include "reports/made_up_runs.h"
#include "reports/measures.h"
#include "reports/tables.h"

namespace tetproof::plane_quality_test {
namespace {

// A square of two triangles, and one outside of it.
oracles::PlaneFile square() {
  oracles::PlaneFile mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {3, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  mesh.inside = {1, 1, 0};
  return mesh;
}

TEST(PlaneQuality, IsOfTheTrianglesInside) {
  const PlaneQuality quality = measure_plane(square());
  EXPECT_EQ(quality.triangles, 2U);
  EXPECT_EQ(quality.vertices, 4U);
  EXPECT_NEAR(quality.min_angle, 45, 1e-12);
  EXPECT_NEAR(quality.max_angle, 90, 1e-12);
  EXPECT_EQ(quality.area, 1);
  EXPECT_EQ(quality.shortest_edge, 1);
  EXPECT_EQ(quality.inverted + quality.flat + quality.crowded_edges, 0U);
  oracles::PlaneFile all = square();
  all.inside.clear();
  EXPECT_EQ(measure_plane(all).triangles, 3U);
}

TEST(PlaneQuality, CountsWhatIsWrong) {
  oracles::PlaneFile mesh = square();
  mesh.inside.clear();
  mesh.triangles.push_back({0, 2, 1});  // and a third one at its edges
  mesh.triangles.push_back({1, 4, 0});
  const PlaneQuality quality = measure_plane(mesh);
  EXPECT_EQ(quality.inverted, 1U);
  EXPECT_EQ(quality.flat, 1U);
  EXPECT_EQ(quality.crowded_edges, 3U);
  mesh.triangles.push_back({0, 1, 5});
  EXPECT_THROW(measure_plane(mesh), std::runtime_error);
}

RunRow run(const char* mesher, double seconds) {
  RunRow row;
  row.key = {"hash", mesher, "1", "", "wall 1 s"};
  row.model_name = "koch.poly";
  row.disposition = Disposition::ok;
  row.region = "plane";
  row.mesh_seconds = seconds;
  row.mesh_json = to_json(measure_plane(square()));
  row.mesh = mesh_columns(row.mesh_json, "");
  return row;
}

TEST(PlaneTable, ComparesMeshersAndHasNoDihedralAngles) {
  const Selection selection = select_runs({run("plane", 1e-6), run("cgal-mesh2", 4e-6)});
  const Table table = plane_table(selection);
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], "plane");
  EXPECT_EQ(table.rows[0][3], "45.00");
  EXPECT_EQ(table.rows[0][5], "2");
  EXPECT_EQ(table.rows[0][6], "0.50");
  EXPECT_EQ(table.rows[1][7], "4.00");
  const RunRow row = run("plane", 1);
  EXPECT_EQ(of(&RunRow::mesh, &MeshColumns::min_face_angle)(row).has_value(), true);
  EXPECT_FALSE(of(&RunRow::mesh, &MeshColumns::min_dihedral)(row).has_value());
  EXPECT_FALSE(has_data(plane_table(campaign())));
}

}  // namespace
}  // namespace tetproof::plane_quality_test
