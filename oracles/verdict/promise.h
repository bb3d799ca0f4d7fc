// The options that a mesher was asked for. Its mesh and its record are held to them. The caller
// says them, since the record cannot vouch for itself.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesher/delmesher_plane.h"
#include "oracles/verdict/report.h"

namespace tetproof::oracles {

enum class Task : std::uint8_t { mesh, cdt, plane, improve };

// Options of delmesher as docs/options.md documents them, with its defaults.
struct Promise {
  static constexpr double kPlanarAuto = -1, kSizeAuto = -1;
  // docs/planar.md: what `auto` is without evidence in the input, and the most that it is with any.
  static constexpr double kAutomatic = 0x1p-18, kMostAutomatic = 0x1p-12;

  Task task = Task::mesh;
  double delta = 14.47;         // degrees
  double tau = 1e-4;            // fraction of the diagonal of the bounding box
  double planar = kPlanarAuto;  // the same
  // What the record or the file says of itself, if it does. The verification sets it.
  std::optional<double> stated_planar = {};
  double acute = 60;          // degrees
  double corner = 20;         // degrees, as given
  double label_by_angle = 0;  // degrees; 0: labels as read
  bool gabriel = false;
  bool approximate = false;
  bool improve = true;
  // The surface was to be kept. Then the task is cdt: a tetrahedrization of the surface, which
  // local operations have changed.
  bool keep = false;
  bool may_keep = false;  // or split: the record shows which
  bool halves = false;    // of a kept surface: edges longer than promised are split
  // Every part of space that the triangles bound is a region of its own; the surface is kept.
  bool all_regions = false;
  // Of these only the largest is written, or those with one of these names.
  bool largest_region = false;
  std::vector<std::string> region_names = {};
  // The longest edge in the regions of a name, in input units.
  std::vector<std::pair<std::string, double>> region_sizes = {};
  // Whose two sides have vertices of their own.
  enum class Split : std::uint8_t { none, all, named } split_walls = Split::none;
  std::vector<std::string> split_wall_names = {};
  bool strict = false;  // without an exception
  bool names = false;   // sets are called by names of another file
  // The surface may be another one so near, in both directions: in input units, or minus a fraction
  // of the diagonal. 0: the surface as given. Edges that bend by more degrees are lines.
  double tolerance = 0, feature = 40;
  bool second_order = false;  // ten-node tetrahedra, in formats that have them
  // No oracle looks at these, but where one is not so the surface may not be kept.
  bool slivers = true, simplify_bridges = true, save_chamfered = false;
  // The choices of --as-paper that an oracle can see.
  bool order = false;             // no oracle sees it either
  bool link = false;              // chamfers reach a third of the way to the link
  bool bridges = false;           // a bridge per triangle
  bool steiner_point = false;     // bad tetrahedra are split at their circumcentres
  bool kept_points = false;       // enriched with the points beside chamfers, too
  bool enrichment = false;        // always enriched
  bool filter_pairs = false;      // both sides of close pairs dropped
  bool filter_chamfered = false;  // both sides of chamfered features below tau dropped
  bool no_guard = false;          // nothing stricter than was asked for
  delmesher::Region region = delmesher::Region::interior;
  double chamfer_radius = 0;  // input units; 0: no bound
  double max_edge = 0;        // input units; 0: no bound
  // Of edges on average; 0: any. kSizeAuto: any, or one that the mesher chose.
  double size = 0;
  // Edges longer than this may have been halved for such a size; 0: none. The verification sets it.
  double longest_unasked = 0;
  // Edges up to this one may not be halved; 0: none is.
  double longest_whole() const { return longest_unasked > 0 ? longest_unasked : max_edge; }
  bool edges_by_size = false;                          // max_edge follows from it
  std::vector<delmesher::SizeSource> size_field = {};  // input units; empty: no bound
  double size_growth = 0.3;
  std::vector<std::array<double, 3>> points = {};  // further vertices of the input
  double budget = 0;                               // tetrahedra; 0: any number
  // The options given, in a text, that a file without a record does not show to be kept.
  std::vector<std::string> of_record = {};
  double max_vertices = 0;  // 0: no limit

  // If the surface may be kept, and the record is of no refined mesh, then it was to be kept, but
  // for edges that are longer than promised. With an option that only the refinement uses it may
  // not be.
  void settle(const delmesher::ExactRecord& record);

  // Of a surface of this diagonal and area, and a mesh of this volume, before settle(). Of its
  // edges, each once per tetrahedron, 95 % are no longer than common_edge: with a budget there is a
  // bound that few exceed, if any.
  void allow_sizes(double diagonal, double volume, double area, double common_edge);

  // The option that max_edge is of.
  const char* bound_on_edges() const { return edges_by_size ? "--size" : "--max-edge"; }

  // How far the surface may deviate between the vertices and edges that it keeps (--planar), as a
  // fraction of the diagonal: as stated, within what was asked for. If nothing is stated, `auto` is
  // kAutomatic.
  double planar_share() const;
  // The most that --planar allows a run to state; slabs up to it are measured if nothing is stated.
  double most_planar() const;
  // The angle that is guaranteed, in degrees: of faces, or of triangles of the plane. A larger
  // delta asks for a radius-edge ratio below 2 (in the plane: root 2), where the bound is best
  // effort.
  double guaranteed_delta() const;
  // The threshold for two edges that is in force, in degrees. An angle of two edges that is not
  // chamfered is an angle of the mesh, so the threshold has to exceed delta by some degrees.
  double corner_in_force() const;
};

// Every coordinate and length of a promise, in input units.
void for_each_length(Promise& promise, const std::function<void(double&)>& visit);

// Reads a command line without the program's name: 'mesh OPTIONS', 'cdt OPTIONS', 'plane OPTIONS',
// 'improve OPTIONS'; without a first word `mesh` is meant. Options that promise nothing of the
// result (files, threads, times) are ignored; the file of --size-field is read. Empty on success,
// else the mistake.
std::string parse_promise(std::string_view text, Promise& promise);

// The same for a call of the library.
Promise promise_of(const delmesher::Options& options);
Promise promise_of(const delmesher::CdtOptions& options);
Promise promise_of(const delmesher::PlaneOptions& options);

// Checks the record's version, that it has exactly the sections that the promise needs, and that
// its parameters are those promised or stricter ones. `diagonal`: of the input's bounding box, in
// input units.
OracleReport check_promise(const Promise& promise, const delmesher::ExactRecord& record,
                           unsigned version, double diagonal);

// The same for a file without a record: at most --max-vertices vertices, --budget tetrahedra, and
// the deviation between facets that it states (MeshFile::planar_within).
OracleReport check_written(const Promise& promise, std::size_t vertices, std::size_t tetrahedra,
                           double planar_within = 0);

// What is not shown where sets are called by names of another file (--names).
inline constexpr char kOtherNames[] = "--names";

// The version of the sidecar that has all sections the oracles ask for.
inline constexpr unsigned kRecordVersion = 7;

}  // namespace tetproof::oracles
