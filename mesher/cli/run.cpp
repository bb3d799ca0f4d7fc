#include "mesher/cli/run.h"

#include <chrono>
#include <cstdio>
#include <new>

#include "mesher/cli/plane_run.h"
#include "mesher/cli/progress.h"
#include "mesher/cli/reports.h"
#include "mesher/cli/signals.h"
#include "mesher/io/exact_record.h"
#include "mesher/io/read_surface.h"
#include "mesher/io/write_mesh.h"

namespace delmesher::cli {
namespace {

using Clock = std::chrono::steady_clock;

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

class Runner {
 public:
  Runner(const Command& command, const Library& library, const Streams& streams)
      : command_(command), library_(library), streams_(streams) {}

  int run();

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
  static std::string one_line(std::string text) {
    for (char& c : text) {
      if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    }
    return text;
  }

  int check_outputs();
  int read();
  Options options_with_progress(ProgressLine& line) const;
  int check();
  int mesh();
  io::WriteStatus write_all(const Result& result);
  io::WriteStatus write_stats(const Result& result);
  int conclude(const Result& result);
  void tell_phases(const Result& result);

  const Command& command_;
  const Library& library_;
  const Streams& streams_;
  Clock::time_point start_ = Clock::now();
  Surface surface_;
  RunFacts facts_;
};

int Runner::check_outputs() {
  std::vector<std::string> files;
  for (const std::string& output : command_.outputs) {
    for (const std::string& file : io::files_of(output)) files.push_back(file);
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

int Runner::read() {
  io::ReadResult input = io::read_surface(command_.input);
  if (input.code == io::ReadCode::out_of_memory) return fail(kLimit, input.error);
  if (!input.ok()) return fail(kUnreadable, input.error);
  for (const std::string& warning : input.warnings) warn(warning);
  surface_ = std::move(input.surface);
  facts_.input_vertices = surface_.vertices.size();
  facts_.input_triangles = surface_.triangles.size();
  facts_.read_seconds = seconds_since(start_);
  tell(command_.input + ": " + input.format + ", " + std::to_string(facts_.input_vertices) +
       " vertices, " + std::to_string(facts_.input_triangles) + " triangles");
  for (const std::string& note : input.notes) tell(command_.input + ": " + note);
  return kDone;
}

Options Runner::options_with_progress(ProgressLine& line) const {
  Options options = command_.options;
  options.progress = [&line](const Progress& progress) {
    line.show(progress);
    return !interrupted();
  };
  return options;
}

int Runner::check() {
  SurfaceReport report;
  {
    ProgressLine line(stderr, streams_.terminal && !command_.quiet, streams_.escapes);
    const Deferring deferring;
    report = library_.check_surface(surface_, options_with_progress(line));
  }
  const StatusCode code = report.status.code;
  if (code == StatusCode::ok || code == StatusCode::invalid_surface) {
    streams_.out(command_.json ? check_json(command_.input, report)
                               : check_text(command_.input, report));
  }
  if (code == StatusCode::ok) return kDone;
  return fail_input(exit_code_of(code), report.status.message);
}

io::WriteStatus Runner::write_all(const Result& result) {
  const Clock::time_point start = Clock::now();
  io::OutputSet outputs(set_temporaries);
  io::WriteStatus status;
  for (const std::string& output : command_.outputs) {
    status = io::write_mesh(outputs, output, result.mesh);
    if (!status.ok()) return status;
  }
  if (!command_.chamfered_file.empty()) {
    status = io::write_off(outputs, command_.chamfered_file, result.chamfered);
  }
  if (status.ok() && !command_.exact_file.empty()) {
    status = io::write_exact(outputs, command_.exact_file, result.exact);
  }
  if (!status.ok()) return status;
  const Deferring deferring;  // all files or none
  status = outputs.commit();
  facts_.write_seconds = seconds_since(start);
  return status;
}

// Written whatever became of the run: campaigns want to know how the others ended.
io::WriteStatus Runner::write_stats(const Result& result) {
  io::WriteStatus status;
  if (command_.stats_file.empty()) return status;
  facts_.wall_seconds = seconds_since(start_);
  measure_process(facts_);
  io::OutputSet outputs(set_temporaries);
  io::TextSink* sink = outputs.open(command_.stats_file, status);
  if (sink == nullptr) return status;
  sink->text(stats_json(command_, result, facts_));
  const Deferring deferring;
  return outputs.commit();
}

void Runner::tell_phases(const Result& result) {
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    const Phase phase = static_cast<Phase>(i);
    double seconds = result.statistics.phase_seconds[i];
    if (phase == Phase::read) seconds = facts_.read_seconds;
    if (phase == Phase::write) seconds = facts_.write_seconds;
    char text[64];
    std::snprintf(text, sizeof text, "%-10s %9.3f s", phase_name(phase), seconds);
    tell(text);
  }
}

int Runner::conclude(const Result& result) {
  const Statistics& s = result.statistics;
  tell_phases(result);
  if (command_.verbose || (streams_.terminal && !command_.quiet)) {
    char text[128];
    std::snprintf(text, sizeof text, "%llu vertices, %llu tetrahedra, %.1f s",
                  static_cast<unsigned long long>(result.mesh.vertices.size()),
                  static_cast<unsigned long long>(result.mesh.tetrahedra.size()),
                  seconds_since(start_));
    streams_.error(one_line(command_.outputs.front() + ": " + text) + "\n");
  }
  if (s.rounding_flat > 0 && s.rounding_inverted == 0) {
    warn(std::to_string(s.rounding_flat) + " flat tetrahedra left in the written mesh");
  }
  if (s.rounding_inverted == 0) return kDone;
  return fail_input(kFailed, std::to_string(s.rounding_inverted) + " inverted and " +
                                 std::to_string(s.rounding_flat) +
                                 " flat tetrahedra left in the written mesh");
}

int Runner::mesh() {
  Result result;
  {
    ProgressLine line(stderr, streams_.terminal && !command_.quiet, streams_.escapes);
    const Deferring deferring;
    const Options options = options_with_progress(line);
    result = command_.job == Job::cdt ? library_.constrained_delaunay(surface_, options)
                                      : library_.tetrahedralize(surface_, options);
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

int Runner::run() {
  try {
    if (command_.job == Job::plane) return run_plane(command_, library_, streams_);
    int code = check_outputs();
    if (code == kDone) code = read();
    if (code != kDone) return code;
    return command_.job == Job::check ? check() : mesh();
  } catch (const std::bad_alloc&) {
    return fail_input(kLimit, "out of memory");
  } catch (const std::exception& error) {
    return fail_input(kInternal, std::string("internal error: ") + error.what() +
                                     " (a bug: please send the input and the command line)");
  }
}

}  // namespace

int run(const Command& command, const Library& library, const Streams& streams) {
  return Runner(command, library, streams).run();
}

}  // namespace delmesher::cli
