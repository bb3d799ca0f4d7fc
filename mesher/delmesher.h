// delmesher: graded tetrahedral meshes of closed triangulated surfaces, exactly conforming.
//
// The sole public header. An implementation of "Surface chamfering for robust tetrahedral meshing";
// section numbers in comments are the paper's. The library is reentrant: it has no globals, reports
// errors as values and may run in any number of threads on different inputs.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace delmesher {

// ---------------------------------------------------------------------------------------- input

// A triangulated surface. Coordinates are taken as exact numbers.
struct Surface {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
  std::vector<std::int32_t> labels;  // one per triangle; empty means that all are 0
};

// Which tetrahedra are guaranteed good and written.
enum class Region : std::uint8_t {
  interior,  // those contained in the solid; a bad tetrahedron disjoint from it is left alone
  hull       // everything down to the outer box
};

// The stages of a run, in the order of the statistics.
enum class Phase : std::uint8_t {
  read,
  check,
  filter,
  chamfer,
  delaunay,
  segments,
  facets,
  refine,
  enrich,
  classify,
  round,
  write
};
inline constexpr std::size_t kPhaseCount = 12;

// Name of a phase as used by the statistics ("read", "check", ...).
const char* phase_name(Phase phase);

struct Progress {
  Phase phase;
  double done;                      // fraction of the phase in [0, 1]; negative if unknown
  std::uint64_t vertices;           // present number of mesh vertices, 0 if not meaningful
  double predicted_tetrahedra = 0;  // of the final mesh, known before refinement begins; 0: not yet
};

struct Options {
  // Every face angle of the refined mesh is at least this (degrees, section 5.4). 14.47 is a
  // radius-edge ratio of 2; above it the bound is best effort and insertions are capped.
  double delta = 14.47;
  // Input filter (section 7): facets closer than this fraction of the bounding-box diagonal are
  // left to the final step. 0 turns the filter off.
  double tau = 1e-4;
  // Tetrahedra that the user can do with: if more are predicted, tau is doubled until it fits. The
  // final mesh conforms all the same, and may still be larger, because it is predicted within a
  // factor of 3 only (of nine models in ten). 0: no budget.
  std::uint64_t budget = 0;
  // Corners with an angle below this (degrees) are chamfered; 90 is the paper's, with its proof.
  double acute = 60;
  // The same, if smaller, for the angle of two edges, of one facet or not: segments that are split
  // at equal distances from their common end do not encroach each other, however acute their angle.
  double corner = 20;
  // Split constraints until their open diametral balls are empty, as the paper does (sections 5.2
  // and 5.3). Otherwise they are split where the Delaunay tetrahedrization lacks them and where
  // volume points encroach them, which takes fewer tetrahedra.
  bool gabriel = false;
  bool slivers = true;           // treat slivers (section 5.7)
  bool approximate = false;      // stop before the enriched CDT (section 6)
  bool simplify_bridges = true;  // section 4.4
  double chamfer_radius = 0;     // largest chamfer distance, in input units; 0: no bound
  double max_edge = 0;           // largest edge wanted inside, in input units; 0: no bound
  Region region = Region::interior;
  std::uint64_t max_vertices = 0;  // 0: no limit
  double time_limit_seconds = 0;   // 0: no limit
  // Threads that share what can be shared: checks, filter, classification of the refined mesh and
  // statistics; the result is the same for every number. 0: as many as the machine has cores.
  unsigned threads = 1;
  bool want_exact = false;      // fill Result::exact
  bool want_chamfered = false;  // fill Result::chamfered
  // Called several times a second from the calling thread; false, or any exception, cancels it.
  std::function<bool(const Progress&)> progress;
};

// --------------------------------------------------------------------------------------- result

enum class StatusCode : std::uint8_t {
  ok,
  invalid_options,  // the message names the option
  invalid_surface,  // the message names the vertices, edges or triangles
  limit_reached,    // vertices, time, memory or the precision of doubles
  interrupted,      // the progress callback returned false
  internal_error    // a bug; the message says where
};

enum class Limit : std::uint8_t {
  none,
  size,      // Options::max_vertices, a budget, or what indices can number
  time,      // Options::time_limit_seconds
  memory,    // an allocation failed
  precision  // features are too close to each other for what doubles can express
};

struct Status {
  StatusCode code = StatusCode::ok;
  std::string message;
  Limit limit = Limit::none;  // which one, where code is limit_reached
  bool ok() const { return code == StatusCode::ok; }
};

