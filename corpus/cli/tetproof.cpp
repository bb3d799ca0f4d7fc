// tetproof: runs meshers on models, checks what they deliver and reports.
#include <cstdio>
#include <cstring>
#include <exception>

#include "corpus/cli/commands.h"
#ifdef TETPROOF_HAS_VERIFY
#include "oracles/verify_command.h"
#endif

int main(int argc, char** argv) {
#ifdef TETPROOF_HAS_VERIFY
  // The oracles read their own arguments.
  if (argc > 1 && std::strcmp(argv[1], "verify") == 0) {
    return tetproof::run_verify(argc - 1, argv + 1);
  }
#endif
  CLI::App app("Runs tetrahedral meshers on models, checks what they deliver and reports.",
               "tetproof");
  app.set_version_flag("--version", std::string("tetproof ") + TETPROOF_VERSION);
  app.require_subcommand(1);
  const tetproof::Command commands[] = {tetproof::add_run_command(app),
                                        tetproof::add_report_command(app),
                                        tetproof::add_measure_command(app)};
#ifdef TETPROOF_HAS_VERIFY
  app.add_subcommand("verify", "Exact checks of a mesh against its input (see verify --help)");
#endif
  try {
    app.parse(argc, argv);
    for (const auto& command : commands) {
      if (command.app->parsed()) return command.run();
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tetproof: %s\n", error.what());
    return 3;
  }
  return 2;
}
