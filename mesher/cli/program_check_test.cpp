// The program's jobs `check` and `repair`, as users run them: defects shown, hints, and what mends
// them.
#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "mesher/cli/test_program.h"

namespace delmesher::cli {
namespace {

// Twelve triangles that all meet eleven others: more pairs than `check` describes, and all of them
// are coloured.
TEST_F(Program, EveryTriangleThatMeetsAnotherIsColoured) {
  std::string vertices, faces;
  for (int i = 0; i < 23; ++i) {
    const std::string n = std::to_string(i < 12 ? i : i - 12);
    vertices += i < 12 ? "-1 " + n + " 0\n11 " + n + " -1\n11 " + n + " 1\n"
                       : n + " -2 -100\n" + n + " 13 -100\n" + n + " 6 1000\n";
    faces += "3 " + std::to_string(3 * i) + " " + std::to_string(3 * i + 1) + " " +
             std::to_string(3 * i + 2) + "\n";
  }
  write("in.off", "OFF\n69 23 0\n" + vertices + faces);
  EXPECT_EQ(run("check in.off --defects in.ply"), 4);
  EXPECT_NE(text("out.txt").find("  self-intersection: 132\n"), std::string::npos);
  EXPECT_NE(text("out.txt").find("    and 122 more\n"), std::string::npos) << text("out.txt");
  const std::string ply = text("in.ply");
  int red = 0;
  for (std::size_t at = 0; (at = ply.find(" 220 40 40\n", at)) != std::string::npos; ++at) ++red;
  EXPECT_EQ(red, 23) << ply;
}

// A tetrahedron with a third triangle at an edge, and one with a face turned over and a triangle
// of two corners.
TEST_F(Program, DefectsOfEveryKindHaveTheirColour) {
  write("in.off",
        "OFF\n9 10 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n5 0 0\n6 0 0\n5 1 0\n5 0 1\n3 0 2 1\n"
        "3 0 1 3\n3 1 2 3\n3 0 3 2\n3 0 1 4\n3 5 7 6\n3 5 6 8\n3 6 7 8\n3 5 7 8\n3 5 6 6\n");
  EXPECT_EQ(run("check in.off --defects in.ply"), 4);
  const std::string ply = text("in.ply");
  for (const char* triangle : {"3 0 2 1 150 60 190",  // not manifold
                               "3 1 2 3 220 40 40",   // met by another one
                               "3 0 3 2 190 190 190", "3 5 7 8 50 90 220", "3 5 6 6 40 160 70"}) {
    EXPECT_NE(ply.find(std::string(triangle) + "\n"), std::string::npos) << triangle << '\n' << ply;
  }
}

// A cube with a corner torn into three and a triangle missing: refused with its defects, shown,
// mended, meshed.
TEST_F(Program, ATornSurfaceIsShownAndMended) {
  std::string torn = replaced(cube(), "8 12", "10 11");
  torn = replaced(torn, "1 1 1\n", "1 1 1\n1.000001 1 1\n1 1.000001 1\n");
  torn = replaced(torn, "3 4 7 6", "3 4 8 6");
  torn = replaced(torn, "3 2 6 7", "3 2 6 9");
  write("in.off", replaced(torn, "3 1 7 5\n", ""));
  EXPECT_EQ(run("in.off -o mesh.vtu"), 4);
  expect_error("in.off", "9 open edges, 1 non-manifold vertex, 3 self-intersections");
  expect_error("in.off", "see delmesher check");
  EXPECT_EQ(run("check in.off --defects in.ply"), 4);
  EXPECT_NE(text("out.txt").find("repair --weld 2e-06` would close 6 of 9 open edges"),
            std::string::npos)
      << text("out.txt");
  const std::string ply = text("in.ply");
  EXPECT_NE(ply.find("element face 11\n"), std::string::npos);
  EXPECT_NE(ply.find("3 4 8 6 220 40 40\n"), std::string::npos) << ply;
  EXPECT_NE(ply.find("3 0 2 3 190 190 190\n"), std::string::npos) << ply;
  EXPECT_EQ(run("check in.off --defects in.vtu"), 4);
  const std::string vtu = text("in.vtu");
  // Nine edges are open, beside eleven triangles.
  EXPECT_NE(vtu.find("NumberOfCells=\"20\""), std::string::npos) << vtu;
  const auto repeated = [](int times, const std::string& line) {
    std::string lines;
    for (int i = 0; i < times; ++i) lines += line;
    return lines;
  };
  EXPECT_NE(vtu.find(">\n" + repeated(11, "5\n") + repeated(9, "3\n") + "</DataArray>"),
            std::string::npos)
      << vtu;
  EXPECT_NE(vtu.find("\n33\n35\n37\n"), std::string::npos) << vtu;
  const auto kind = [&](const std::string& name) {  // its number, from the comment
    const std::string head = vtu.substr(0, vtu.find(" " + name));
    return head.substr(head.rfind(' ') + 1);
  };
  // In their order, of the triangles as they are in in.ply.
  const std::map<std::string, std::string> names = {
      {" 190 190 190", "none"}, {" 220 40 40", "self-intersection"}, {" 250 150 30", "open edge"}};
  std::string numbers;
  for (std::size_t at = ply.find("\n3 "); at != std::string::npos; at = ply.find("\n3 ", at + 1)) {
    const std::string line = ply.substr(at + 1, ply.find('\n', at + 1) - at - 1);
    for (const auto& [colour, name] : names) {
      if (line.ends_with(colour)) numbers += kind(name) + "\n";
    }
  }
  numbers += repeated(9, kind("open edge") + "\n");
  EXPECT_NE(vtu.find("Name=\"defect\" format=\"ascii\">\n" + numbers + "</DataArray>"),
            std::string::npos)
      << numbers << vtu;
  EXPECT_EQ(run("check in.off --defects in.stl"), 2);
  EXPECT_EQ(run("repair in.off -o in.welded.off --weld 2e-6"), 1);
  EXPECT_NE(text("err.txt").find("3 open edges left, see --fill"), std::string::npos)
      << text("err.txt");
  EXPECT_EQ(run("repair in.off -o in.mended.stl --weld 2e-6 --fill"), 0);
  EXPECT_EQ(text("err.txt"),
            "in.off: 2 vertices welded to others near them\nin.off: 1 hole filled\n"
            "in.off: 1 triangle added for them\nin.mended.stl: a valid surface\n");
  EXPECT_EQ(run("in.mended.stl -o mesh.vtu -q"), 0) << text("err.txt");
  EXPECT_EQ(run("repair in.off -o mesh.msh"), 2);
}

// What the hints say, and what they must not say.
TEST_F(Program, CheckHintsAtWhatIsTheMatter) {
  const auto hints = [&](const std::string& off) {
    write("in.off", off);
    EXPECT_EQ(run("check in.off"), 4);
    return text("out.txt");
  };
  const auto says = [](const std::string& text, const char* words) {
    return text.find(words) != std::string::npos;
  };
  // A vertex in the middle of an edge, on one side only.
  std::string slit = replaced(replaced(cube(), "8 12", "9 13"), "1 1 1\n", "1 1 1\n1 0.5 0.5\n");
  slit = replaced(slit, "3 1 7 5\n", "3 1 8 5\n3 8 7 5\n");
  const std::string of_slit = hints(slit);
  EXPECT_TRUE(says(of_slit, "hint: 1 T-junction: 3 edges")) << of_slit;
  EXPECT_FALSE(says(of_slit, "--fill")) << of_slit;
  const std::string of_hole = hints(replaced(replaced(cube(), "8 12", "8 11"), "3 1 7 5\n", ""));
  EXPECT_TRUE(says(of_hole, "hint: 1 hole: 3 edges")) << of_hole;
  EXPECT_FALSE(says(of_hole, "T-junction")) << of_hole;
  const std::string of_double =
      hints(replaced(replaced(cube(), "8 12", "8 13"), "3 1 7 5\n", "3 1 7 5\n3 1 7 5\n"));
  EXPECT_TRUE(says(of_double, "hint: that may make the edges manifold as well")) << of_double;
  EXPECT_FALSE(says(of_double, "inner wall")) << of_double;
  const std::string of_touch = hints(
      "OFF\n7 8 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n-1 0 0\n0 -1 0\n0 0 -1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n"
      "3 0 3 2\n3 0 4 5\n3 0 6 4\n3 4 6 5\n3 0 5 6\n");
  EXPECT_TRUE(says(of_touch, "touch at a vertex: `tetproof union --separate 1e-4` moves"))
      << of_touch;
}

// The faces between sharp edges: what they are, where they are, and what they are called in files.
TEST_F(Program, FacesGetLabelsByAngle) {
  write("in.off", cube());
  EXPECT_EQ(run("check in.off --label-by-angle 30 --defects faces.vtu"), 0);
  const std::string said = text("out.txt");
  EXPECT_NE(said.find("\n  faces with labels of their own  6\n"
                      "    face_1: 2 triangles, area 1, normal (0.000, 0.000, -1.000), "
                      "box (0, 0, 0) to (1, 1, 0)\n"),
            std::string::npos)
      << said;
  EXPECT_NE(text("err.txt").find("faces.vtu: the surface, with its labels"), std::string::npos);
  EXPECT_NE(text("faces.vtu")
                .find("Name=\"label\" format=\"ascii\">\n1\n1\n2\n2\n3\n3\n4\n4\n5\n5\n6\n6\n</"),
            std::string::npos)
      << text("faces.vtu");
  EXPECT_EQ(run("check in.off --label-by-angle 30 --json"), 0);
  EXPECT_NE(text("out.txt").find("\"name\": \"face_6\""), std::string::npos) << text("out.txt");
  EXPECT_EQ(run("check in.off"), 0);
  EXPECT_EQ(text("out.txt").find("labels"), std::string::npos) << text("out.txt");

  write("names.txt", "2 outlet\n");
  for (const std::string job : {"mesh", "cdt"}) {
    EXPECT_EQ(run(job + " in.off --label-by-angle 30 --names names.txt -o mesh.msh -o mesh.inp -o "
                        "mesh.bdf -o mesh.vtu --ascii"),
              0);
    EXPECT_NE(text("mesh.msh").find("\n2 1 \"face_1\"\n2 2 \"outlet\"\n2 3 \"face_3\"\n"),
              std::string::npos)
        << text("mesh.msh").substr(0, 400);
    for (const char* file : {"mesh.inp", "mesh.bdf", "mesh.vtu"}) {
      EXPECT_NE(text(file).find("face_6"), std::string::npos) << file;
    }
  }
  // An angle labels a surface without labels; what is not a surface is rejected as that.
  write("in.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
        "property double z\nelement face 4\nproperty list uchar int vertex_indices\n"
        "property int label\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 7\n3 0 1 3 8\n"
        "3 1 2 3 7\n3 0 3 2 7\n");
  EXPECT_EQ(run("mesh in.ply --label-by-angle 30 -o mesh.msh"), 2);
  expect_error("in.ply", "--label-by-angle: the surface has labels already");
  write("in.off", replaced(cube(), "3 1 7 5\n", "3 1 7 1\n"));
  EXPECT_EQ(run("mesh in.off --label-by-angle 30 -o mesh.msh"), 4);
  for (const char* angle : {"0", "91", "-3", "x"}) {
    EXPECT_EQ(run("mesh in.off -o mesh.msh --label-by-angle " + std::string(angle)), 2) << angle;
  }
}

TEST_F(Program, RepairWritesNothingWhereNothingIsLeft) {
  write("in.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  EXPECT_EQ(run("repair in.off -o out.off"), 1);
  EXPECT_NE(text("err.txt").find("no triangle is left, so nothing is written"), std::string::npos)
      << text("err.txt");
  EXPECT_FALSE(fs::exists(folder_ / "out.off"));
}

// Two tetrahedra with a common face; then without a triangle of the second.
TEST_F(Program, CheckListsRegionsWallsAndLeaks) {
  const std::string two =
      "v 0 0 0\nv 6 0 0\nv 0 6 0\nv 0 0 6\nv 0 0 -3\ng copper\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
      "g air\nf 1 2 3\nf 1 5 2\nf 2 5 3\n";
  write("in.obj", two + "f 3 5 1\n");
  EXPECT_EQ(run("check in.obj"), 4);
  const auto said = [&] {
    const std::string out = text("out.txt");
    const std::size_t at = std::min(out.find("  regions: "), out.size());
    return out.substr(at, out.find("  hint: ") - at);
  };
  EXPECT_EQ(said(),
            "  regions: 2\n    copper, volume 36\n    air, volume 18\n  walls: 3\n"
            "    copper|outside, area 67.1769145, 3 triangles\n"
            "    air|outside, area 40.0454077, 3 triangles\n"
            "    copper|air, area 18, 1 triangle\n");
  EXPECT_EQ(run("check in.obj --json"), 4);
  EXPECT_NE(text("out.txt").find("\"name\": \"copper|air\""), std::string::npos);
  EXPECT_EQ(run("in.obj -o air.mesh --regions air"), 0);
  EXPECT_EQ(run("in.obj -o gold.mesh --regions gold"), 2);
  EXPECT_NE(text("err.txt").find("no region is called \"gold\": there are air, copper"),
            std::string::npos)
      << text("err.txt");
  EXPECT_EQ(run("in.obj -o fine.mesh --regions all --max-edge air=2"), 0);
  EXPECT_NE(text("err.txt").find("air: 6 edges of the surface as given are longer than"),
            std::string::npos)
      << text("err.txt");
  write("in.obj", two);
  EXPECT_EQ(run("check in.obj"), 4);
  EXPECT_NE(said().find("  `air` is open: one region with the outside, through the gap at (0, "),
            std::string::npos)
      << said();
}

// Boxes side by side, of the vertices of a grid of 3 x 3 x 2, with and without what is between
// them: what is the matter stands in the line of `mesh`, too.
TEST_F(Program, WhatTouchesIsSaidToBeWhatItIs) {
  const auto box = [](int x, int y) {  // its faces outwards: at x, at x + 1, and the other four
    const auto v = [&](int i, int j, int k) { return std::to_string(x + i + 3 * (y + j) + 9 * k); };
    const auto quad = [](const std::string& a, const std::string& b, const std::string& c,
                         const std::string& d) {
      return "3 " + a + " " + b + " " + c + "\n3 " + a + " " + c + " " + d + "\n";
    };
    return std::array<std::string, 3>{quad(v(0, 0, 0), v(0, 0, 1), v(0, 1, 1), v(0, 1, 0)),
                                      quad(v(1, 0, 0), v(1, 1, 0), v(1, 1, 1), v(1, 0, 1)),
                                      quad(v(0, 0, 0), v(1, 0, 0), v(1, 0, 1), v(0, 0, 1)) +
                                          quad(v(0, 1, 0), v(0, 1, 1), v(1, 1, 1), v(1, 1, 0)) +
                                          quad(v(0, 0, 0), v(0, 1, 0), v(1, 1, 0), v(1, 0, 0)) +
                                          quad(v(0, 0, 1), v(1, 0, 1), v(1, 1, 1), v(0, 1, 1))};
  };
  const auto hints_of = [&](const std::string& faces, const std::string& vertices = "") {
    std::string grid = vertices;
    for (int i = 0; i < 18 && vertices.empty(); ++i) {
      grid += std::to_string(i % 3) + " " + std::to_string(i / 3 % 3) + " " +
              std::to_string(i / 9) + "\n";
    }
    write("in.off", "OFF\n" + std::to_string(std::count(grid.begin(), grid.end(), '\n')) + " " +
                        std::to_string(std::count(faces.begin(), faces.end(), '\n')) + " 0\n" +
                        grid + faces);
    EXPECT_EQ(run("check in.off"), 4);
    const std::string said = text("out.txt");
    EXPECT_EQ(run("mesh in.off -o mesh.tet -q"), 4);
    return said.substr(std::min(said.find("  hint:"), said.size()));
  };
  const auto [a0, a1, a] = box(0, 0);
  const auto [b0, b1, b] = box(1, 0);
  const auto [c0, c1, c] = box(1, 1);
  EXPECT_EQ(hints_of(a0 + a1 + a + b1 + b),
            "  hint: an inner wall of 2 triangles: triangle 2 at (1, 0, 0) is the first; with 2 "
            "parts inside this is not one solid: `delmesher mesh --regions all` meshes each as a "
            "region, or leave walls out\n");
  EXPECT_NE(
      text("err.txt").find("(in all 4 non-manifold edges: an inner wall of 2 triangles; see "),
      std::string::npos)
      << text("err.txt");
  // The same from the other side, with the wall turned round.
  EXPECT_NE(hints_of(b + b1 + a0 + a + b0).find("an inner wall of 2 triangles: triangle 20 at"),
            std::string::npos);
  EXPECT_EQ(hints_of(a0 + a1 + a + b0 + b1 + b),
            "  hint: bodies, or parts of one, touch in 2 triangles: `delmesher repair` makes one "
            "of them, or `delmesher mesh --regions all` meshes each as a region\n");
  EXPECT_EQ(run("repair in.off -o mended.off"), 0) << text("err.txt");
  EXPECT_EQ(hints_of(a0 + a1 + a + b1 + b).substr(0, 40),
            "  hint: an inner wall of 2 triangles: tr");
  EXPECT_EQ(run("repair in.off -o mended.off"), 1);
  EXPECT_NE(text("err.txt").find(": 4 non-manifold edges left: an inner wall of 2 triangles: "),
            std::string::npos)
      << text("err.txt");
  EXPECT_EQ(hints_of(a0 + a1 + a + c0 + c1 + c),
            "  hint: bodies, or parts of one, touch along 1 edge: `tetproof union --separate 1e-4` "
            "moves them apart, or `delmesher mesh --regions all` meshes each as a region\n");
  // A wall that has no vertices in common with the box around it.
  const std::string long_box =
      "0 0 0\n2 0 0\n0 1 0\n2 1 0\n0 0 1\n2 0 1\n0 1 1\n2 1 1\n1 0 0\n1 1 0\n1 0 1\n1 1 1\n";
  EXPECT_NE(hints_of(kCubeTriangles + "3 8 9 11\n3 8 11 10\n", long_box)
                .find("  hint: a sheet of 2 triangles meets a closed body: an inner wall, or "),
            std::string::npos);
  // A body with a hole is not a sheet, whatever sticks in it: here a sphere-like box of 1452
  // triangles.
  std::string many, faces;
  std::map<std::array<int, 3>, int> numbers_of;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [found, is_new] = numbers_of.try_emplace(p, static_cast<int>(numbers_of.size()));
    if (is_new) {
      for (const int x : p) many += std::to_string(x) + " ";
      many += "\n";
    }
    return " " + std::to_string(found->second);
  };
  constexpr int kSide = 11;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int end : {0, kSide}) {
      for (int i = 0; i < kSide * kSide; ++i) {
        std::array<std::array<int, 3>, 4> q{};
        for (std::size_t k = 0; k < 4; ++k) {
          q[k][axis] = end;
          q[k][(axis + 1) % 3] = i % kSide + (k == 1 || k == 2 ? 1 : 0);
          q[k][(axis + 2) % 3] = i / kSide + (k >= 2 ? 1 : 0);
        }
        if (end == 0) std::swap(q[1], q[3]);
        faces += "3" + vertex(q[0]) + vertex(q[1]) + vertex(q[2]) + "\n";
        faces += "3" + vertex(q[0]) + vertex(q[2]) + vertex(q[3]) + "\n";
      }
    }
  }
  faces = faces.substr(faces.find('\n') + 1);  // the hole
  const int first = static_cast<int>(numbers_of.size());
  many += "5.5 5.5 -1\n6.5 5.5 1\n5.5 6.5 1\n5.3 5.3 1\n";
  for (const std::array<int, 3>& f :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{0, 3, 2}}) {
    faces += "3";
    for (const int v : f) faces += " " + std::to_string(first + v);
    faces += "\n";
  }
  const std::string pierced = hints_of(faces, many);
  EXPECT_EQ(pierced.find("sheet"), std::string::npos) << pierced;
  EXPECT_NE(pierced.find("hint: 1 hole"), std::string::npos) << pierced;
  EXPECT_EQ(pierced.find("union"), std::string::npos) << pierced;  // which takes nothing open
  // A cube of half the size that stands on another one's side, and one that is stuck in it.
  for (const char* low : {"1", "0.75"}) {
    std::string vertices;
    for (const std::string at : {"0", low}) {
      for (int i = 0; i < 8; ++i) {
        const bool small = at == low;
        const double half = small ? 0.5 : 1;
        vertices += std::to_string((small ? std::stod(low) : 0) + half * (i & 1)) + " " +
                    std::to_string((small ? 0.25 : 0) + half * (i >> 1 & 1)) + " " +
                    std::to_string((small ? 0.25 : 0) + half * (i >> 2)) + "\n";
      }
    }
    std::istringstream numbers(kCubeTriangles);
    std::string second;
    for (int three, i, j, k; numbers >> three >> i >> j >> k;) {
      second += "3 " + std::to_string(i + 8) + " " + std::to_string(j + 8) + " " +
                std::to_string(k + 8) + "\n";
    }
    const std::string hint = hints_of(kCubeTriangles + second, vertices);
    EXPECT_TRUE(hint.starts_with(std::string(low) == "1" ? "  hint: bodies touch, and do not cross"
                                                         : "  hint: triangles meet: if bodies"))
        << hint;
  }
}

}  // namespace
}  // namespace delmesher::cli
