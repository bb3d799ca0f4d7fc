#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "corpus/campaigns/campaign.h"
#include "corpus/campaigns/process.h"
#include "corpus/campaigns/runnable.h"
#include "corpus/cli/commands.h"
#include "corpus/generators/certify.h"
#include "corpus/generators/generate.h"
#include "corpus/generators/shrink.h"
#include "corpus/models/files.h"
#include "oracles/files/surface_file.h"

namespace tetproof {
namespace {

namespace fs = std::filesystem;

Prober prober_for(const ShrinkArguments& arguments, const fs::path& folder) {
  const MesherPrograms programs = programs_here();
  Prober prober;
  try {
    prober.mesher = make_mesher(arguments.mesher, programs);
  } catch (const std::runtime_error& error) {
    throw UsageError(std::string("-m: ") + error.what());
  }
  const std::string why = why_not_runnable(prober.mesher.line, programs.supervisor);
  if (!why.empty()) throw UsageError("cannot be run: " + prober.mesher.name + ": " + why);
  prober.supervisor = programs.supervisor;
  prober.self = fs::read_symlink("/proc/self/exe");
  prober.folder = folder;
  prober.limits.wall_seconds = prober.limits.cpu_seconds = arguments.timeout;
  prober.limits.memory_bytes = arguments.memory_mebibytes << 20;
  prober.verify = !arguments.no_verify;
  prober.stop = campaign_interrupted;
  return prober;
}

}  // namespace

int shrink_command(const ShrinkArguments& arguments) {
  demand_folder_of(arguments.output, "-o");
  if (access(fs::absolute(arguments.output).parent_path().c_str(), W_OK) != 0) {
    throw UsageError("-o: " + arguments.output + ": cannot be written");
  }
  const ScratchFolder scratch("shrink");
  const Prober prober = prober_for(arguments, scratch.path());
  const oracles::Polyhedron read = oracles::read_surface(arguments.input);
  const delmesher::Surface surface = {read.vertices, read.triangles, {}};
  if (const auto defect = first_defect(surface)) {
    throw std::runtime_error(arguments.input + ": not a valid surface");
  }
  handle_interrupts();
  const Probe first = prober.probe(surface);
  if (campaign_interrupted()) return 130;
  if (first.failure.empty()) {
    fmt::print("{} does not fail on {}\n", prober.mesher.name, arguments.input);
    return 1;
  }
  fmt::print("{} triangles: {}\n", surface.triangles.size(), first.failure);
  ShrinkProgress progress;
  progress.tell = [&](const std::string& step, const delmesher::Surface& s) {
    fmt::print("{:>8} runs, after {:<12} {} triangles\n", progress.runs, step, s.triangles.size());
    std::fflush(stdout);
  };
  SideBySide judges(prober, first);
  const delmesher::Surface small = shrink(
      surface, std::ref(judges),
      {arguments.runs, arguments.seconds, std::max(1U, arguments.jobs), campaign_interrupted},
      progress);
  write_off(arguments.output, small, prober.mesher.name + ": " + first.failure, true);
  const bool interrupted = campaign_interrupted();
  fmt::print("{}{} triangles in {} after {} runs\n", interrupted ? "interrupted; " : "",
             small.triangles.size(), arguments.output, progress.runs);
  return interrupted ? 130 : 0;
}

}  // namespace tetproof
