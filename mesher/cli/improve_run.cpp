#include "mesher/cli/improve_run.h"

#include <cstdio>

#include "mesher/cli/quality.h"
#include "mesher/cli/run_steps.h"
#include "mesher/io/read_mesh.h"
#include "mesher/io/write_mesh.h"

namespace delmesher::cli {
namespace {

class ImproveRunner : RunSteps {
 public:
  ImproveRunner(const Command& command, const Library& library, const Streams& streams)
      : RunSteps(command, library, streams) {}

  int run() {
    int code = check_outputs(io::mesh_files_of);
    if (code == kDone) code = read();
    return code == kDone ? improve() : code;
  }

 private:
  int read();
  int improve();

  TetMesh mesh_;
  io::LabelNames names_;
  io::WriteOptions write_ = command_.write;
};

int ImproveRunner::read() {
  io::MeshReadResult input = io::read_mesh(command_.input, goes_on());
  if (!input.ok()) return fail_reading(input.code, input.error);
  for (const std::string& warning : input.warnings) warn(warning);
  if (input.order == 2 && command_.write.order == 1) {
    warn("its elements are of second order, those written are not (--order 2)");
  }
  mesh_ = std::move(input.mesh);
  names_ = std::move(input.names);
  write_.region_names = std::move(input.region_names);
  note_input(input.format, mesh_.vertices.size(), mesh_.tetrahedra.size(), "tetrahedra");
  return read_beside(names_, mesh_.boundary_labels);
}

// The line of quality, with the quality before.
std::string result_text(const Result& result) {
  const std::string now = quality_text(result);
  if (now.empty()) return now;
  const MeshStatistics& before = result.statistics.refined;
  char text[160];
  std::snprintf(text, sizeof text,
                "; before: %llu tetrahedra, dihedral angles %.2f to %.2f degrees, smallest face "
                "angle %.2f, %llu below 5 degrees",
                static_cast<unsigned long long>(before.tetrahedra), before.min_dihedral,
                before.max_dihedral, before.min_face_angle,
                static_cast<unsigned long long>(before.below_5));
  return now + text;
}

int ImproveRunner::improve() {
  Result result =
      call(std::get<ImproveOptions>(command_.options),
           [&](const ImproveOptions& options) { return library_.improve_mesh(mesh_, options); });
  note_interruption(result.status);
  const Statistics& s = result.statistics;
  return finish({result.status, result.warnings,
                 [&](io::OutputSet& outputs) {
                   io::WriteStatus status;
                   for (const std::string& output : command_.outputs) {
                     status = warned(io::write_mesh(outputs, output, result.mesh, names_, write_));
                     if (!status.ok()) break;
                   }
                   return status;
                 },
                 [&] { return improve_stats_json(command_, result, facts_); },
                 [&] {
                   return conclude(
                       s.phase_seconds,
                       {result.mesh.vertices.size(), result.mesh.tetrahedra.size(),
                        s.rounding_inverted, s.rounding_flat, "tetrahedra", result_text(result)});
                 }});
}

}  // namespace

int run_improve(const Command& command, const Library& library, const Streams& streams) {
  return ImproveRunner(command, library, streams).run();
}

}  // namespace delmesher::cli
