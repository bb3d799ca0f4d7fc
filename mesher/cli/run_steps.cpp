#include "mesher/cli/run_steps.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <type_traits>
#include <variant>

#include "mesher/delmesher/option_table.h"
#include "mesher/io/write_mesh.h"

namespace delmesher::cli {
namespace {

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return text;
}

}  // namespace

int RunSteps::fail(int code, const std::string& reason) const {
  streams_.error("delmesher: " + one_line(reason) + "\n");
  return code;
}

int RunSteps::fail_input(int code, const std::string& reason) const {
  return fail(code, command_.input + ": " + reason);
}

void RunSteps::warn(const std::string& reason) const {
  if (command_.quiet) return;
  streams_.error("delmesher: " + one_line(command_.input + ": warning: " + reason) + "\n");
}

void RunSteps::say(const std::string& text) const {
  if (!command_.quiet) streams_.error(one_line(text) + "\n");
}

void RunSteps::tell(const std::string& text) const {
  if (command_.verbose) streams_.error(one_line(text) + "\n");
}

void RunSteps::remark(const std::string& text) const {
  if (command_.verbose || (streams_.terminal && !command_.quiet)) {
    streams_.error(one_line(text) + "\n");
  }
}

double RunSteps::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

int RunSteps::check_outputs(std::vector<std::string> (*files_of)(const std::string&)) const {
  std::vector<std::string> files;
  for (const std::string& output : command_.outputs) {
    for (const std::string& file : files_of(output)) files.push_back(file);
  }
  for (const auto file : kWrittenBeside) {
    if (!(command_.*file).empty()) files.push_back(command_.*file);
  }
  for (const std::string& file : files) {
    const io::WriteStatus status = io::check_writable(file, io::MissingFolder::is_made);
    if (!status.ok()) return fail(kUnreadable, status.error);
  }
  return kDone;
}

std::function<bool()> RunSteps::goes_on() const {
  const double limit = std::visit(
      []<class T>(const T& options) {
        if constexpr (std::is_base_of_v<TimeLimit, T>) return options.time_limit_seconds;
        return 0.0;
      },
      command_.options);
  return [this, limit] { return !interrupted() && (limit <= 0 || seconds() <= limit); };
}

int RunSteps::read_beside(io::LabelNames& names, const std::vector<std::int32_t>& labels) {
  if (!command_.sizes_file.empty()) {
    io::SizeFieldResult field = io::read_size_field(command_.sizes_file);
    if (!field.ok()) return fail(kUnreadable, field.error);
    sizes_ = std::move(field.sources);
  }
  if (!command_.names_file.empty()) {
    io::NamesResult given = io::read_label_names(command_.names_file);
    if (!given.ok()) return fail(kUnreadable, given.error);
    std::set<std::int32_t> there(labels.begin(), labels.end());
    if (labels.empty()) there.insert(0);
    std::string missing;
    for (const auto& [label, name] : given.names) {
      if (!there.contains(label)) missing += (missing.empty() ? "" : ", ") + std::to_string(label);
    }
    if (!missing.empty()) warn(command_.names_file + ": no triangle has label " + missing);
    given.names.merge(names);
    names = std::move(given.names);
  }
  return kDone;
}

int RunSteps::fail_reading(io::ReadCode code, const std::string& error) const {
  switch (code) {
    case io::ReadCode::stopped:
      return interrupted()
                 ? fail_input(kInterrupted, "interrupted")
                 : fail_input(kLimit, "time limit reached while reading, see --time-limit");
    case io::ReadCode::out_of_memory:
      return fail(kLimit, error);
    default:
      return fail(kUnreadable, error);
  }
}

void RunSteps::note_input(const std::string& format, std::uint64_t vertices, std::uint64_t cells,
                          const char* cell_name) {
  facts_.input_vertices = vertices;
  facts_.input_cells = cells;
  facts_.read_seconds = seconds();
  tell(command_.input + ": " + format + ", " + std::to_string(vertices) + " vertices, " +
       std::to_string(cells) + " " + cell_name);
}

void RunSteps::ignore(const std::vector<RegionPoint>& region_points) const {
  const auto holes = std::ranges::count_if(region_points, &RegionPoint::is_hole);
  const auto count = std::ssize(region_points) - holes;
  if (count == 0) return;
  warn(std::to_string(count) + " region points ignored: all that is inside is one region" +
       (command_.job() == Job::mesh ? " (--regions all makes regions)" : ""));
}

