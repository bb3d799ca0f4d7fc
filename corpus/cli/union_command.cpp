#include <cstdio>

#include "corpus/campaigns/campaign.h"
#include "corpus/cli/commands.h"
#include "corpus/union/union_files.h"

namespace tetproof {

int union_command(const UnionArguments& arguments) {
  if (!unite::is_surface_output(arguments.output)) {
    throw UsageError(arguments.output + ": a name that ends in .stl, .ply or .off is expected");
  }
  handle_interrupts();
  unite::UnionOptions options;
  if (arguments.nonzero) options.inside = unite::Inside::nonzero;
  options.separate = arguments.separate;
  options.go_on = [] { return !campaign_interrupted(); };
  return unite::unite_files(
      arguments.input, arguments.output, options,
      [](const std::string& line) { std::fprintf(stderr, "tetproof: %s\n", line.c_str()); });
}

}  // namespace tetproof
