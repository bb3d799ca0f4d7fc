// Good meshes made without any mesher, for testing the oracles, and polyhedra for testing the
// mesher.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>

#include "mesher/delmesher.h"
#include "oracles/files/mesh_file.h"
#include "oracles/verify.h"

namespace tetproof::samples {

struct Sample {
  oracles::Polyhedron input;
  oracles::MeshFile mesh;
};

// Tells which cells of a grid belong to the solid.
using Cells = std::function<bool(int x, int y, int z)>;

// A solid made of cells of a `coarse`^3 grid over the unit cube. Its surface is triangulated on
// that grid; its mesh consists of six tetrahedra per cell of a grid `finer` times as fine.
// Everything is exact in doubles if both are powers of two. If `hull`, the mesh fills the cube,
// with regions 1 inside and 0 outside.
Sample grid_sample(int coarse, int finer, const Cells& solid, bool hull = false);

Sample cube();         // one cell, refined
Sample l_shape();      // six of eight cells: a concave edge
Sample hollow_cube();  // 8 of 64 cells missing inside: a cavity, nested component
Sample cube_in_hull();

// The sample under x -> A x with a matrix of rounded numbers. Facets are exact, because only
// corners define them, but vertices inside them are rounded.
Sample skewed(Sample sample);

// A tetrahedron with a point on an edge and a point on a face, given exactly.
struct ExactSample {
  Sample sample;
  delmesher::ExactRecord exact;
};
ExactSample exact_sample();

// Surfaces for the mesher, by name; all valid.
struct NamedSurface {
  std::string name;
  delmesher::Surface surface;
};
void PrintTo(const NamedSurface& model, std::ostream* stream);  // for GoogleTest
std::vector<NamedSurface> surfaces(std::uint64_t seed);

// Seeded solids that are full of degenerate configurations, and valid: some cells of a small grid,
// and a star-shaped surface with coordinates in eighths.
delmesher::Surface random_voxels(std::uint64_t seed);
delmesher::Surface quantized_star(std::uint64_t seed);

// A cube with a square fin on one side of the given length and thickness h (Figure 8's family).
delmesher::Surface finned_cube(double length, double h);

// Is the verdict exact or rounded (to 4 ulp of the largest coordinate)? The mesher owes this; a
// surface that deviates by more is not the one that was asked for.
bool exact_or_rounded(const oracles::VerifyReport& report);
// The same; or the verdict is deviating by at most the promise, if facets were made planar and the
// stand-in oracle has passed.
bool as_promised(const oracles::VerifyReport& report);

// Over a counter-clockwise triangle. Triangles 2 and 3 are the side of its first edge, and so on.
delmesher::Surface triangular_prism(const std::array<std::array<double, 2>, 3>& base, double bottom,
                                    double top);
// One component more.
void add_box(delmesher::Surface& surface, const std::array<double, 3>& low,
             const std::array<double, 3>& high);

// A wedge with an edge of 11 degrees, and a slab as thin as 2^-10 beside it, one unit long each.
delmesher::Surface wedge_and_slab();

// With them the surface is chamfered and refined, however heavy the mesh becomes.
delmesher::Options split_surface();

// The number of repetitions: `normal` times the environment's TETPROOF_ITERATIONS.
int iterations(int normal);

oracles::Polyhedron to_polyhedron(const delmesher::Surface& surface);
delmesher::Surface to_surface(const oracles::Polyhedron& polyhedron);
oracles::MeshFile to_mesh(const delmesher::TetMesh& mesh);

}  // namespace tetproof::samples
