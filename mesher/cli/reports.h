// Reports of the command line about a run: statistics, and the report of `check`.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "mesher/cli/arguments.h"
#include "mesher/delmesher_plane.h"

namespace delmesher::cli {

// "ok", "invalid-surface", ... for JSON.
const char* status_name(StatusCode code);
int exit_code_of(StatusCode code);

struct RunFacts {
  std::uint64_t input_vertices = 0, input_cells = 0;  // triangles, or segments in the plane
  double read_seconds = 0, write_seconds = 0, wall_seconds = 0, cpu_seconds = 0;
  std::uint64_t peak_rss_bytes = 0;
};

// Seconds of a phase. The library does not know the phases of reading and writing; `facts` has
// them.
double seconds_of(Phase phase, const std::array<double, kPhaseCount>& phase_seconds,
                  const RunFacts& facts);

// The JSON of --stats; its keys are stable.
std::string stats_json(const Command& command, const Result& result, const RunFacts& facts);
std::string improve_stats_json(const Command& command, const Result& result, const RunFacts& facts);
std::string plane_stats_json(const Command& command, const PlaneResult& result,
                             const RunFacts& facts);

// "970 triangles in place of 7000, within 0.01"
std::string remeshed_text(std::size_t given, std::size_t remeshed, double tolerance);
// The line about a surface that is kept because bounded angles would be heavy.
std::string kept_text(const std::string& file, const Statistics& s, bool bounds_edges,
                      std::uint64_t budget);

// The names of regions: of the solids that they lie in.
io::LabelNames region_names(const std::vector<MeshRegion>& regions, const io::LabelNames& labels);
// One line on the regions: names and volumes.
std::string regions_text(const std::string& file, const std::vector<MeshRegion>& regions,
                         const io::LabelNames& names);

// One line on the triangles that were merged because they are planar within the bound: to the end
// or, in a mesh of the surface as given, while they were refined.
std::string planar_text(const std::string& file, const Statistics& statistics, bool as_given);
// One line for each limit that the mesher set itself and that struck, for -v.
std::vector<std::string> limits_texts(const Statistics& statistics);

// The report of `check`, with the faces of a surface that has several labels.
std::string check_text(const std::string& file, const Surface& surface, const io::LabelNames& names,
                       const SurfaceReport& report);
std::string check_json(const std::string& file, const Surface& surface, const io::LabelNames& names,
                       const SurfaceReport& report);

// The same of a planar graph.
std::string graph_text(const std::string& file, const PlanarGraph& graph,
                       const GraphReport& report);
std::string graph_json(const std::string& file, const PlanarGraph& graph,
                       const GraphReport& report);

// CPU seconds and peak memory of this process so far.
void measure_process(RunFacts& facts);

}  // namespace delmesher::cli
