#include "reports/picture.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace tetproof::picture_test {
namespace {

using oracles::Index;
using oracles::MeshFile;
using oracles::Polyhedron;
using oracles::Position;

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

using Numbers = std::vector<Index>;

TEST(Picture, WhatSentencesName) {
  const Place duplicate =
      place_of("complex: tetrahedron 7 (1 2 3 14) duplicates tetrahedron 9 (2 1 3 14)");
  EXPECT_EQ(duplicate.cells, (std::vector<Numbers>{{1, 2, 3, 14}, {2, 1, 3, 14}}));
  EXPECT_TRUE(duplicate.input_vertices.empty() && duplicate.input_triangles.empty());

  const Place off = place_of("vertex 17 is off the plane of facet 5");
  EXPECT_EQ(off.vertices, Numbers{17});
  EXPECT_EQ(off.input_triangles, Numbers{5});

  const Place edge = place_of("input edge 3-40 shares boundary edge vertex 8 - vertex 9");
  EXPECT_EQ(edge.input_vertices, (Numbers{3, 40}));
  EXPECT_EQ(edge.vertices, (Numbers{8, 9}));

  EXPECT_EQ(place_of("input vertex 6 is not on the boundary").input_vertices, Numbers{6});
  EXPECT_TRUE(place_of("input vertex 6 is not on the boundary").vertices.empty());
  EXPECT_EQ(place_of("boundary face (4 5 6) lies on no input facet").cells,
            (std::vector<Numbers>{{4, 5, 6}}));
  EXPECT_EQ(place_of("2.5 envelopes at (1.5, -2e-3, 0)").points,
            (std::vector<Position>{{1.5, -2e-3, 0}}));
  EXPECT_TRUE(place_of("the Euler characteristic is 3, that of the boundary 4").empty());
  EXPECT_TRUE(place_of("vertex 99999999999999").empty());
}

TEST(Picture, TheFirstFailureThatNamesAPlace) {
  EXPECT_EQ(sentence_with_place(R"({"oracles": [
    {"name": "complex", "status": "pass", "findings": ["vertex 1"]},
    {"name": "angles", "status": "info", "findings": ["vertex 2"]},
    {"name": "volume", "status": "FAIL", "findings": ["too large"]},
    {"name": "conformity", "status": "FAIL", "findings": ["somewhere", "vertex 3 is off"]}]})"),
            "conformity: vertex 3 is off");
  EXPECT_EQ(sentence_with_place(R"({"oracles": []})"), "");
  for (const char* other :
       {"", "no JSON", "[]", R"({"error": "limit"})", R"({"oracles": 3})", R"({"oracles": [7]})",
        R"({"oracles": [{"status": "FAIL", "name": 7, "findings": ["vertex 3 is off"]}]})",
        R"({"oracles": [{"status": "FAIL", "name": "volume", "findings": [7]}]})"}) {
    EXPECT_EQ(sentence_with_place(other), std::nullopt) << other;
  }
}

struct Corner : testing::Test {
  Polyhedron input;
  MeshFile mesh;

  Corner() {
    input.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    input.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    mesh.vertices = input.vertices;
    mesh.vertices.push_back({0.25, 0.25, 0.25});
    mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 3, 1, 4}, {1, 3, 2, 4}};
  }
};

TEST_F(Corner, WhatIsNamedIsDrawn) {
  const std::string svg = picture_of(input, mesh, "orientation: tetrahedron 0 (0 1 2 4) is <flat>");
  EXPECT_EQ(count_of(svg, "<polygon"), 4U);  // its faces
  EXPECT_EQ(count_of(svg, "<circle"), 4U);   // its vertices
  EXPECT_EQ(count_of(svg, ">4</text>"), 1U);
  EXPECT_EQ(count_of(svg, "<path"), 2U);  // edges of both
  EXPECT_EQ(count_of(svg, "is &lt;flat&gt;</title>"), 1U);
  EXPECT_EQ(count_of(svg, "<g"), count_of(svg, "</g>"));
  // The middle of the box around the four vertices.
  EXPECT_NE(svg.find("around (0.5, 0.5, 0.125)"), std::string::npos) << svg;
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST_F(Corner, AFacetIsShownWithTheVertexThatMissesIt) {
  const std::string svg = picture_of(input, mesh, "vertex 4 is off the plane of facet 2");
  EXPECT_EQ(count_of(svg, "<polygon"), 1U);
  EXPECT_EQ(count_of(svg, "<circle"), 1U);
  // The vertex alone decides where one looks; three times its shortest edge, sqrt(3)/4, to each
  // side.
  EXPECT_NE(svg.find("around (0.25, 0.25, 0.25), 2.6 wide"), std::string::npos) << svg;
  EXPECT_NE(picture_of(input, mesh, "facet 2 is not tiled").find("around (0.5, 0.5, 0.5)"),
            std::string::npos);
}

TEST_F(Corner, WhatDoesNotExistIsLeftOut) {
  EXPECT_EQ(picture_of(input, mesh, "tetrahedron 9 (0 1 2 77) has a corner out of range")
                .find("<polygon"),
            std::string::npos);
  EXPECT_EQ(picture_of(input, mesh, "vertex 77 belongs to no tetrahedron"), "");
  EXPECT_EQ(picture_of(input, mesh, "the surface is open"), "");
  mesh.vertices[4][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(picture_of(input, mesh, "vertex 4 is not finite"), "");
  EXPECT_EQ(picture_of(input, mesh, "input vertex 1 is not on the boundary").find("nan"),
            std::string::npos);
}

// 10 000 tetrahedra: those nearest are drawn, and a page can hold many pictures.
TEST_F(Corner, APictureIsSmall) {
  const Index n = static_cast<Index>(mesh.vertices.size());
  for (Index i = 0; i < 10000; ++i) {
    mesh.vertices.push_back({0.2 + 1e-6 * i, 0.2, 0.2});
    mesh.tetrahedra.push_back({0, 1, 2, n + i});
  }
  const std::string svg = picture_of(input, mesh, "vertex 4 is off the plane of facet 2");
  EXPECT_FALSE(svg.empty());
  EXPECT_LT(svg.size(), 20000U);
}

}  // namespace
}  // namespace tetproof::picture_test
