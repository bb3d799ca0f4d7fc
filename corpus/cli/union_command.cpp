#include <charconv>
#include <cmath>
#include <cstdio>
#include <string>
#include <system_error>

#include "corpus/campaigns/campaign.h"
#include "corpus/cli/commands.h"
#include "corpus/union/union_files.h"
#include "mesher/delmesher/option_table.h"

namespace tetproof {
namespace {

// As of UnionOptions.
double snap_of(const UnionArguments& arguments) {
  if (!arguments.snap) return 0;
  if (!arguments.walls) throw UsageError("--snap goes with --walls");
  const std::string& text = *arguments.snap;
  const double share = -delmesher::options::share_of(text);
  if (share > 0 && share <= 0.01) return -share;
  double length = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, length);
  if (error == std::errc() && stop == end && length > 0 && std::isfinite(length)) return length;
  throw UsageError("--snap '" + text +
                   "': a length is expected, or a fraction of the diagonal as in 1e-6d, at most " +
                   "0.01d");
}

}  // namespace

int union_command(const UnionArguments& arguments) {
  if (!unite::is_surface_output(arguments.output)) {
    throw UsageError(arguments.output + ": a name that ends in .stl, .ply or .off is expected");
  }
  handle_interrupts();
  unite::UnionOptions options;
  if (arguments.nonzero) options.inside = unite::Inside::nonzero;
  options.separate = arguments.separate;
  options.walls = arguments.walls;
  if (options.walls && (arguments.nonzero || arguments.separate > 0)) {
    throw UsageError("--walls keeps everything: neither --nonzero nor --separate goes with it");
  }
  options.snap = snap_of(arguments);
  options.go_on = [] { return !campaign_interrupted(); };
  return unite::unite_files(
      arguments.input, arguments.output, options,
      [](const std::string& line) { std::fprintf(stderr, "tetproof: %s\n", line.c_str()); });
}

}  // namespace tetproof
