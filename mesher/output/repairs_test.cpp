// Each kind of repair alone: vertex_moves.h, local_operations.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "mesher/output/local_operations.h"
#include "mesher/output/vertex_moves.h"

namespace delmesher::output::repairs_test {
namespace {

struct Scene {
  PointStore points;
  RoundingInput input;
  Limits options;
  Control control{options};

  VertexId add(double x, double y, double z, bool fixed, bool on_surface = false) {
    const VertexId v = points.add_explicit(x, y, z);
    input.mobility.push_back(fixed        ? Mobility::fixed
                             : on_surface ? Mobility::in_plane
                                          : Mobility::free);
    return v;
  }
  const NearestMesh& nearest() {
    input.points = &points;
    input.mesh.region.resize(input.mesh.tetrahedra.size(), 1);
    return nearest_.emplace(input, control);
  }
  RoundedMesh mesh() { return RoundedMesh(nearest()); }

 private:
  std::optional<NearestMesh> nearest_;
};

std::size_t alive(const RoundedMesh& mesh) {
  return mesh.mesh.tetrahedra();
}

// An octahedron of radius 1, coned from a volume vertex (the last) at the given place.
Scene octahedron(double x, double y, double z) {
  Scene s;
  for (int i = 0; i < 6; ++i) {
    const double c = i % 2 == 0 ? 1 : -1;
    s.add(i / 2 == 0 ? c : 0, i / 2 == 1 ? c : 0, i / 2 == 2 ? c : 0, true, true);
  }
  const VertexId centre = s.add(x, y, z, false);
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t a = i & 1, b = 2 + (i >> 1 & 1), c = 4 + (i >> 2);
    const bool even = (a + (b - 2) + (c - 4)) % 2 == 0;
    s.input.mesh.tetrahedra.push_back({even ? a : b, even ? b : a, c, centre});
    std::swap(s.input.mesh.tetrahedra.back()[2], s.input.mesh.tetrahedra.back()[3]);
  }
  return s;
}

TEST(Octahedron, IsPositiveWithItsCentreInside) {
  Scene s = octahedron(0.125, 0.25, -0.125);
  EXPECT_TRUE(s.mesh().bad().empty());
}

TEST(VertexMoves, BringsAVolumeVertexBackIntoItsStar) {
  for (const double far : {0.6, 1.0, 1.5, 40.0}) {
    Scene s = octahedron(far, 0.7 * far, 0.1 * far);
    RoundedMesh mesh = s.mesh();
    ASSERT_FALSE(mesh.bad().empty());
    VertexMoves moves(mesh);
    for (int i = 0; i < 10 && !mesh.bad().empty(); ++i) moves.fix(*mesh.bad().begin());
    EXPECT_TRUE(mesh.bad().empty()) << far;
  }
}

TEST(VertexMoves, LeavesFixedVerticesAndKeepsSurfaceVerticesNear) {
  Scene s = octahedron(1.5, 0, 0);
  s.input.mobility[6] = Mobility::fixed;
  {
    RoundedMesh mesh = s.mesh();
    EXPECT_FALSE(VertexMoves(mesh).fix(*mesh.bad().begin()));
  }
  s.input.mobility[6] = Mobility::in_plane;
  RoundedMesh mesh = s.mesh();
  EXPECT_FALSE(VertexMoves(mesh).fix(*mesh.bad().begin()));
  EXPECT_EQ(mesh.position(6), (Vec3{1.5, 0, 0}));
}

TEST(VertexMoves, TakesTheShortestMove) {
  Scene s = octahedron(0.5, 0.25, 0.25);  // on a face
  RoundedMesh mesh = s.mesh();
  ASSERT_EQ(mesh.bad().size(), 1U);
  ASSERT_EQ(mesh.sign(*mesh.bad().begin()), 0);
  EXPECT_TRUE(VertexMoves(mesh).fix(*mesh.bad().begin()));
  EXPECT_TRUE(mesh.bad().empty());
  double moved = 0;
  for (int i = 0; i < 3; ++i) moved += std::fabs(mesh.position(6)[i] - mesh.home(6)[i]);
  EXPECT_LE(moved, 0x1p-53);
}

// A vertex on the base of a tetrahedron that is next to nothing high: the distance of doubles at
// its large coordinates is far too much, that at its smallest one is enough.
TEST(VertexMoves, EachCoordinateHasStepsOfItsOwn) {
  Scene s;
  constexpr double kBase = 0x1p-70;
  s.add(0, 0, kBase, true), s.add(2, 0, kBase, true), s.add(0, 2, kBase, true);
  s.add(0.5, 0.25, 0x1p-60, true), s.add(0.5, 0.25, kBase, false);
  s.input.mesh.tetrahedra = {{4, 1, 2, 3}, {0, 4, 2, 3}, {0, 1, 4, 3}, {0, 1, 2, 4}};
  RoundedMesh mesh = s.mesh();
  ASSERT_EQ(mesh.bad(), (std::set<std::uint32_t>{3}));
  EXPECT_TRUE(VertexMoves(mesh).fix(3));
  EXPECT_TRUE(mesh.bad().empty());
  const Vec3& p = mesh.position(4);
  EXPECT_EQ(p[0], 0.5);
  EXPECT_EQ(p[1], 0.25);
  EXPECT_EQ(p[2], std::nextafter(kBase, 1));
}

// The only double above a flat tetrahedron's vertex is taken by another vertex, which has to go
// first. A mesh that cannot be mended is left as it was.
TEST(VertexMoves, ChainsMakeRoom) {
  constexpr double kBase = 0x1p-70;
  const double above = std::nextafter(kBase, 1);
  for (const bool fixed : {false, true}) {
    Scene s;
    s.add(0, 0, kBase, true), s.add(2, 0, kBase, true), s.add(0, 2, kBase, true);
    s.add(0.5, 0.25, 0x1p-60, true), s.add(0.5, 0.25, kBase, false);
    s.add(0.5, 0.25, above, fixed);
    s.input.mesh.tetrahedra = {{0, 1, 2, 4}, {4, 1, 2, 5}, {0, 4, 2, 5}, {0, 1, 4, 5},
                               {5, 1, 2, 3}, {0, 5, 2, 3}, {0, 1, 5, 3}};
    RoundedMesh mesh = s.mesh();
    ASSERT_EQ(mesh.bad(), (std::set<std::uint32_t>{0}));
    VertexMoves moves(mesh);
    EXPECT_FALSE(moves.fix(0));
    const std::uint32_t before = mesh.clock();
    EXPECT_EQ(moves.fix_by_chain(0), !fixed);
    EXPECT_EQ(mesh.bad().empty(), !fixed);
    EXPECT_EQ(mesh.position(4)[2] > kBase, !fixed);
    EXPECT_EQ(mesh.position(5)[2] > above, !fixed);
    EXPECT_EQ(mesh.position(4) == mesh.home(4), fixed);
    // Tetrahedra at the vertex that made room have changed, too.
    EXPECT_EQ(mesh.last_change(6) > before, !fixed);
  }
}

// A vertex on a face of its star may go there by a step, but so may the corners of that face.
TEST(VertexMoves, MovesVerticesOfTheVolumeFirst) {
  Scene s = octahedron(0.5, 0.25, 0.25);
  std::fill_n(s.input.mobility.begin(), 6, Mobility::in_plane);
  RoundedMesh mesh = s.mesh();
  ASSERT_EQ(mesh.bad().size(), 1U);
  EXPECT_TRUE(VertexMoves(mesh).fix(*mesh.bad().begin()));
  EXPECT_TRUE(mesh.bad().empty());
  for (std::uint32_t v = 0; v < 6; ++v) EXPECT_EQ(mesh.position(v), mesh.home(v)) << v;
  EXPECT_NE(mesh.position(6), mesh.home(6));
}

// Two vertices are in one place. The first must not leave it through the face that is one double
// away from it, whichever of its coordinates that limits.
TEST(VertexMoves, SeparatingDoesNoHarm) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Scene s;
      // Axes in turn, so that a, b, c are counter-clockwise seen from the vertex.
      const auto add = [&](double x, double y, double z, bool fixed) {
        Vec3 p = {x, y, z};
        std::rotate(p.begin(), p.begin() + (3 - axis) % 3, p.end());
        return s.add(p[0], p[1], p[2], fixed);
      };
      const double face = std::nextafter(0.5, side > 0 ? 0 : 1);
      const VertexId v = add(0.5, 0.5, 0.5, false), w = add(0.5, 0.5, 0.5, true);
      VertexId a = add(face, 0, 0, true), b = add(face, 4, 0, true);
      const VertexId c = add(face, 0, 4, true);
      if (side < 0) std::swap(a, b);
      s.input.mesh.tetrahedra = {{a, b, c, v}};
      const VertexId d = add(8, 0, 0, true), e = add(8, 4, 0, true), f = add(8, 0, 4, true);
      s.input.mesh.tetrahedra.push_back({e, d, f, w});
      RoundedMesh mesh = s.mesh();
      ASSERT_TRUE(mesh.bad().empty());
      ASSERT_EQ(mesh.nearest().coincident(mesh.positions()).size(), 1U);
      EXPECT_TRUE(VertexMoves(mesh).separate(v));
      EXPECT_TRUE(mesh.bad().empty()) << axis << " " << side;
      EXPECT_TRUE(mesh.nearest().coincident(mesh.positions()).empty());
    }
  }
}

