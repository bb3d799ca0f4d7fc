#include "mesher/cli/plane_run.h"

#include "mesher/cli/defects.h"
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

// `check` and `repair` of a planar graph.
class GraphRunner : RunSteps {
 public:
  GraphRunner(const Command& command, const Library& library, const Streams& streams)
      : RunSteps(command, library, streams) {}

  int run();

 private:
  int check() const;
  int repair() const;
  std::string idle_option() const;
  GraphReport report_on(const PlanarGraph& graph) const {
    return call(TimeLimit{}, [&](const TimeLimit& limits) { return check_graph(graph, limits); });
  }

  PlanarGraph graph_;
};

std::string GraphRunner::idle_option() const {
  const auto* repair = std::get_if<RepairOptions>(&command_.options);
  if (repair != nullptr && repair->fill) return "--fill";
  if (const auto* check = std::get_if<CheckOptions>(&command_.options); check != nullptr) {
    const CheckOptions usual;
    if (check->acute != usual.acute) return "--acute";
    if (check->corner != usual.corner) return "--corner";
    if (check->planar != usual.planar) return "--planar";
  }
  if (!command_.names_file.empty()) return "--names";
  return command_.label_angle != 0 ? "--label-by-angle" : "";
}

int GraphRunner::check() const {
  const GraphReport report = report_on(graph_);
  const StatusCode code = report.status.code;
  if (code != StatusCode::ok && code != StatusCode::invalid_surface) {
    return fail_input(exit_code_of(code), report.status.message);
  }
  streams_.out(command_.json ? graph_json(command_.input, graph_, report)
                             : graph_text(command_.input, graph_, report));
  if (!command_.defects_file.empty()) {
    if (defects_format(command_.defects_file) != DefectsFormat::vtu) {
      return fail(kUsage,
                  command_.defects_file + ": defects of a planar graph are written as .vtu");
    }
    const int written = write_defects(graph_defects_vtu(graph_, report),
                                      "the segments, coloured by what is wrong; ParaView opens it");
    if (written != kDone) return written;
  }
  return code == StatusCode::ok ? kDone : fail_input(kInvalid, report.status.message);
}

int GraphRunner::repair() const {
  const auto& options = std::get<RepairOptions>(command_.options);
  const GraphRepairResult mended = call(TimeLimit{}, [&](const TimeLimit& limits) {
    return repair_graph(graph_, options.weld, limits);
  });
  if (!mended.status.ok()) {
    return fail_input(exit_code_of(mended.status.code), mended.status.message);
  }
  for (const std::string& line : mended.done) say(command_.input + ": " + line);
  if (mended.done.empty()) say(command_.input + ": nothing to mend");
  const GraphReport report = report_on(mended.graph);
  io::OutputSet outputs(set_temporaries);
  outputs.make_folders();
  for (const std::string& output : command_.outputs) {
    const io::WriteStatus status = io::write_graph(outputs, output, mended.graph);
    if (!status.ok()) return fail(kUnreadable, status.error);
  }
  const io::WriteStatus status = commit(outputs);
  if (!status.ok()) return fail(kUnreadable, status.error);
  if (!report.status.ok()) {
    return fail(kFailed, command_.outputs.front() + ": " + report.status.message);
  }
  say(command_.outputs.front() + ": a valid graph");
  return kDone;
}

int GraphRunner::run() {
  if (const std::string option = idle_option(); !option.empty()) {
    return fail(kUsage, option + ": of no effect on a planar graph");
  }
  const bool repairs = command_.job() == Job::repair;
  for (const std::string& output : command_.outputs) {
    if (!io::is_graph_file(output)) {
      return fail(kUsage,
                  output + ": a planar graph is written as " + std::string(io::kGraphExtensions));
    }
  }
  const int code = check_outputs([](const std::string& output) { return std::vector{output}; });
  if (code != kDone) return code;
  io::PlaneReadResult input = io::read_plane(command_.input, goes_on());
  if (!input.ok()) return fail_reading(input.code, input.error);
  for (const std::string& warning : input.warnings) warn(warning);
  graph_ = std::move(input.graph);
  note_input(input.format, graph_.vertices.size(), graph_.segments.size(), "segments");
  return repairs ? repair() : check();
}

}  // namespace

int run_graph(const Command& command, const Library& library, const Streams& streams) {
  return GraphRunner(command, library, streams).run();
}

int run_plane(const Command& command, const Library& library, const Streams& streams) {
  return PlaneRunner(command, library, streams).run();
}

}  // namespace delmesher::cli
