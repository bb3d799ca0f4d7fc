#include "mesher/io/exact_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "mesher/io/reading.h"

namespace delmesher::io {
namespace {

ExactRecord sample() {
  using Kind = ExactPoint::Kind;
  ExactRecord r;
  r.points = {{Kind::explicit_point, 0, 0, 0, 0.1, -0.0, 1e-310},
              {Kind::explicit_point, 0, 0, 0, 1e300, 2, 3},
              {Kind::explicit_point, 0, 0, 0, -1, 0, 1},
              {Kind::on_segment, 1, 2, 0, 0.375, 0, 0},
              {Kind::on_triangle, 0, 1, 2, 0.25, 0.5, 0},
              {Kind::on_planes, 1, 0, 1, 0, 0, 0}};
  r.origin = {0x1p33, -0.5, 0};
  r.planes = {{false, {1, 0, -0.5}, {{{1, 2, 3}, {}, {}}}},
              {true, {}, {{{1, 2, 3}, {4, 5, 6}, {7, 8, 0.1}}}}};
  r.triangles = {{0, 1, 2}};
  r.facets = {{0, 7, false, {0, 2, 5}}, {1, -1, true, {}}};
  r.segments = {{false, 0, {0, 3, 1}}, {true, 1, {3, 4}}};
  r.corners = {{2, 0.1}};
  r.parameters = {14.5, 60, 20, 0.25, Region::hull, false, 0.5};
  r.chamfer_points = {{3, 2}};
  r.balls = {{2, {0, 1, 3, 4}}};
  r.unrepaired = {{{4, 2, 3, 1}, false}};
  r.unrepaired_facets = {{0, 2, 4, 0}};
  r.refined = {{{0, 1, 2, 3}, true}, {{0, 1, 2, 4}, false}};
  r.refined_facets = {{0, 1, 2, 0}, {1, 2, 3, 0xffffffffU}};
  r.final = {{{1, 2, 3, 4}, true}};
  r.final_facets = {{0, 1, 4, 1}};
  r.mesh_vertices = {4, 3, 2, 1, 0};
  return r;
}

std::string written(const ExactRecord& record) {
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("delmesher_exact_test_" + std::to_string(getpid()) + ".txt"))
                               .string();
  OutputSet outputs;
  EXPECT_TRUE(write_exact(outputs, path, record).ok());
  EXPECT_TRUE(outputs.commit().ok());
  const std::string text = read_file(path);
  std::filesystem::remove(path);
  return text;
}

TEST(ExactRecord, TextIsAsDocumented) {
  const std::string text = written(sample());
  EXPECT_TRUE(text.starts_with(
      "delmesher-exact 7\nparameters 1\n0x1.dp+3 0x1.ep+5 0x1.4p+4 0x1p-2 1 0 0x1p-1\n"
      "origin 1\n0x1p+33 -0x1p-1 0x0p+0\nplanes 2\nN 0x1p+0 0x0p+0 -0x1p-1 0x1p+0 0x1p+1 0x1.8p+1\n"
      "T 0x1p+0 0x1p+1 0x1.8p+1 0x1p+2 0x1.4p+2 0x1.8p+2 0x1.cp+2 0x1p+3 0x1.999999999999ap-4\n"
      "triangles 1\n0 1 2\npoints 6\nE 0x1.999999999999ap-4 -0x0p+0 "))
      << text;
  EXPECT_NE(
      text.find(
          "S 1 2 0x1.8p-2\nT 0 1 2 0x1p-2 0x1p-1\nP 1 0 1\nfacets 2\n0 7 0 3 0 2 5\n1 -1 1 0\n"
          "segments 2\nI - 3 0 3 1\nA 1 2 3 4\ncorners 1\n2 0x1.9"),
      std::string::npos)
      << text;
  EXPECT_TRUE(
      text.ends_with("final_facets 1\n0 1 4 1\nmesh_vertices 5\n4\n3\n2\n1\n0\n"
                     "chamfer_points 1\n3 2\nballs 1\n2 0 1 3 4 \nunrepaired 1\n"
                     "4 2 3 1 0\nunrepaired_facets 1\n0 2 4 0\nend\n"));
}

TEST(ExactRecord, RoundTrip) {
  const std::string text = written(sample());
  const ExactResult back = parse_exact(text, "x");
  ASSERT_TRUE(back.ok()) << back.error;
  EXPECT_EQ(written(back.record), text);
  const ExactRecord expected = sample();
  ASSERT_EQ(back.record.points.size(), expected.points.size());
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    EXPECT_EQ(back.record.points[i].kind, expected.points[i].kind);
    EXPECT_EQ(back.record.points[i].x, expected.points[i].x);
    EXPECT_EQ(back.record.points[i].k, expected.points[i].k);
  }
  EXPECT_TRUE(back.record.facets[1].filtered);
  EXPECT_EQ(back.record.segments[1].facet, 1U);
  EXPECT_EQ(back.record.mesh_vertices, expected.mesh_vertices);
}

TEST(ExactRecord, DamageIsFound) {
  const std::string text = written(sample());
  int refused = 0;
  for (std::size_t n = 0; n + 1 < text.size(); ++n) {
    const ExactResult result = parse_exact(text.substr(0, n), "x");
    EXPECT_FALSE(result.ok()) << n;
    refused += result.ok() ? 0 : 1;
    std::string changed = text;
    for (char c : {'9', '-', '\n', 'T', '\0'}) {
      changed[n] = c;
      parse_exact(changed, "x");  // must not crash
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_EQ(parse_exact("delmesher-exact 8\n", "x").error, "x:1: unknown version 8");
  EXPECT_EQ(parse_exact("delmesher-exact 1\npoints 1\nS 0 0 0x1p+0\nfacets 0\n", "x").error,
            "x:3: a point refers to one that is itself on others");
  EXPECT_EQ(parse_exact("delmesher-exact 1\npoints 99999999999\n", "x").error,
            "x:2: the file ends before its 'end'");
}

}  // namespace
}  // namespace delmesher::io