// A vertex near the origin below the base of its tetrahedron, which is not enclosed: its own
// doubles are far too near each other to lead it back, those of the surface are not.
TEST(VertexMoves, UntanglingTakesStepsOfTheSurface) {
  Scene s;
  s.add(0, 0, 0, true), s.add(2, 0, 0, true), s.add(0, 2, 0, true);
  s.add(0x1p-60, 0x1p-60, -0x1p-60, false);
  s.input.mesh.tetrahedra = {{0, 1, 2, 3}};
  RoundedMesh mesh = s.mesh();
  ASSERT_EQ(mesh.bad().size(), 1U);
  EXPECT_TRUE(VertexMoves(mesh).untangle(s.control));
  EXPECT_TRUE(mesh.bad().empty());
}

// And soon: with its budget alone as limit it would decide a million signs.
TEST(VertexMoves, UntanglingEndsWhereNothingCanMove) {
  Scene s = octahedron(1.5, 0, 0);
  for (const Mobility mobility : {Mobility::in_plane, Mobility::fixed}) {
    s.input.mobility[6] = mobility;
    RoundedMesh mesh = s.mesh();
    const std::uint64_t before = mesh.signs();
    EXPECT_FALSE(VertexMoves(mesh).untangle(s.control));
    EXPECT_FALSE(mesh.bad().empty());
    EXPECT_LT(mesh.signs() - before, 200'000U);
  }
}

// Not even an attempt is made at tetrahedra of which no vertex may move.
TEST(VertexMoves, UntanglingTriesNothingWhereNothingMayMove) {
  Scene s = octahedron(1.5, 0, 0);
  s.input.mobility[6] = Mobility::fixed;
  RoundedMesh mesh = s.mesh();
  int asked = 0;
  Limits options;
  options.progress = [&](const Progress&) { return ++asked < 1000; };
  Control control(options);
  EXPECT_FALSE(VertexMoves(mesh).untangle(control));
  EXPECT_EQ(asked, 0);
}

TEST(LocalOperations, CollapsesAVolumeVertexOutsideItsStar) {
  // The octahedron's centre has six neighbours; a collapse leaves the four tetrahedra that do not
  // touch the vertex it goes to. Flips cannot help with a vertex this far out.
  Scene s = octahedron(40, 30, 20);
  RoundedMesh mesh = s.mesh();
  EXPECT_TRUE(LocalOperations(mesh).fix(*mesh.bad().begin(), true));
  EXPECT_TRUE(mesh.bad().empty());
  EXPECT_EQ(alive(mesh), 4U);
  EXPECT_TRUE(mesh.star(6).empty());
}

TEST(LocalOperations, DoesNotCollapseSurfaceVertices) {
  Scene s = octahedron(40, 30, 20);
  s.input.mobility[6] = Mobility::in_plane;
  RoundedMesh mesh = s.mesh();
  EXPECT_FALSE(LocalOperations(mesh).fix(*mesh.bad().begin(), true));
  EXPECT_EQ(alive(mesh), 8U);
}

// n points around the z axis, and two poles whose edge passes them at x = `off`: outside the ring
// if off > 1, with inverted tetrahedra.
Scene ring(int n, double off) {
  Scene s;
  const VertexId south = s.add(off, 0.01, -1, true), north = s.add(off, 0.01, 1, true);
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * (i + 0.5) / n;
    s.add(std::cos(angle), std::sin(angle), 0, true);
  }
  for (int i = 0; i < n; ++i) {
    s.input.mesh.tetrahedra.push_back({south, north, static_cast<std::uint32_t>(2 + i),
                                       static_cast<std::uint32_t>(2 + (i + 1) % n)});
  }
  return s;
}

