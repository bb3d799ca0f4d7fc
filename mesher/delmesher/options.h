// The options of each job: a struct with the members that the job uses, and no others.
//
// Angles are degrees, lengths are in the units of the input. Every option is a row of
// option_table.h, which says which values it may have; others are StatusCode::invalid_options.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "as_paper.h"
#include "run.h"
#include "size_source.h"

namespace delmesher {

inline constexpr double kPlanarAuto = -1;
inline constexpr double kSizeAuto = -1;

// What becomes of the triangles of the surface.
enum class SurfaceChoice : std::uint8_t {
  split,  // vertices are added to it where angles call for them
  keep,  // each is one face of the mesh, and no vertex is added: few tetrahedra, no bound on angles
  // Split, unless that is predicted to take more than four times the tetrahedra of a kept surface.
  // Then it is kept, but for edges longer than asked for, which are halved.
  automatic
};

// What the triangles bound, and what of it is written.
enum class Regions : std::uint8_t {
  // One solid: they are closed, manifold surfaces, and what an odd number of them surrounds is in.
  solid,
  // Every bounded part of space that they divide off is a region of its own, with all triangles as
  // faces of the mesh: walls between regions, and open sheets within one. They are any set that
  // meets in common vertices and edges alone. The surface is kept.
  all,
  largest,  // the same, but only the region of the largest volume is written
  named     // and only those of Options::region_names
};

// Of walls between regions, and of sheets.
enum class SplitWalls : std::uint8_t {
  none,
  all,
  named  // those of Options::split_wall_names
};

// Of the regions of this name.
struct RegionSize {
  std::string region;
  double max_edge = 0;  // no longer edge in them
};

// Refined until no edge is longer than this, a mesh has edges of length 1 on average (0.96 to 1.02
// on 14 of 20 real models at a 40th of the diagonal, 98 % of them between 0.6 and 1.4).
inline constexpr double kMostOfSize = 1.45;

// A point that tells of the region around it, as in TetGen's .poly.
struct RegionPoint {
  std::array<double, 3> point;
  std::string name = {};  // what the region is called; empty: as it is without
  double max_edge = 0;    // no longer edge in it; 0: any
  bool is_hole = false;   // it is not written
};

// Of tetrahedralize().
struct Options : Limits {
  // The surface that is meshed may be another one: no point of either is farther from the other,
  // with the same topology. A length; if negative, minus a fraction of the bounding box's diagonal.
  // 0: the surface as given.
  double tolerance = 0;
  // With a tolerance: edges that bend by more, however vertices move by half of it, stay lines
  // within it, as borders of labels and edges of other than two triangles do; where lines end,
  // meet, or bend by as much, vertices stay.
  double feature = 40;
  // A surface is kept with the options that have Text::with_kept_surface in option_table.h; the
  // others have to be as they are by default. `automatic` is `split` with them.
  SurfaceChoice surface = SurfaceChoice::automatic;
  Regions regions = Regions::solid;
  std::vector<std::string> region_names;
  // With other Regions than solid: the two sides of these walls get vertices of their own, except
  // where they hang together elsewhere, as on the border of a sheet. They are called by the regions
  // beside them, as in copper|air, or like a label.
  SplitWalls split_walls = SplitWalls::none;
  std::vector<std::string> split_wall_names;
  // What labels are called: a region has the name of the solid that it lies in.
  std::map<std::int32_t, std::string> label_names;
  // With other Regions than solid. One that lies in no region, or on a wall between two, gives a
  // warning.
  std::vector<RegionPoint> region_points;
  // A vertex on a kept surface that finds no way off it ends the run with Limit::precision. It is
  // counted otherwise.
  bool strict = false;
  // Every face angle of the refined mesh is at least this (section 5.4). 14.47 is a radius-edge
  // ratio of 2; above it the bound is best effort and insertions are capped.
  double delta = 14.47;
  // Input filter (section 7): facets closer than this fraction of the bounding-box diagonal are
  // left to the final step. 0 turns the filter off. With SurfaceChoice::automatic it is 1e-9 where
  // that takes few tetrahedra.
  double tau = 1e-4;
  // Tetrahedra at most: Limit::budget ends the run where there would be more, with
  // SurfaceChoice::automatic even if the surface is kept. With kSizeAuto there are kFullBudget of
  // them, unless none of six lengths of edges makes so many; but not with planar 0, approximate or
  // another region. 0: any number.
  std::uint64_t budget = 0;
  // Corners with an angle below this are chamfered. The paper's proof needs 90.
  double acute = 60;
  // The threshold for corners between two edges, if it is smaller than `acute`. A smaller threshold
  // does no harm there: the two segments are split at equal distances from their common end, and
  // then they do not encroach each other, however acute their angle is.
  double corner = 20;
  // Split constraints until their open diametral balls are empty, as the paper does (sections 5.2
  // and 5.3). Otherwise they are split where the Delaunay tetrahedrization lacks them and where
  // volume points encroach them, which takes fewer tetrahedra.
  bool gabriel = false;
  // Fewer and better tetrahedra on the same surface, by local operations (section 8.3).
  bool improve = true;
  // Treat slivers in the refinement (section 5.7). The improvement then has less to mend, and ends
  // with rounder tetrahedra and better worst ones, for a tenth more of them (docs/measurements).
  bool slivers = true;
  bool approximate = false;      // stop before the enriched CDT (section 6)
  bool simplify_bridges = true;  // section 4.4
  double chamfer_radius = 0;     // how far a chamfer may reach; 0: no bound
  // Triangles that are coplanar up to rounding become one facet. The surface keeps the vertices
  // and edges of such facets; in between it may deviate by this fraction of the bounding box's
  // diagonal. 0: the surface as given, to the last bit; if meshes are improved, such triangles are
  // one facet while they are refined, and the edges between them come back at the end. kPlanarAuto:
  // as little as it takes for triangles that are bent by less than 2^-20 of the diagonal, at most
  // 2^-18; where coordinates were rounded to few digits, six times what that moves a point off a
  // plane (planar/flatness.h, planar/resolution.h), and where edges show more noise, 16 times
  // that (planar/edge_bends.h), at most 2^-12.
  double planar = kPlanarAuto;
  double max_edge = 0;                   // largest edge wanted inside; 0: no bound
  std::vector<RegionSize> region_sizes;  // smaller ones in regions, with other Regions than solid
  // Length that edges shall have on average: none is longer than kMostOfSize times it. Where the
  // surface has shorter ones, or features that ask for them, edges are shorter. 0: any. kSizeAuto:
  // a tenth of the bounding box's diagonal, or down to a twentieth in parts as thin as that, where
  // this makes more than twice the tetrahedra of any, which are too few for a solver, and no other
  // option says how many there shall be; with a budget what fills it; else any.
  double size = kSizeAuto;
  // Smaller edges in places: nowhere along an edge inside is it longer than size + size_growth *
  // distance, of any of these sources and its distance. Empty: no bound.
  std::vector<SizeSource> size_field;
  double size_growth = 0.3;
  AsPaper as_paper;
  Region region = Region::interior;
  bool want_exact = false;      // fill Result::exact
  bool want_chamfered = false;  // fill Result::chamfered
};

// Of constrained_delaunay().
struct CdtOptions : Limits {
  Region region = Region::hull;
  bool want_exact = false;  // fill Result::exact
};

// Of remesh_surface().
struct RemeshOptions : Limits {
  double tolerance = -1e-3;            // as in Options; not 0
  double feature = 40;                 // as in Options
  double max_edge = 0;                 // edges that are longer are split; 0: no bound
  double size = 0;                     // as in Options, but for kSizeAuto
  std::vector<SizeSource> size_field;  // as in Options
  double size_growth = 0.3;
};

// Of improve_mesh().
struct ImproveOptions : Limits {
  double delta = 14.47;                // no smaller face angle is made
  double max_edge = 0;                 // no longer edge is made; 0: no bound
  std::vector<SizeSource> size_field;  // as in Options: no longer edge is made
  double size_growth = 0.3;
};

// Of triangulate_polygon().
struct PlaneOptions : TimeLimit {
  double delta = 20.7;  // smallest angle; guaranteed up to this
  // The narrowest channel between two segments, as a fraction of its length, that is refined. 0:
  // none is too narrow.
  double tau = 1e-4;
  double acute = 60;          // corners with an angle below this are chamfered
  bool approximate = false;   // stop before the input is restored
  double chamfer_radius = 0;  // how far a chamfer may reach; 0: no bound
  double max_edge = 0;        // largest edge wanted inside; 0: no bound
  PlaneAsPaper as_paper;
  Region region = Region::interior;
  // 0: 1e7 and 64 more per input vertex, and no more than 5e6 triangles predicted in channels.
  std::uint64_t max_vertices = 0;
  bool want_exact = false;      // fill PlaneResult::exact
  bool want_chamfered = false;  // fill PlaneResult::chamfered
};

// Of check_surface().
struct CheckOptions : TimeLimit {
  double acute = 60;                       // corners with an angle below this are acute
  double corner = 20;                      // the same for corners between two edges
  double planar = kPlanarAuto;             // as in Options: the facets that are counted
  unsigned threads = 1;                    // as in Limits
  bool want_regions = false;               // fill SurfaceReport::complex
  std::vector<RegionPoint> region_points;  // as in Options
};

// Of repair_surface().
struct RepairOptions {
  // Vertices no farther apart than this become one, the first of them. Equal ones do in any case.
  double weld = 0;
  // Fill the holes that are planar within 1e-6 of the diagonal, or no wider than a twentieth of it.
  bool fill = false;
  unsigned threads = 1;  // of the check that the command line makes afterwards
};

// The share of Options::budget that is to be made at least.
inline constexpr double kFullBudget = 0.9;

// No edge is to be longer, by max_edge and size; 0: any may be.
template <class JobOptions>
double bound_on_edges(const JobOptions& options) {
  const double most = kMostOfSize * options.size;
  const bool by_size = options.size > 0 && !(options.max_edge > 0 && options.max_edge < most);
  return by_size ? most : options.max_edge;
}

}  // namespace delmesher
