// delmesher: graded tetrahedral meshes of closed triangulated surfaces, exactly conforming.
//
// An implementation of "Surface chamfering for robust tetrahedral meshing"; section numbers in
// comments are the paper's. The library is reentrant: it has no globals, reports errors as values
// and may run in any number of threads on different inputs. delmesher_plane.h is the same in the
// plane.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "delmesher/exact_record.h"
#include "delmesher/run.h"
#include "delmesher/statistics.h"
#include "delmesher/surface.h"
#include "delmesher/surface_report.h"

namespace delmesher {

inline constexpr double kPlanarAuto = -1;

// Where the default departs from what the paper says: true takes the paper's way. Each is a choice
// of its own (docs/paper.md). The angle bound of the refined mesh and the conformity of the final
// one hold with any of them.
struct AsPaper {
  // Section 4.1: chamfers reach at most a third of the way to the link, that is, to the opposite
  // edges of the triangles at a vertex and to the opposite vertices of those at an edge. Otherwise
  // to the boundary of the facets there, which is farther away.
  bool link = false;
  // Section 4.2: every triangle at a chamfered vertex has a bridge of its own, as wide as it is.
  // Otherwise every corner of a facet has one, and one for each part of at most 120 degrees of a
  // wider corner. Implies `link`, which keeps the bridges of narrow triangles apart.
  bool bridges = false;
  // Section 4.4: bridges are simplified unless that makes a new acute angle. Otherwise also not
  // where that brings them much nearer to the vertex that they cut off.
  bool simplification = false;
  // Section 5.4: the bad tetrahedron with the largest radius-edge ratio is split first. Otherwise
  // the last one found within a fourth of a doubling of the squared ratio.
  bool order = false;
  // Section 5.6: bad tetrahedra are split at their circumcentre. Otherwise at an off-centre, nearer
  // to the shortest edge, where that is inside the circumball.
  bool steiner_point = false;
  // Section 6: all vertices of the refined mesh outside the chamfers are vertices of the final one,
  // those on artificial segments and those close to dropped facets, too.
  bool kept_points = false;
  // Section 6: the surface is always enriched. Otherwise a small solid that meets the bound without
  // any further point is left without.
  bool enrichment = false;
  // Section 7, first step: both sides of every pair that is too close are dropped. Otherwise, pair
  // by pair, the side that costs less.
  bool filter_pairs = false;
  // Section 7, second step: features that chamfering made smaller than tau, and both sides of them.
  // Otherwise smaller than a 16th of tau, and the side that costs less.
  bool filter_chamfered = false;
  // Sections 4 and 5 as the options say, even where the refinement may not end; without limits it
  // may then run for ever. Otherwise a guard makes them stricter there.
  bool no_guard = false;

  bool operator==(const AsPaper&) const = default;
};

// A choice by the name that the command line and the statistics have for it.
struct NamedChoice {
  const char* name;
  bool AsPaper::*member;
};
inline constexpr NamedChoice kPaperChoices[] = {{"link", &AsPaper::link},
                                                {"bridges", &AsPaper::bridges},
                                                {"simplification", &AsPaper::simplification},
                                                {"order", &AsPaper::order},
                                                {"steiner-point", &AsPaper::steiner_point},
                                                {"kept-points", &AsPaper::kept_points},
                                                {"enrichment", &AsPaper::enrichment},
                                                {"filter-pairs", &AsPaper::filter_pairs},
                                                {"filter-chamfered", &AsPaper::filter_chamfered},
                                                {"no-guard", &AsPaper::no_guard}};

// Angles are degrees, lengths are in the units of the input. kBounds says which values make sense.
struct Options : Limits {
  // Every face angle of the refined mesh is at least this (degrees, section 5.4). 14.47 is a
  // radius-edge ratio of 2; above it the bound is best effort and insertions are capped.
  double delta = 14.47;
  // Input filter (section 7): facets closer than this fraction of the bounding-box diagonal are
  // left to the final step. 0 turns the filter off.
  double tau = 1e-4;
  // Tetrahedra wanted at most: if more are predicted, tau is doubled until it fits. The final mesh
  // conforms all the same. It may still be larger, because the prediction is within a factor of 3
  // for nine models in ten only. 0: no budget.
  std::uint64_t budget = 0;
  // Corners with an angle below this (degrees) are chamfered; 90 is the paper's, with its proof.
  double acute = 60;
  // The threshold for the angle between two edges at a corner, where it is smaller than `acute`. It
  // may be, because segments that are split at equal distances from their common end do not
  // encroach each other, however acute their angle is.
  double corner = 20;
  // Split constraints until their open diametral balls are empty, as the paper does (sections 5.2
  // and 5.3). Otherwise they are split where the Delaunay tetrahedrization lacks them and where
  // volume points encroach them, which takes fewer tetrahedra.
  bool gabriel = false;
  // Fewer and better tetrahedra on the same surface, by local operations (section 8.3).
  bool improve = true;
  // Treat slivers in the refinement (section 5.7). Where meshes are improved it brings rounder
  // tetrahedra on average, a fifth more of them, and hardly better worst ones
  // (improve/README.md).
  bool slivers = false;
  bool approximate = false;      // stop before the enriched CDT (section 6)
  bool simplify_bridges = true;  // section 4.4
  double chamfer_radius = 0;     // largest chamfer distance, in input units; 0: no bound
  // Triangles that are coplanar but for rounding are one facet: the surface may deviate by this
  // fraction of the diagonal between the vertices and edges of such facets, which it keeps. 0: the
  // surface as given, to the last bit. kPlanarAuto: as little as it takes for what is bent by less
  // than 2^-20 of the diagonal, at most 2^-18.
  double planar = kPlanarAuto;
  double max_edge = 0;  // largest edge wanted inside, in input units; 0: no bound
  AsPaper as_paper;
  Region region = Region::interior;
  bool want_exact = false;      // fill Result::exact
  bool want_chamfered = false;  // fill Result::chamfered
};

// A tetrahedral mesh; every tetrahedron (a, b, c, d) has det(b-a, c-a, d-a) > 0 unless
// Statistics::rounding says otherwise.
struct TetMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint8_t> inside;  // per tetrahedron: 1 if contained in the solid
  // Per tetrahedron, of meshes from elsewhere; empty: 1 inside the solid, 2 outside.
  std::vector<std::int32_t> regions;
  // Triangles tiling the input surface, counter-clockwise seen from outside the solid, with the
  // label of the input and the id of the facet they tile (its smallest input triangle index).
  std::vector<std::array<std::uint32_t, 3>> boundary;
  std::vector<std::int32_t> boundary_labels;
  std::vector<std::uint32_t> boundary_facets;
};

