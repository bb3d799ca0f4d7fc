// Which tetrahedra are inside, outside or crossed (oracles/mesh/places.h). The oracle asks once for
// a group of tetrahedra, and asks nothing about the surface that faces of the mesh cover. That
// saves work, and must change no answer.
#include "oracles/mesh/places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mesher/delmesher.h"
#include "oracles/record/cover.h"
#include "property_tests/samples.h"

namespace tetproof::places_test {
namespace {

using namespace oracles;  // NOLINT

// By a ray and a look at the surface for every tetrahedron.
Place alone(const ExactPoints& points, const InputSurface& surface, const Tet& tet) {
  InputSurface::PlaneSides known;
  if (surface.contact(points, tet, known).enters) return Place::crossed;
  const int parity = surface.inside(points, tet);
  return parity == 1 ? Place::inside : parity == 0 ? Place::outside : Place::crossed;
}

// The cells of a grid around a surface, some of its faces on the surface or not.
void expect_places_in_a_grid(const Polyhedron& polyhedron, std::array<std::size_t, 3>& counts) {
  const MeshFile grid = samples::grid_sample(4, 1, [](int, int, int) { return true; }).mesh;
  std::vector<Position> positions = polyhedron.vertices;
  const auto offset = static_cast<Index>(positions.size());
  positions.insert(positions.end(), grid.vertices.begin(), grid.vertices.end());
  ExactPoints points;
  ASSERT_EQ(points.assign(positions), "");
  InputSurface surface;
  ASSERT_EQ(surface.assign(polyhedron, points), "");
  TetComplex complex{&points, grid.tetrahedra, {}, offset, static_cast<Index>(points.size())};
  for (Tet& tet : complex.tetrahedra) {
    for (Index& v : tet) v += offset;
  }
  Neighbours neighbours;
  ASSERT_TRUE(check_complex(complex, neighbours).passed());
  const Places places(complex, neighbours, surface);
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const Place place = places.of(t);
    ASSERT_EQ(place, alone(points, surface, complex.tetrahedra[t])) << complex.tet_name(t);
    ++counts[static_cast<std::size_t>(place)];
  }
}

TEST(Places, InAGridAreThoseOfEachTetrahedronAlone) {
  std::array<std::size_t, 3> counts{};
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Polyhedron voxels = samples::to_polyhedron(samples::random_voxels(seed));
    Position high{};
    for (const Position& p : voxels.vertices) {
      for (int axis = 0; axis < 3; ++axis) high[axis] = std::max(high[axis], p[axis]);
    }
    // On the grid's own planes, and beside them.
    const double size = std::exp2(-std::ceil(std::log2(std::max({high[0], high[1], high[2]}))));
    for (const double scale : {size, size * 0.7}) {
      Polyhedron scaled = voxels;
      for (Position& p : scaled.vertices) {
        for (double& x : p) x *= scale;
      }
      expect_places_in_a_grid(scaled, counts);
    }
  }
  for (const std::size_t count : counts) EXPECT_GT(count, 200U);
}

// The refined mesh of a run, with the part of the surface that its faces cover.
void expect_places_of_a_run(const delmesher::Surface& input, bool chamfered) {
  delmesher::Options options = samples::split_surface();
  options.want_exact = true;
  options.tau = 0x1p-9;
  const delmesher::Result run = delmesher::tetrahedralize(input, options);
  ASSERT_TRUE(run.status.ok());
  ASSERT_EQ(!run.exact.corners.empty(), chamfered);
  const Polyhedron polyhedron = samples::to_polyhedron(input);
  ExactPoints points;
  ASSERT_EQ(points.assign(run.exact.points, run.exact.planes), "");
  InputSurface surface;
  ASSERT_EQ(surface.assign(polyhedron, points), "");
  TetComplex complex{&points, {}, {}, 0, 0};
  for (const auto& tet : run.exact.refined) complex.tetrahedra.push_back(tet.vertices);
  Neighbours neighbours;
  ASSERT_TRUE(check_complex(complex, neighbours).passed());
  const RefinedMesh mesh = {&run.exact,
                            &points,
                            &surface,
                            &complex,
                            &neighbours,
                            nullptr,
                            static_cast<Index>(polyhedron.vertices.size())};
  const Cover cover = cover_of(mesh);
  // Without chamfers and filter the faces of the mesh cover all of the surface.
  ASSERT_EQ(cover.triangles.empty(), !chamfered);
  const Places places(*mesh.complex, *mesh.neighbours, *mesh.surface,
                      [&mesh] { return cover_of(mesh); });
  std::array<std::size_t, 3> counts{};
  for (std::size_t t = 0; t < complex.tetrahedra.size(); ++t) {
    const Place place = places.of(t);
    ASSERT_EQ(place, alone(points, surface, complex.tetrahedra[t])) << complex.tet_name(t);
    ++counts[static_cast<std::size_t>(place)];
  }
  EXPECT_EQ(counts[static_cast<std::size_t>(Place::crossed)] > 0, chamfered);
  EXPECT_GT(counts[static_cast<std::size_t>(Place::inside)], 5U);
  EXPECT_GT(counts[static_cast<std::size_t>(Place::outside)], 5U);
}

TEST(Places, OfARunAreThoseOfEachTetrahedronAlone) {
  expect_places_of_a_run(samples::to_surface(samples::l_shape().input), false);
  expect_places_of_a_run(samples::wedge_and_slab(), true);
  expect_places_of_a_run(samples::random_voxels(5), false);
}

}  // namespace
}  // namespace tetproof::places_test
