// Steps that all jobs share: messages, outputs, statistics, the end of a run.
#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "mesher/cli/progress.h"
#include "mesher/cli/reports.h"
#include "mesher/cli/run.h"
#include "mesher/cli/signals.h"
#include "mesher/io/output.h"
#include "mesher/io/parse_surface.h"

namespace delmesher::cli {

class RunSteps {
 protected:
  RunSteps(const Command& command, const Library& library, const Streams& streams)
      : command_(command), library_(library), streams_(streams) {}

  // Prints one line and returns the code.
  int fail(int code, const std::string& reason) const;
  int fail_input(int code, const std::string& reason) const;
  void warn(const std::string& reason) const;
  void say(const std::string& text) const;     // unless quiet
  void tell(const std::string& text) const;    // with -v
  void remark(const std::string& text) const;  // with -v, and on a terminal

  // Can all files be written? `files_of` names the files that an output consists of.
  int check_outputs(std::vector<std::string> (*files_of)(const std::string&)) const;

  // For ReadOptions::go_on: false when the time of --time-limit, from the start of the run, is
  // over.
  std::function<bool()> goes_on() const;
  // Reads what is given beside the input: adds the names of --names to its own, and keeps the
  // sizes of --size-field for the call(). Warns of names of labels that no triangle has; without
  // `labels` all have 0.
  int read_beside(io::LabelNames& names, const std::vector<std::int32_t>& labels);
  // Prints why nothing was read and returns the code.
  int fail_reading(io::ReadCode code, const std::string& error) const;

  // Prints the size of the input and the time it took to read.
  void note_input(const std::string& format, std::uint64_t vertices, std::uint64_t cells,
                  const char* cell_name);

  // Calls the library, `library_call(options)`, with the sizes that were read, the time that is
  // left, progress on a terminal, and signals that ask it to stop.
  template <class AnyOptions, class Call>
  auto call(AnyOptions options, Call&& library_call) const {
    const char* cells = command_.job() == Job::plane ? "triangles" : "tetrahedra";
    ProgressLine line(stderr, streams_.terminal && !command_.quiet, streams_.escapes, cells);
    if constexpr (requires { options.size_field; }) options.size_field = sizes_;
    watch(options, line);
    const Deferring deferring;
    return library_call(options);
  }
  // What check_surface() says of the surface, with those options that it shares with the job.
  SurfaceReport check_surface(const Surface& surface, bool want_regions = false,
                              const std::vector<RegionPoint>& region_points = {}) const;
  // Warns of region points for a job that knows no regions.
  void ignore(const std::vector<RegionPoint>& region_points) const;

  // From a result to the exit code: warnings, files (by `write`, whose outputs are then put in
  // place all at once), statistics (`json`, written however the run ended, because campaigns want
  // to know), `conclude`.
  struct Outcome {
    Status status;
    const std::vector<std::string>& warnings;
    std::function<io::WriteStatus(io::OutputSet&)> write;
    std::function<std::string()> json;
    std::function<int()> conclude;
  };
  int finish(const Outcome& outcome);
  // Gives the files of a run their names; signals do not end it any more then.
  static io::WriteStatus commit(io::OutputSet& outputs);
  // Writes --defects, and says what is in it and what opens it. The exit code.
  int write_defects(const std::string& text, const std::string& what) const;
  // Writes the outputs of a job that ends with a surface. The exit code.
  int write_surfaces(const Surface& surface, const io::LabelNames& names) const;
  // Warns of what the format of a file written cannot hold.
  io::WriteStatus warned(io::WriteStatus status) const {
    for (const std::string& warning : status.warnings) warn(warning);
    return status;
  }
  static void note_interruption(Status& status) {
    if (status.ok() && interrupted()) status = {StatusCode::interrupted, "interrupted"};
  }

  // The common end of every `conclude`: the line on quality is the last, unless something failed.
  struct Written {
    std::uint64_t vertices, cells, inverted, flat;
    const char* cell_name;  // "tetrahedra"
    std::string quality;    // one line; empty for none
  };
  int conclude(const std::array<double, kPhaseCount>& phase_seconds, const Written& written) const;

  const Command& command_;
  const Library& library_;
  const Streams& streams_;
  RunFacts facts_;
  std::vector<SizeSource> sizes_;  // of --size-field

 private:
  using Clock = std::chrono::steady_clock;
  void watch(TimeLimit& options, ProgressLine& line) const;
  io::WriteStatus put_in_place(const Outcome& outcome);
  io::WriteStatus write_stats(const Outcome& outcome);
  double seconds() const;  // since the start

  Clock::time_point start_ = Clock::now();
};

}  // namespace delmesher::cli