struct Result {
  Status status;
  std::vector<std::string> warnings;  // e.g. "the surface was inside out and has been flipped"
  TetMesh mesh;                       // empty unless status.ok()
  Surface chamfered;                  // if Options::want_chamfered: rounded, for display
  ExactRecord exact;                  // if Options::want_exact
  Statistics statistics;
};

// Meshes a closed, manifold, oriented, non-self-intersecting surface (algorithm 2). Never throws:
// what goes wrong is in Result::status, with a message that names the option, vertex or triangle.
Result tetrahedralize(const Surface& surface, const Options& options = {});

// Constrained Delaunay tetrahedrization of the convex hull of a valid surface, no quality
// (Diazzi et al. 2023; Si and Gaertner 2011). Uses region, limits, progress, want_exact.
Result constrained_delaunay(const Surface& surface, const Options& options = {});

// Fewer and better tetrahedra, by local operations (section 8.3), on a conforming mesh of whatever
// origin. Kept to the last bit: the triangles of `mesh.boundary`, the faces that one tetrahedron
// has, those between tetrahedra of different regions or sides, and the vertices of all these. Every
// tetrahedron counts, inside or not; no dihedral angle below 17 degrees (or above 163), and no face
// angle below `delta` is made, unless there was one as bad. Vertices of no tetrahedron are dropped.
// Uses delta, max_edge (no longer edge is made) and limits. `inside` may be empty, then all are
// inside; so may labels and facets. Statistics::refined is of the mesh as given, `final` of the
// result; `rounding_flat` counts flat tetrahedra that are left, as there may be some in the mesh
// given. What is not conforming, by exact signs, is refused with StatusCode::invalid_mesh; but
// whether tetrahedra without a common face overlap is not asked.
Result improve_mesh(const TetMesh& mesh, const Options& options = {});

// Decides exactly whether a surface is valid input. Angles are judged with options.acute.
SurfaceReport check_surface(const Surface& surface, const Options& options = {});

// The paper's parameters (sections 4 and 5) and choices: delta 14.47, tau 1e-4, chamfers up to 90
// degrees, empty diametral balls, everything down to the outer box, all of AsPaper.
Options paper_options();

// Which values of an option make sense; others are StatusCode::invalid_options. The command line
// refuses the same ones, and 0 where that means none: there the option is left out.
struct Bounds {
  double low, high;
  bool above_low = false;  // low itself is no such value

  constexpr bool allow(double x) const {  // not a NaN
    return (above_low ? x > low : x >= low) && x <= high;
  }
};
inline constexpr double kNoBound = HUGE_VAL;
struct OptionBounds {
  Bounds delta, tau, acute, corner;
  Bounds planar{.low = 0, .high = 0.01};      // or kPlanarAuto
  Bounds length{.low = 0, .high = kNoBound};  // chamfer_radius and max_edge
  Bounds seconds{.low = 0, .high = kNoBound};
  Bounds budget{.low = 0, .high = 1e15};
  Bounds max_vertices{.low = 0, .high = 4294967294};  // the largest index
  Bounds threads{.low = 0, .high = 1024};
};
inline constexpr OptionBounds kBounds{.delta = {.low = 0, .high = 30, .above_low = true},
                                      .tau = {.low = 0, .high = 1},
                                      .acute = {.low = 0, .high = 90},
                                      .corner = {.low = 0, .high = 90}};

// Version of the library, "MAJOR.MINOR.PATCH".
const char* version();

}  // namespace delmesher