TEST(LocalOperations, RemovesEdges) {
  for (int n = 3; n <= 9; ++n) {
    ASSERT_TRUE(ring(n, 0).mesh().bad().empty());
    Scene s = ring(n, 1.1);
    RoundedMesh mesh = s.mesh();
    ASSERT_FALSE(mesh.bad().empty());
    // Removing the edge replaces n tetrahedra by two for each of n - 2 triangles.
    const bool possible = LocalOperations(mesh).fix(*mesh.bad().begin(), true);
    EXPECT_TRUE(possible) << n;
    EXPECT_TRUE(mesh.bad().empty());
    EXPECT_EQ(alive(mesh), 2U * (n - 2));
  }
}

// Around a star of three points, of which every triangulation has a triangle in its middle: one
// whose sides are all diagonals, or one on a diagonal that is on no side of the star.
TEST(LocalOperations, RemovesAnEdgeInAStar) {
  for (int turn = 0; turn < 6; ++turn) {
    Scene s;
    const VertexId south = s.add(0.9, 0.4, -1, true), north = s.add(0.9, 0.4, 1, true);
    for (int i = 0; i < 6; ++i) {
      const double angle = M_PI / 3 * (i + turn), radius = (i + turn) % 2 == 0 ? 1 : 0.25;
      s.add(radius * std::cos(angle), radius * std::sin(angle), 0, true);
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
      s.input.mesh.tetrahedra.push_back({south, north, 2 + i, 2 + (i + 1) % 6});
    }
    RoundedMesh mesh = s.mesh();
    ASSERT_FALSE(mesh.bad().empty());
    EXPECT_TRUE(LocalOperations(mesh).fix(*mesh.bad().begin(), true)) << turn;
    EXPECT_TRUE(mesh.bad().empty());
    EXPECT_EQ(alive(mesh), 2U * (6 - 2)) << turn;
  }
}

