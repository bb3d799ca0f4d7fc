// The report of check_surface(): validity, defects and properties of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "run.h"
#include "tet_mesh.h"

namespace delmesher {

// One place where a surface is not a valid one: closed, manifold, oriented, free of intersections.
struct Defect {
  enum class Kind : std::uint8_t {
    non_finite,                // vertex
    index_out_of_range,        // triangle
    empty,                     // no triangles
    degenerate_triangle,       // triangle: repeated vertex or collinear corners
    open_edge,                 // edge of one triangle
    non_manifold_edge,         // edge of more than two triangles
    non_manifold_vertex,       // triangles around the vertex do not form one fan
    inconsistent_orientation,  // edge traversed twice in the same direction
    duplicate_triangle,        // two triangles with the same corners
    self_intersection          // two triangles meeting outside a shared vertex or edge
  };
  Kind kind;
  std::vector<std::uint32_t> vertices, triangles;  // the offending elements
  std::string message;  // one line naming them, e.g. "triangles 12 and 840 intersect"
};

// The regions that a complex of triangles bounds; 0 is the outside.
struct ComplexReport {
  std::vector<MeshRegion> regions;  // number N is regions[N - 1]
  // The triangles between two regions, the smaller number first.
  struct Wall {
    std::array<std::int32_t, 2> regions;
    std::uint64_t triangles = 0;
    double area = 0;
  };
  std::vector<Wall> walls;
  // Triangles of a label that are not closed and have one region on both sides: a sheet, or a solid
  // with a leak. One of their border edges.
  struct Open {
    std::int32_t label, region;
    std::array<std::array<double, 3>, 2> border;
  };
  std::vector<Open> open;
};

// Defects and properties of a surface.
struct SurfaceReport {
  Status status;                // ok, invalid_surface, interrupted ...
  std::vector<Defect> defects;  // described: at most ten of each kind; counts below are complete
  std::array<std::uint64_t, 10> defect_counts{};  // indexed by Defect::Kind
  // All of them, by Defect::Kind: at vertices the vertex, at edges its two ends, at triangles the
  // triangle, of two triangles both; a single number stands twice. Of a kind with more than a
  // million some are left out, and a warning says so.
  std::array<std::vector<std::array<std::uint32_t, 2>>, 10> places;
  std::vector<std::string> warnings;
  bool flipped = false;  // the surface was inside out
  std::uint64_t vertices = 0, triangles = 0, components = 0, unused_vertices = 0;
  std::int64_t euler_characteristic = 0;
  double bbox_diagonal = 0, volume = 0;  // volume of the solid, rounded
  // `facets`: of the surface as given. `planar_facets`: with triangles that are coplanar up to
  // `planar_bound` taken as one facet; acute vertices and edges are counted between these.
  std::uint64_t facets = 0, planar_facets = 0, acute_vertices = 0, acute_edges = 0;
  double planar_bound = 0;                 // in input units
  double smallest_local_feature_size = 0;  // distance of the closest non-incident elements
  // If CheckOptions::want_regions, and the surface is not one solid, but a complex.
  ComplexReport complex;
};

// Name of a kind of defect: "open edge", "self-intersection", ...
const char* defect_name(Defect::Kind kind);

}  // namespace delmesher
