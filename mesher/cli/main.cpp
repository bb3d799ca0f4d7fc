// delmesher: the mesher's command line.
#include <cstdio>
#include <new>

#include "mesher/cli/arguments.h"
#include "mesher/cli/batch.h"
#include "mesher/cli/progress.h"
#include "mesher/cli/run.h"
#include "mesher/cli/signals.h"
#include "mesher/delmesher_plane.h"

namespace delmesher {
namespace {

int parse_and_run(int argc, char** argv) {
  cli::install_signal_handlers();
  const cli::Parsed parsed =
      cli::parse_arguments(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
  std::fputs(parsed.out.c_str(), stdout);
  std::fputs(parsed.error.c_str(), stderr);
  if (!parsed.run) return parsed.exit_code;
  const cli::Library library = {tetrahedralize,      constrained_delaunay, check_surface,
                                triangulate_polygon, improve_mesh,         remesh_surface};
  cli::Streams streams;
  streams.out = [](const std::string& text) { std::fputs(text.c_str(), stdout); };
  streams.error = [](const std::string& text) { std::fputs(text.c_str(), stderr); };
  streams.terminal = cli::stderr_is_terminal();
  streams.escapes = cli::stderr_takes_escapes();
  const int code = parsed.batch.empty()
                       ? cli::run(parsed.command, library, streams)
                       : cli::run_batch(parsed.batch, parsed.jobs, library, streams);
  if (std::fflush(stdout) != 0 && code == cli::kDone) {
    std::fputs("delmesher: cannot write to standard output\n", stderr);
    return cli::kUnreadable;
  }
  return code;
}

}  // namespace
}  // namespace delmesher

int main(int argc, char** argv) {
  try {
    return delmesher::parse_and_run(argc, argv);
  } catch (const std::bad_alloc&) {  // not even enough for the arguments, or for a message
    std::fputs("delmesher: out of memory\n", stderr);
    return delmesher::cli::kLimit;
  }
}