// As RemovesFaces, but the tip is on the edge 0 1: the flip would make 0 1 3 4, which is flat.
TEST(LocalOperations, MakesNothingFlat) {
  Scene s;
  s.add(0, 0, 0, true), s.add(4, 0, 0, true), s.add(0, 4, 0, true);
  s.add(2, 0, 0, true), s.add(1, 1, 2, true);
  s.input.mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 1, 3}};
  for (const bool exact_too : {false, true}) {
    RoundedMesh mesh = s.mesh();
    ASSERT_EQ(mesh.bad().size(), 1U);
    EXPECT_FALSE(LocalOperations(mesh).fix(*mesh.bad().begin(), exact_too));
    EXPECT_EQ(alive(mesh), 2U);
  }
}

// A sum says how many tetrahedra are not positive, and how many of these are inverted.
TEST(Badness, CountsWhatIsNotPositiveAndOfThatWhatIsInverted) {
  Badness sum = 0;
  for (const int sign : {1, 0, -1, 1, -1, 0, 0}) sum += badness(sign);
  EXPECT_EQ(sum / kOneBad, 5);
  EXPECT_EQ(sum % kOneBad, 2);
}

TEST(LocalOperations, KeepsBoundaryFacesAndFlags) {
  Scene s = ring(5, 1.1);
  s.input.mesh.boundary.push_back({{1, 3, 0}, 0});
  RoundedMesh kept = s.mesh();
  EXPECT_FALSE(LocalOperations(kept).fix(*kept.bad().begin(), true));

  s.input.mesh.boundary.clear();
  s.input.mesh.region = {1, 1, 1, 0, 0};
  RoundedMesh mixed = s.mesh();
  EXPECT_FALSE(LocalOperations(mixed).fix(*mixed.bad().begin(), true));
}

TEST(LocalOperations, RemovesFaces) {
  // A flat tetrahedron below the face 0 1 2, whose tip 3 lies in it, and a good one above.
  Scene s;
  s.add(0, 0, 0, true), s.add(4, 0, 0, true), s.add(0, 4, 0, true);
  s.add(1, 1, 0, true), s.add(1, 1, 2, true);
  s.input.mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 1, 3}};
  RoundedMesh mesh = s.mesh();
  ASSERT_EQ(mesh.bad().size(), 1U);
  EXPECT_TRUE(LocalOperations(mesh).fix(*mesh.bad().begin(), true));
  EXPECT_TRUE(mesh.bad().empty());
  EXPECT_EQ(alive(mesh), 3U);
}

