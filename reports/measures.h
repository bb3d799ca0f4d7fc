// Measures of runs and their sums over models, shared by tables, figures and comparisons.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "reports/selection.h"

namespace tetproof {

using Rows = std::vector<const RunRow*>;
// A measure of a run; nothing if the run lacks the value.
using Value = std::function<std::optional<double>(const RunRow&)>;
// Which mesh of a run: RunRow::mesh, ::inside or ::refined.
using Part = std::optional<MeshColumns> RunRow::*;

// Is it one that a mesh of the plane lacks?
bool is_of_tetrahedra(double MeshColumns::*column);

template <typename T>
Value of(Part part, T MeshColumns::*column) {
  return [=](const RunRow& row) -> std::optional<double> {
    if (!(row.*part)) return std::nullopt;
    if constexpr (std::is_same_v<T, double>) {
      if (row.region == "plane" && is_of_tetrahedra(column)) return std::nullopt;
    }
    return static_cast<double>((*(row.*part)).*column);
  };
}

inline Value of(Part part, std::optional<double> MeshColumns::*column) {
  return [=](const RunRow& row) { return row.*part ? (*(row.*part)).*column : std::nullopt; };
}

// The value for the tetrahedra inside, if the file distinguishes them; else for all.
template <typename T>
Value of_solid(T MeshColumns::*column) {
  const Value inside = of(&RunRow::inside, column), all = of(&RunRow::mesh, column);
  return [=](const RunRow& row) { return row.inside ? inside(row) : all(row); };
}

// What the meshes of these runs cover: "interior", "hull", "not told", "mixed", or "-" for none.
std::string region_of(const Rows& rows);

// Stands behind a number of vertices or tetrahedra: " (hull)" or " (mixed)", nothing if they are
// those inside the model.
std::string region_mark(const Rows& rows);

struct AngleMeasure {
  const char* label;
  double MeshColumns::*column;
};

// The four extreme angles of the paper's tables and Figure 10, and the four averages of Figure 11.
inline constexpr AngleMeasure kExtremeAngles[] = {
    {"min face angle", &MeshColumns::min_face_angle},
    {"max face angle", &MeshColumns::max_face_angle},
    {"min dihedral angle", &MeshColumns::min_dihedral},
    {"max dihedral angle", &MeshColumns::max_dihedral}};
inline constexpr AngleMeasure kAverageAngles[] = {
    {"average min face angle", &MeshColumns::mean_min_face_angle},
    {"average max face angle", &MeshColumns::mean_max_face_angle},
    {"average min dihedral angle", &MeshColumns::mean_min_dihedral},
    {"average max dihedral angle", &MeshColumns::mean_max_dihedral}};

// Shares in percent, the 1 % quantile in degrees, gamma and SICN from 0 to 1.
struct ShapeMeasure {
  const char* label;
  std::optional<double> MeshColumns::*column;
  double factor;
  int digits;
};
inline constexpr ShapeMeasure kShapes[] = {
    {"% of tets below 5 degrees", &MeshColumns::share_below_5, 100, 3},
    {"% of tets below 10 degrees", &MeshColumns::share_below_10, 100, 2},
    {"1 % quantile of min dihedrals", &MeshColumns::dihedral_percent, 1, 2},
    {"mean gamma", &MeshColumns::mean_gamma, 1, 3},
    {"1 % quantile of gamma", &MeshColumns::gamma_percent, 1, 3},
    {"min gamma", &MeshColumns::min_gamma, 1, 4},
    {"mean SICN", &MeshColumns::mean_sicn, 1, 3},
    {"min SICN", &MeshColumns::min_sicn, 1, 4}};
inline constexpr const char* kGammaNote =
    "gamma: 3 times the inscribed sphere's radius over the circumsphere's. SICN: Gmsh's signed "
    "inverse condition number. Both are 1 for a regular tetrahedron.";

Value wall_seconds();
Value verify_seconds();
Value peak_megabytes();
// Per tetrahedron: of the whole process, or of the meshing by the mesher's own account.
Value process_microseconds();
Value meshing_microseconds();
Value peak_bytes();  // per tetrahedron

std::vector<double> values_of(const Rows& rows, const Value& value);

// "-" for nothing.
std::string fixed(std::optional<double> value, int digits);
std::string significant(std::optional<double> value, int digits);
std::string degrees(std::optional<double> value);  // small ones keep two significant digits

// The meshers of the list that the selection has runs of, in the order given.
std::vector<std::string> present(const Selection& selection,
                                 const std::vector<std::string>& meshers);
std::size_t run_count(const Selection& selection, const std::string& mesher);

// The columns of all dispositions but ok: their heads, and how many runs of a mesher, which has
// some, ended in each.
void append_dispositions(std::vector<std::string>& header);
void append_dispositions(const Selection& selection, const std::string& mesher,
                         std::vector<std::string>& row);
// The number of its meshes that the oracles have not come to a verdict on.
std::size_t unverified_count(const Selection& selection, const std::string& mesher);
// "27/29", or "27/29, 1 unverified": successes of runs.
std::string successes_of(const Selection& selection, const std::string& mesher);

// A sentence on the limits of the runs of these meshers, which names them one by one if they
// differ; empty without runs.
std::string limits_caption(const Selection& selection, const std::vector<std::string>& meshers);
bool limits_differ(const Selection& selection, const std::vector<std::string>& meshers);

// The style of a mesher's series, the same in every chart.
std::size_t style_of(const Selection& selection, const std::string& mesher);

// The file's name without folders and extension.
std::string short_name(const std::string& model_name);

// What a failure has in common with others of its kind: disposition and last words, without numbers
// and without the name of the model; of a wrong result the oracle's name.
std::string failure_kind(const RunRow& row);

}  // namespace tetproof
