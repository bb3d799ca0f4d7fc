// Ctrl-C and termination: politely while the library runs, at once otherwise, never leaving
// temporaries behind.
#pragma once

#include <string>
#include <vector>

namespace delmesher::cli {

// From now on SIGINT and SIGTERM end the program at once with code 130, removing temporaries;
// between begin_deferring() and end_deferring() the first one only sets the flag.
void install_signal_handlers();
void begin_deferring();
void end_deferring();
bool interrupted();

// Lets a signal ask the library to stop instead of ending the program.
class Deferring {
 public:
  Deferring() { begin_deferring(); }
  ~Deferring() { end_deferring(); }
  Deferring(const Deferring&) = delete;
  Deferring& operator=(const Deferring&) = delete;
};

// The files to remove should a signal end the program.
void set_temporaries(const std::vector<std::string>& paths);

}  // namespace delmesher::cli