// A tetrahedral mesh; every tetrahedron (a, b, c, d) has det(b-a, c-a, d-a) > 0 unless
// Statistics::rounding says otherwise.
struct TetMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<std::uint8_t> inside;  // per tetrahedron: 1 if contained in the solid
  // Triangles tiling the input surface, counter-clockwise seen from outside the solid, with the
  // label of the input and the id of the facet they tile (its smallest input triangle index).
  std::vector<std::array<std::uint32_t, 3>> boundary;
  std::vector<std::int32_t> boundary_labels;
  std::vector<std::uint32_t> boundary_facets;
};

// How a point is given exactly; i, j, k are indices of explicit points of the same list.
struct ExactPoint {
  enum class Kind : std::uint8_t {
    explicit_point,  // (x, y, z)
    on_segment,      // t p_i + (1 - t) p_j, t = x
    on_triangle      // u p_i + v p_j + (1 - u - v) p_k, u = x, v = y
  };
  Kind kind = Kind::explicit_point;
  std::uint32_t i = 0, j = 0, k = 0;
  double x = 0, y = 0, z = 0;
};

// The exact form of a run (command-line option --exact): everything an independent program needs
// to decide every claim without rounding. Point indices are into `points`.
struct ExactRecord {
  struct Parameters {  // what the run promised
    double delta = 0;  // face angles of the refined mesh, degrees; 0: not recorded
    double acute = 0;  // corners are chamfered below this, where none of `corners` says otherwise
    // The same for two edges at a vertex that is not chamfered; 0: as acute.
    double corner = 0;
    double tolerance = 0;  // of the filter, in input units
    Region region = Region::interior;
    bool gabriel = true;  // no vertex is in the open diametral ball of a constraint
  } parameters;
  std::vector<ExactPoint> points;  // the input vertices first, in input order
  struct Facet {
    std::uint32_t id;  // smallest input triangle index
    std::int32_t label;
    // 0: kept. Dropped by the filter: 1 for what is too close in the input, 2 for what chamfering
    // made of that, after all of 1.
    std::uint8_t filtered;
    std::vector<std::uint32_t> triangles;  // input triangles
  };
  std::vector<Facet> facets;
  struct Chain {                          // a straight (input) or nearly straight edge
    bool artificial;                      // created by the chamfering
    std::uint32_t facet;                  // for artificial ones: the facet's id
    std::vector<std::uint32_t> vertices;  // from end to end, in the refined mesh
  };
  std::vector<Chain> segments;
  struct Corner {  // a chamfered input vertex
    std::uint32_t vertex;
    double threshold;  // degrees: 60, or 90 where the guard fell back
    double radius;     // chamfer distance along its edges, rounded to nearest
  };
  std::vector<Corner> corners;
  // Points made by chamfering, each with the input vertex that it was made for.
  std::vector<std::array<std::uint32_t, 2>> chamfer_points;
  struct Tet {
    std::array<std::uint32_t, 4> vertices;
    bool inside;
  };
  std::vector<Tet> refined;  // every tetrahedron down to the outer box
  std::vector<std::array<std::uint32_t, 4>> refined_facets;  // a, b, c, facet id
  struct Ball {  // a volume Steiner point and the tetrahedron in whose circumball it was put
    std::uint32_t vertex;
    std::array<std::uint32_t, 4> tetrahedron;
  };
  std::vector<Ball> balls;
  std::vector<Tet> final;
  std::vector<std::array<std::uint32_t, 4>> final_facets;  // a, b, c, facet id
  // `final` before local repairs of rounding; empty if there were none.
  std::vector<Tet> unrepaired;
  // `final_facets` then; empty if they were the same.
  std::vector<std::array<std::uint32_t, 4>> unrepaired_facets;
  // Indices into `points` of the vertices of TetMesh, in its order.
  std::vector<std::uint32_t> mesh_vertices;
};

// Size and angles of a mesh, in degrees; angles over the tetrahedra that Options::region covers.
struct MeshStatistics {
  std::uint64_t vertices = 0, tetrahedra = 0, interior_tetrahedra = 0;
  double min_face_angle = 0, max_face_angle = 0, min_dihedral = 0, max_dihedral = 0;
  double mean_min_face_angle = 0, mean_max_face_angle = 0;  // per face
  double mean_min_dihedral = 0, mean_max_dihedral = 0;      // per tetrahedron
  std::array<std::uint64_t, 12> face_angle_histogram{};     // 15-degree bins
  std::array<std::uint64_t, 12> dihedral_histogram{};
};

