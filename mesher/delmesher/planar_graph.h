// The plane: graded triangulations of planar straight-line graphs (section 3).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "exact_record.h"
#include "run.h"

namespace delmesher {

// The segments of a planar straight-line graph cut the plane into faces. Which of them are inside?
enum class Insideness : std::uint8_t {
  enclosed,  // every face but the unbounded one and those with a hole point (Shewchuk's Triangle)
  nested     // faces separated from the unbounded one by at least an odd number of segments
};

// A planar straight-line graph. Coordinates are taken as exact numbers. Segments may meet at common
// vertices only (or where a vertex lies on a segment, which splits it); vertices are distinct.
// Segments with the same face on both sides, and vertices without segments, are constraints inside.
struct PlanarGraph {
  std::vector<std::array<double, 2>> vertices;
  std::vector<std::array<std::uint32_t, 2>> segments;
  std::vector<std::int32_t> markers;         // one per segment; empty means that all are 0
  std::vector<std::uint8_t> partitions;      // `nested`: 1 if a segment only divides (empty: none)
  std::vector<std::array<double, 2>> holes;  // `enclosed`: a point in each hole, on no segment
  struct Region {
    std::array<double, 2> point;  // its face gets the attribute
    double attribute;
  };
  std::vector<Region> regions;
  Insideness insideness = Insideness::enclosed;
};

// Why a graph cannot be meshed as it is.
enum class GraphDefect : std::uint8_t {
  equal_vertices,  // two vertices at the same place
  no_length,       // a segment
  overlap,         // two segments that have a part in common, and are not equal
  crossing         // two segments
};
inline constexpr std::size_t kGraphDefects = 4;

struct GraphReport {
  Status status;                      // ok, invalid_surface, interrupted ...
  std::vector<std::string> warnings;  // of what is mended or left out when it is meshed
  std::vector<std::string> hints;     // what to do; commands are in backticks
  // By GraphDefect: two vertices, or two segments; a single one stands twice. At most a million.
  std::array<std::vector<std::array<std::uint32_t, 2>>, kGraphDefects> places;
  double bbox_diagonal = 0, area = 0;  // of the inside, rounded
};

struct GraphRepairResult {
  Status status;
  PlanarGraph graph;
  std::vector<std::string> done;  // the changes, a line each: "12 vertices merged ..."
};

// A triangulation; every triangle is counter-clockwise unless PlaneStatistics::rounding_* say
// otherwise.
struct PlaneMesh {
  std::vector<std::array<double, 2>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> inside;  // per triangle: 1 if contained in the inside of the graph
  std::vector<double> attributes;    // per triangle: of its region, 0 if none; empty: no regions
  // The edges that tile the segments, with the marker and the index of the input segment.
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::int32_t> edge_markers;
  std::vector<std::uint32_t> edge_segments;
};

// The exact form of a run in the plane. Points are ExactPoints with z = 0.
struct PlaneRecord {
  std::vector<ExactPoint> points;  // the input vertices first, in input order
  struct Corner {                  // a chamfered input vertex
    std::uint32_t vertex;
    double distance;  // chamfer distance along its segments, rounded to nearest
  };
  std::vector<Corner> corners;
  std::vector<std::uint32_t> dropped;  // input segments that the refinement was spared
  double delta = 0;                    // degrees: the bound that `refined` is guaranteed to keep
  double acute = 0;                    // degrees: corners below it were chamfered
  enum class Side : std::uint8_t { outside, inside, mixed };
  struct Triangle {
    std::array<std::uint32_t, 3> vertices;
    Side side;  // mixed: a part of a segment that separates and was cut out runs through it
  };
  struct Edge {
    std::array<std::uint32_t, 2> vertices;
    std::uint32_t segment;  // input segment, or 0xffffffff for the outer box
  };
  std::vector<Triangle> refined;  // every triangle down to the outer box
  std::vector<Edge> refined_edges;
  std::vector<Triangle> final;
  std::vector<Edge> final_edges;
  // Indices into `points` of the vertices of PlaneMesh, in its order.
  std::vector<std::uint32_t> mesh_vertices;
};

// Size and angles of a triangulation, in degrees, over the triangles that Options::region covers.
struct PlaneMeshStatistics {
  std::uint64_t vertices = 0, triangles = 0, interior_triangles = 0, edges = 0;
  double min_angle = 0, max_angle = 0;
  double mean_min_angle = 0, mean_max_angle = 0;    // per triangle
  std::array<std::uint64_t, 12> angle_histogram{};  // 15-degree bins
};

struct PlaneStatistics {
  std::array<double, kPhaseCount> phase_seconds{};
  double bbox_diagonal = 0;
  PlaneMeshStatistics refined, final;
  std::uint64_t dropped_segments = 0, filter_rounds = 0;
  std::uint64_t acute_vertices = 0, chamfered_segments = 0;
  double guaranteed_delta = 0;  // degrees
  std::uint64_t steiner_on_segments = 0, steiner_in_faces = 0;
  std::uint64_t rounding_inverted = 0, rounding_flat = 0, rounding_repaired = 0;
  double max_segment_deviation = 0;  // input units
  std::uint64_t predicate_filter = 0, predicate_exact = 0, predicate_symbolic = 0;
};

}  // namespace delmesher
