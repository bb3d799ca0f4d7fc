#include "mesher/cli/plane_run.h"

#include <chrono>
#include <cstdio>
#include <new>
#include <nlohmann/json.hpp>

#include "mesher/cli/progress.h"
#include "mesher/cli/signals.h"
#include "mesher/io/read_plane.h"
#include "mesher/io/write_plane.h"

namespace delmesher::cli {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Lets a signal ask the library to stop instead of ending the program.
class Deferring {
 public:
  Deferring() { begin_deferring(); }
  ~Deferring() { end_deferring(); }
  Deferring(const Deferring&) = delete;
  Deferring& operator=(const Deferring&) = delete;
};

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return text;
}

class PlaneRunner {
 public:
  PlaneRunner(const Command& command, const Library& library, const Streams& streams)
      : command_(command), library_(library), streams_(streams) {}

  int run() {
    int code = check_outputs();
    if (code == kDone) code = read();
    return code == kDone ? mesh() : code;
  }

 private:
  int fail(int code, const std::string& reason) {
    streams_.error("delmesher: " + one_line(reason) + "\n");
    return code;
  }
  int fail_input(int code, const std::string& reason) {
    return fail(code, command_.input + ": " + reason);
  }
  void warn(const std::string& reason) {
    if (command_.quiet) return;
    streams_.error("delmesher: " + one_line(command_.input + ": warning: " + reason) + "\n");
  }
  void tell(const std::string& text) {
    if (command_.verbose) streams_.error(one_line(text) + "\n");
  }

  int check_outputs();
  int read();
  int mesh();
  io::WriteStatus write_all(const PlaneResult& result);
  io::WriteStatus write_stats(const PlaneResult& result);
  int conclude(const PlaneResult& result);

  const Command& command_;
  const Library& library_;
  const Streams& streams_;
  Clock::time_point start_ = Clock::now();
  PlanarGraph graph_;
  RunFacts facts_;
};

int PlaneRunner::check_outputs() {
  std::vector<std::string> files;
  for (const std::string& output : command_.outputs) {
    for (const std::string& file : io::plane_files_of(output)) files.push_back(file);
  }
  for (const std::string* file :
       {&command_.stats_file, &command_.chamfered_file, &command_.exact_file}) {
    if (!file->empty()) files.push_back(*file);
  }
  for (const std::string& file : files) {
    const io::WriteStatus status = io::check_writable(file);
    if (!status.ok()) return fail(kUnreadable, status.error);
  }
  return kDone;
}

int PlaneRunner::read() {
  io::PlaneReadResult input = io::read_plane(command_.input);
  if (input.code == io::ReadCode::out_of_memory) return fail(kLimit, input.error);
  if (!input.ok()) return fail(kUnreadable, input.error);
  for (const std::string& warning : input.warnings) warn(warning);
  graph_ = std::move(input.graph);
  facts_.input_vertices = graph_.vertices.size();
  facts_.input_triangles = graph_.segments.size();
  facts_.read_seconds = seconds_since(start_);
  tell(command_.input + ": " + input.format + ", " + std::to_string(facts_.input_vertices) +
       " vertices, " + std::to_string(facts_.input_triangles) + " segments");
  return kDone;
}

io::WriteStatus PlaneRunner::write_all(const PlaneResult& result) {
  const Clock::time_point start = Clock::now();
  io::OutputSet outputs(set_temporaries);
  io::WriteStatus status;
  for (const std::string& output : command_.outputs) {
    status = io::write_plane(outputs, output, result.mesh);
    if (!status.ok()) return status;
  }
  if (!command_.chamfered_file.empty()) {
    status = io::write_poly(outputs, command_.chamfered_file, result.chamfered);
  }
  if (status.ok() && !command_.exact_file.empty()) {
    status = io::write_plane_exact(outputs, command_.exact_file, result.exact);
  }
  if (!status.ok()) return status;
  const Deferring deferring;  // all files or none
  status = outputs.commit();
  facts_.write_seconds = seconds_since(start);
  return status;
}

io::WriteStatus PlaneRunner::write_stats(const PlaneResult& result) {
  io::WriteStatus status;
  if (command_.stats_file.empty()) return status;
  facts_.wall_seconds = seconds_since(start_);
  measure_process(facts_);
  io::OutputSet outputs(set_temporaries);
  io::TextSink* sink = outputs.open(command_.stats_file, status);
  if (sink == nullptr) return status;
  sink->text(plane_stats_json(command_, result, facts_));
  const Deferring deferring;
  return outputs.commit();
}

