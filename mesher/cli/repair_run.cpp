#include "mesher/cli/repair_run.h"

#include <utility>

#include "mesher/cli/run_steps.h"
#include "mesher/io/write_mesh.h"
#include "mesher/io/write_plane.h"
#include "mesher/surface/hints.h"
#include "mesher/surface/repair.h"

namespace delmesher::cli {
namespace {

class RepairRunner : RunSteps {
 public:
  RepairRunner(const Command& command, const Library& library, const Streams& streams)
      : RunSteps(command, library, streams) {}

  int run();

 private:
  int read();
  int conclude_with(const SurfaceReport& report);

  const RepairOptions& options_ = std::get<RepairOptions>(command_.options);
  Surface surface_;
  io::LabelNames names_;
};

int RepairRunner::read() {
  io::ReadOptions options;
  options.go_on = goes_on();
  io::ReadResult input = io::read_surface(command_.input, options);
  if (!input.ok()) return fail_reading(input.code, input.error);
  names_ = std::move(input.names);
  ignore(input.region_points);
  note_input(input.format, input.surface.vertices.size(), input.surface.triangles.size(),
             "triangles");
  RepairResult mended = repair_surface(input.surface, options_);
  for (const std::string& line : mended.done) say(command_.input + ": " + line);
  if (mended.done.empty()) say(command_.input + ": nothing to mend");
  surface_ = std::move(mended.surface);
  if (surface_.triangles.empty()) {
    return fail_input(kFailed, "no triangle is left, so nothing is written");
  }
  return read_beside(names_, surface_.labels);
}

int RepairRunner::conclude_with(const SurfaceReport& report) {
  if (report.status.ok()) {
    say(command_.outputs.front() + ": a valid surface");
    return kDone;
  }
  const std::uint64_t open = surface::holes_of(surface_).open_edges;
  const bool fills = open > 0 && !options_.fill;
  std::string left = surface::defects_line(report) + " left";
  for (const surface::Contact& contact : surface::contacts(surface_, report)) {
    left += ": " + contact.what + ": " + contact.advice;
  }
  // What is not for this command.
  for (const std::string& hint : surface_hints(surface_, report)) {
    if (hint.find("T-junction") != std::string::npos) left += "; " + hint;
  }
  return fail(kFailed, command_.outputs.front() + ": " + left + (fills ? ", see --fill" : ""));
}

int RepairRunner::run() {
  for (const std::string& output : command_.outputs) {
    if (io::is_graph_file(output)) {
      return fail(kUsage, output + ": of planar graphs only (" + io::boundary_extensions() + ")");
    }
  }
  int code = check_outputs(io::boundary_files_of);
  if (code == kDone) code = read();
  if (code != kDone) return code;
  // Before it is written: whatever ends the run here leaves nothing behind.
  const SurfaceReport report = check_surface(surface_);
  if (!report.status.ok() && report.status.code != StatusCode::invalid_surface) {
    return fail_input(exit_code_of(report.status.code), report.status.message);
  }
  code = write_surfaces(surface_, names_);
  return code == kDone ? conclude_with(report) : code;
}

}  // namespace

int run_repair(const Command& command, const Library& library, const Streams& streams) {
  return RepairRunner(command, library, streams).run();
}

}  // namespace delmesher::cli