struct Statistics {
  std::array<double, kPhaseCount> phase_seconds{};
  double bbox_diagonal = 0;
  MeshStatistics refined, final;
  double predicted_tetrahedra = 0;  // of the final mesh, in the region, before refinement
  double tau = 0;                   // in force: Options::tau, or more for the budget
  std::uint64_t dropped_triangles = 0, filter_rounds = 0;
  std::uint64_t acute_vertices = 0, acute_edges = 0;
  double guaranteed_acute = 0;         // threshold in force away from the fallback corners
  double guaranteed_corner = 0;        // the same for the angle of two edges
  bool gabriel = false;                // the constraints of the refined mesh have empty balls
  std::uint64_t fallback_corners = 0;  // corners where the guard fell back to 90 degrees
  std::uint64_t steiner_on_segments = 0, steiner_on_facets = 0, steiner_in_volume = 0;
  // Does the final mesh have the points of the refined one? Not where the input alone is better.
  bool enriched = true;
  std::uint64_t rounding_inverted = 0, rounding_flat = 0, rounding_repaired = 0;
  // Points of the last step taken out again where doubles are too coarse for them.
  std::uint64_t rounding_thinned = 0;
  double max_surface_deviation = 0;  // input units
  std::uint64_t predicate_filter = 0, predicate_extended = 0, predicate_exact = 0;
  std::uint64_t predicate_symbolic = 0, predicate_by_support = 0;
};

struct Result {
  Status status;
  std::vector<std::string> warnings;  // e.g. "the surface was inside out and has been flipped"
  TetMesh mesh;                       // empty unless status.ok()
  Surface chamfered;                  // if Options::want_chamfered: rounded, for display
  ExactRecord exact;                  // if Options::want_exact
  Statistics statistics;
};

// ---------------------------------------------------------------------------------------- tasks

// Meshes a closed, manifold, oriented, non-self-intersecting surface (algorithm 2).
Result tetrahedralize(const Surface& surface, const Options& options = {});

// Constrained Delaunay tetrahedrization of the convex hull of a valid surface, no quality
// (Diazzi et al. 2023; Si and Gaertner 2011). Uses region, limits, progress, want_exact.
Result constrained_delaunay(const Surface& surface, const Options& options = {});

// What is wrong with a surface, and what it is like.
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

struct SurfaceReport {
  Status status;                // ok, invalid_surface, interrupted ...
  std::vector<Defect> defects;  // at most a few of each kind; counts below are complete
  std::array<std::uint64_t, 10> defect_counts{};  // indexed by Defect::Kind
  std::vector<std::string> warnings;
  bool flipped = false;  // the surface was inside out
  std::uint64_t vertices = 0, triangles = 0, components = 0, unused_vertices = 0;
  std::int64_t euler_characteristic = 0;
  double bbox_diagonal = 0, volume = 0;  // volume of the solid, rounded
  std::uint64_t facets = 0, acute_vertices = 0, acute_edges = 0;
  double smallest_local_feature_size = 0;  // distance of the closest non-incident elements
};

// Decides exactly whether a surface is valid input. Angles are judged with options.acute.
SurfaceReport check_surface(const Surface& surface, const Options& options = {});

// ------------------------------------------------------------------------------------ the plane

// What is inside of a planar straight-line graph. Its segments cut the plane into faces.
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
    double radius;  // chamfer distance along its segments, rounded to nearest
  };
  std::vector<Corner> corners;
  std::vector<std::uint32_t> dropped;  // input segments that the refinement was spared
  double delta = 0;                    // degrees: the bound that `refined` is guaranteed to keep
  double acute = 0;                    // degrees: corners below it were chamfered
  enum class Side : std::uint8_t { outside, inside, mixed };
  struct Triangle {
    std::array<std::uint32_t, 3> vertices;
    Side side;  // mixed: what chamfering and filtering cut out of the segments runs through it
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

struct PlaneResult {
  Status status;
  std::vector<std::string> warnings;
  PlaneMesh mesh;         // empty unless status.ok()
  PlanarGraph chamfered;  // if Options::want_chamfered: rounded, for display
  PlaneRecord exact;      // if Options::want_exact
  PlaneStatistics statistics;
};

// Options with the defaults of the plane: delta is 20.7, which is guaranteed. In the plane, tau is
// the narrowest channel between two segments, as a fraction of its length, that is refined;
// slivers and simplify_bridges mean nothing; max_vertices 0 is 1e7 and 64 more per input vertex.
Options plane_options();

// Meshes the inside of a planar straight-line graph (section 3). An invalid graph is
// StatusCode::invalid_surface with a message that names the offending vertices or segments.
PlaneResult triangulate_polygon(const PlanarGraph& graph, const Options& options = plane_options());

// --------------------------------------------------------------------------------------- names

// Name of a kind of defect: "open edge", "self-intersection", ...
const char* defect_name(Defect::Kind kind);

// Version of the library, "MAJOR.MINOR.PATCH".
const char* version();

}  // namespace delmesher
