// In place of what the command line of the mesher does with signals and other processes.
#include "mesher/cli/batch.h"
#include "mesher/cli/signals.h"

namespace delmesher::cli {

void install_signal_handlers() {}
void begin_deferring() {}
void end_deferring() {}
bool interrupted() {
  return false;
}
Committing::Committing() : before_() {}
Committing::~Committing() = default;
void note_files_in_place(bool /*there*/) {}
void set_temporaries(const std::vector<std::string>& /*paths*/) {}

int run_batch(const std::vector<Command>& /*commands*/, unsigned /*jobs*/,
              const Library& /*library*/, const Streams& streams) {
  streams.error("delmesher: several inputs need processes, which this build has not\n");
  return kUnreadable;
}

}  // namespace delmesher::cli
