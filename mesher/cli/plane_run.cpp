#include "mesher/cli/plane_run.h"

#include "mesher/cli/quality.h"
#include "mesher/cli/run_steps.h"
#include "mesher/io/read_plane.h"
#include "mesher/io/write_plane.h"

namespace delmesher::cli {
namespace {

class PlaneRunner : RunSteps {
 public:
  PlaneRunner(const Command& command, const Library& library, const Streams& streams)
      : RunSteps(command, library, streams) {}

  int run() {
    int code = check_outputs(io::plane_files_of);
    if (code == kDone) code = read();
    return code == kDone ? mesh() : code;
  }

 private:
  int read();
  int mesh();
  io::WriteStatus write_all(io::OutputSet& outputs, const PlaneResult& result) const;

  PlanarGraph graph_;
};

int PlaneRunner::read() {
  io::PlaneReadResult input = io::read_plane(command_.input, goes_on());
  if (!input.ok()) return fail_reading(input.code, input.error);
  for (const std::string& warning : input.warnings) warn(warning);
  graph_ = std::move(input.graph);
  note_input(input.format, graph_.vertices.size(), graph_.segments.size(), "segments");
  return kDone;
}

io::WriteStatus PlaneRunner::write_all(io::OutputSet& outputs, const PlaneResult& result) const {
  io::WriteStatus status;
  for (const std::string& output : command_.outputs) {
    status = warned(io::write_plane(outputs, output, result.mesh, &graph_, command_.write));
    if (!status.ok()) return status;
  }
  if (!command_.chamfered_file.empty()) {
    status = io::write_poly(outputs, command_.chamfered_file, result.chamfered);
  }
  if (status.ok() && !command_.exact_file.empty()) {
    status = io::write_plane_exact(outputs, command_.exact_file, result.exact);
  }
  return status;
}

int PlaneRunner::mesh() {
  PlaneResult result = call(
      std::get<PlaneOptions>(command_.options),
      [&](const PlaneOptions& options) { return library_.triangulate_polygon(graph_, options); });
  note_interruption(result.status);
  const PlaneStatistics& s = result.statistics;
  return finish({result.status, result.warnings,
                 [&](io::OutputSet& outputs) { return write_all(outputs, result); },
                 [&] { return plane_stats_json(command_, result, facts_); },
                 [&] {
                   return conclude(
                       s.phase_seconds,
                       {result.mesh.vertices.size(), result.mesh.triangles.size(),
                        s.rounding_inverted, s.rounding_flat, "triangles", quality_text(result)});
                 }});
}

}  // namespace

int run_plane(const Command& command, const Library& library, const Streams& streams) {
  return PlaneRunner(command, library, streams).run();
}

}  // namespace delmesher::cli