SurfaceReport RunSteps::check_surface(const Surface& surface, bool want_regions,
                                      const std::vector<RegionPoint>& region_points) const {
  CheckOptions check = std::visit(
      [](const auto& job) { return options::taken_from<CheckOptions>(job); }, command_.options);
  check.want_regions = want_regions;
  check.region_points = region_points;
  return call(
      check, [&](const CheckOptions& options) { return library_.check_surface(surface, options); });
}

void RunSteps::watch(TimeLimit& options, ProgressLine& line) const {
  double& limit = options.time_limit_seconds;
  if (limit > 0) limit = std::max(limit - seconds(), 1e-9);  // 0 would be none
  options.progress = [&line](const Progress& progress) {
    line.show(progress);
    return !interrupted();
  };
}

io::WriteStatus RunSteps::put_in_place(const Outcome& outcome) {
  const double start = seconds();
  io::OutputSet outputs(set_temporaries);
  outputs.make_folders();
  io::WriteStatus status = outcome.write(outputs);
  if (!status.ok()) return status;
  status = commit(outputs);
  facts_.write_seconds = seconds() - start;
  return status;
}

int RunSteps::write_defects(const std::string& text, const std::string& what) const {
  io::OutputSet outputs(set_temporaries);
  outputs.make_folders();
  io::WriteStatus status;
  io::TextSink* sink = outputs.open(command_.defects_file, status);
  if (sink == nullptr) return fail(kUnreadable, status.error);
  sink->text(text);
  status = commit(outputs);
  if (!status.ok()) return fail(kUnreadable, status.error);
  say(command_.defects_file + ": " + what);
  return kDone;
}

int RunSteps::write_surfaces(const Surface& surface, const io::LabelNames& names) const {
  io::OutputSet outputs(set_temporaries);
  outputs.make_folders();
  io::WriteStatus status;
  for (const std::string& output : command_.outputs) {
    status = warned(io::write_surface(outputs, output, surface, names));
    if (!status.ok()) return fail(kUnreadable, status.error);
  }
  status = commit(outputs);
  return status.ok() ? kDone : fail(kUnreadable, status.error);
}

io::WriteStatus RunSteps::commit(io::OutputSet& outputs) {
  const Committing committing;
  io::WriteStatus status = outputs.commit();
  note_files_in_place(status.ok());
  return status;
}

io::WriteStatus RunSteps::write_stats(const Outcome& outcome) {
  io::WriteStatus status;
  if (command_.stats_file.empty()) return status;
  facts_.wall_seconds = seconds();
  measure_process(facts_);
  io::OutputSet outputs(set_temporaries);
  outputs.make_folders();
  io::TextSink* sink = outputs.open(command_.stats_file, status);
  if (sink == nullptr) return status;
  sink->text(outcome.json());
  const Deferring deferring;
  return outputs.commit();
}

int RunSteps::finish(const Outcome& outcome) {
  for (const std::string& warning : outcome.warnings) warn(warning);
  if (!outcome.status.ok()) {
    const io::WriteStatus stats = write_stats(outcome);
    const int code = fail_input(exit_code_of(outcome.status.code), outcome.status.message);
    if (!stats.ok()) fail(code, stats.error);
    return code;
  }
  io::WriteStatus status = put_in_place(outcome);
  if (status.ok()) status = write_stats(outcome);
  if (!status.ok()) return fail(kUnreadable, status.error);
  return outcome.conclude();
}

int RunSteps::conclude(const std::array<double, kPhaseCount>& phase_seconds,
                       const Written& written) const {
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    const Phase phase = static_cast<Phase>(i);
    char text[64];
    std::snprintf(text, sizeof text, "%-10s %9.3f s", phase_name(phase),
                  seconds_of(phase, phase_seconds, facts_));
    tell(text);
  }
  const bool tetrahedra = std::string_view(written.cell_name) == "tetrahedra";
  const auto cells_of = [&](std::uint64_t count) {
    return std::to_string(count) + " " +
           (count != 1   ? written.cell_name
            : tetrahedra ? "tetrahedron"
                         : "triangle");
  };
  std::string line;
  for (const std::string& output : command_.outputs) line += (line.empty() ? "" : ", ") + output;
  char time[32];
  std::snprintf(time, sizeof time, " in %.1f s", seconds());
  line += ": " + std::to_string(written.vertices) + " vertices, " + cells_of(written.cells) + time;
  const std::string left =
      std::to_string(written.flat) + " flat " + written.cell_name + " left in the written mesh";
  if (written.flat > 0 && written.inverted == 0) warn(left);
  written.quality.empty() ? remark(line) : say(line + "; " + written.quality);
  if (written.inverted == 0) return kDone;
  return fail_input(kFailed, std::to_string(written.inverted) + " inverted and " + left);
}

}  // namespace delmesher::cli