int PlaneRunner::conclude(const PlaneResult& result) {
  const PlaneStatistics& s = result.statistics;
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    const Phase phase = static_cast<Phase>(i);
    double seconds = s.phase_seconds[i];
    if (phase == Phase::read) seconds = facts_.read_seconds;
    if (phase == Phase::write) seconds = facts_.write_seconds;
    char text[64];
    std::snprintf(text, sizeof text, "%-10s %9.3f s", phase_name(phase), seconds);
    tell(text);
  }
  if (command_.verbose || (streams_.terminal && !command_.quiet)) {
    char text[128];
    std::snprintf(text, sizeof text, "%llu vertices, %llu triangles, %.1f s",
                  static_cast<unsigned long long>(result.mesh.vertices.size()),
                  static_cast<unsigned long long>(result.mesh.triangles.size()),
                  seconds_since(start_));
    streams_.error(one_line(command_.outputs.front() + ": " + text) + "\n");
  }
  if (s.rounding_flat > 0 && s.rounding_inverted == 0) {
    warn(std::to_string(s.rounding_flat) + " flat triangles left in the written mesh");
  }
  if (s.rounding_inverted == 0) return kDone;
  return fail_input(kFailed, std::to_string(s.rounding_inverted) + " inverted and " +
                                 std::to_string(s.rounding_flat) +
                                 " flat triangles left in the written mesh");
}

int PlaneRunner::mesh() {
  PlaneResult result;
  {
    ProgressLine line(stderr, streams_.terminal && !command_.quiet, streams_.escapes);
    const Deferring deferring;
    Options options = command_.options;
    options.progress = [&line](const Progress& progress) {
      line.show(progress);
      return !interrupted();
    };
    result = library_.triangulate_polygon(graph_, options);
  }
  if (result.status.ok() && interrupted()) result.status = {StatusCode::interrupted, "interrupted"};
  for (const std::string& warning : result.warnings) warn(warning);
  if (!result.status.ok()) {
    const io::WriteStatus stats = write_stats(result);
    const int code = fail_input(exit_code_of(result.status.code), result.status.message);
    if (!stats.ok()) fail(code, stats.error);
    return code;
  }
  io::WriteStatus status = write_all(result);
  if (status.ok()) status = write_stats(result);
  if (!status.ok()) return fail(kUnreadable, status.error);
  return interrupted() ? fail_input(kInterrupted, "interrupted") : conclude(result);
}

Json mesh_json(const PlaneMeshStatistics& s) {
  return {{"vertices", s.vertices},
          {"triangles", s.triangles},
          {"interior_triangles", s.interior_triangles},
          {"edges", s.edges},
          {"min_angle", s.min_angle},
          {"max_angle", s.max_angle},
          {"mean_min_angle", s.mean_min_angle},
          {"mean_max_angle", s.mean_max_angle},
          {"angle_histogram", s.angle_histogram}};
}

}  // namespace

std::string plane_stats_json(const Command& command, const PlaneResult& result,
                             const RunFacts& facts) {
  const PlaneStatistics& s = result.statistics;
  const Options& o = command.options;
  Json phases;
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    const Phase phase = static_cast<Phase>(i);
    double seconds = s.phase_seconds[i];
    if (phase == Phase::read) seconds = facts.read_seconds;
    if (phase == Phase::write) seconds = facts.write_seconds;
    phases[phase_name(phase)] = seconds;
  }
  const Json json = {
      {"input",
       {{"file", command.input},
        {"vertices", facts.input_vertices},
        {"segments", facts.input_triangles},
        {"bbox_diagonal", s.bbox_diagonal}}},
      {"parameters",
       {{"job", "plane"},
        {"delta", o.delta},
        {"tau", o.tau},
        {"acute", o.acute},
        {"approximate", o.approximate},
        {"chamfer_radius", o.chamfer_radius},
        {"max_edge", o.max_edge},
        {"region", o.region == Region::hull ? "hull" : "interior"},
        {"max_vertices", o.max_vertices},
        {"time_limit", o.time_limit_seconds}}},
      {"status", status_name(result.status.code)},
      {"phases_seconds", phases},
      {"wall_seconds", facts.wall_seconds},
      {"cpu_seconds", facts.cpu_seconds},
      {"peak_rss_bytes", facts.peak_rss_bytes},
      {"refined", mesh_json(s.refined)},
      {"final", mesh_json(s.final)},
      {"filter", {{"dropped_segments", s.dropped_segments}, {"rounds", s.filter_rounds}}},
      {"chamfer",
       {{"acute_vertices", s.acute_vertices}, {"chamfered_segments", s.chamfered_segments}}},
      {"guarantee", {{"acute", o.acute}, {"delta", s.guaranteed_delta}}},
      {"steiner", {{"on_segments", s.steiner_on_segments}, {"in_faces", s.steiner_in_faces}}},
      {"rounding",
       {{"inverted", s.rounding_inverted},
        {"flat", s.rounding_flat},
        {"repaired", s.rounding_repaired},
        {"max_segment_deviation", s.max_segment_deviation}}}};
  // File names need not be UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int run_plane(const Command& command, const Library& library, const Streams& streams) {
  return PlaneRunner(command, library, streams).run();
}

}  // namespace delmesher::cli