TEST(LocalOperations, MakesNoEdgeTwice) {
  // As above, but the edge 3 4 that the flip would create exists in another tetrahedron.
  for (const bool taken : {false, true}) {
    Scene s;
    s.add(0, 0, 0, true), s.add(4, 0, 0, true), s.add(0, 4, 0, true);
    s.add(1, 1, 0, true), s.add(1, 1, 2, true), s.add(9, 9, 0, true), s.add(9, 0, 9, true);
    s.input.mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 1, 3}, {0, 1, 3, 5},
                               {1, 3, 5, 6}, {0, 1, 4, 6}, {1, 4, 6, 5}};
    if (taken) s.input.mesh.tetrahedra.push_back({3, 4, 5, 6});
    RoundedMesh mesh = s.mesh();
    EXPECT_EQ(LocalOperations(mesh).fix(1, true), !taken);
    EXPECT_EQ(alive(mesh), 7U);
  }
}

// Where stars are not connected by faces, as in a refined mesh, tetrahedra stay.
TEST(LocalOperations, KeepsTetrahedraWhereTheMeshTouchesItself) {
  Scene s;
  s.add(0, 0, 0, true), s.add(4, 0, 0, true), s.add(0, 4, 0, true);
  s.add(1, 1, 0, true), s.add(1, 1, 2, true);
  s.add(-1, 0, 0, true), s.add(0, -1, 0, true), s.add(0, 0, -1, true);
  s.input.mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 1, 3}, {0, 5, 6, 7}};
  RoundedMesh mesh = s.mesh();
  EXPECT_EQ(mesh.star(0).size(), 3U);
  EXPECT_FALSE(LocalOperations(mesh).fix(1, true));
  EXPECT_EQ(alive(mesh), 3U);
}

// Removing the edge between the poles of a ring of three makes the triangle of the ring an inner
// face, which is one of another tetrahedron already; whatever the vertices' numbers are.
TEST(LocalOperations, MakesNoFaceThrice) {
  for (const bool poles_last : {false, true}) {
    for (const bool taken : {false, true}) {
      const Scene given = ring(3, 1.1);
      Scene s;
      const std::uint32_t shift = poles_last ? 3 : 0;
      const auto moved = [&](std::uint32_t v) { return (v + shift) % 5; };
      for (std::uint32_t i = 0; i < 5; ++i) {
        const Vec3 p = given.points.nearest((i + 5 - shift) % 5);
        s.add(p[0], p[1], p[2], true);
      }
      s.add(0, 0, 9, true);
      for (const Tet& t : given.input.mesh.tetrahedra) {
        s.input.mesh.tetrahedra.push_back({moved(t[0]), moved(t[1]), moved(t[2]), moved(t[3])});
      }
      s.input.mesh.tetrahedra.push_back({moved(0), moved(2), moved(3), 5});
      s.input.mesh.tetrahedra.push_back({moved(0), moved(3), moved(4), 5});
      if (taken) s.input.mesh.tetrahedra.push_back({moved(2), moved(3), moved(4), 5});
      RoundedMesh mesh = s.mesh();
      ASSERT_FALSE(mesh.bad().empty());
      EXPECT_EQ(LocalOperations(mesh).fix(*mesh.bad().begin(), true), !taken);
    }
  }
}

TEST(LocalOperations, MayAskForExactPositions) {
  // Vertex 3 is exactly where the flip would make inverted tetrahedra, but it is written elsewhere.
  Scene s;
  s.add(0, 0, 0, true), s.add(4, 0, 0, true), s.add(0, 4, 0, true);
  s.add(5, 5, -0.5, true), s.add(1, 1, 2, true);
  s.input.mesh.tetrahedra = {{0, 1, 2, 4}, {0, 2, 1, 3}};
  RoundedMesh mesh = s.mesh();
  EXPECT_TRUE(mesh.bad().empty());
  mesh.move(3, {1, 1, 0});
  ASSERT_EQ(mesh.bad().size(), 1U);
  EXPECT_FALSE(LocalOperations(mesh).fix(*mesh.bad().begin(), true));
  EXPECT_EQ(alive(mesh), 2U);
  EXPECT_TRUE(LocalOperations(mesh).fix(*mesh.bad().begin(), false));
  EXPECT_EQ(alive(mesh), 3U);
}

}  // namespace
}  // namespace delmesher::output::repairs_test
