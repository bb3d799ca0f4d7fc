// Ctrl-C, termination and the end of a terminal: politely while the library runs, at once
// otherwise, never leaving temporaries behind.
#pragma once

#include <csignal>
#include <string>
#include <vector>

namespace delmesher::cli {

// From now on SIGINT, SIGTERM, SIGHUP and SIGQUIT end the program at once with code 130, removing
// temporaries; SIGPIPE and SIGXFSZ are ignored, so that writing fails instead. Between
// begin_deferring() and end_deferring() the first one only sets the flag. One that is ignored stays
// so: whoever started the program (nohup, or a shell in the background) wants it to go on.
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

// Signals wait while files take their names, all or none. Once they have them, signals do nothing
// any more (note_files_in_place): exit code and files agree.
class Committing {
 public:
  Committing();
  ~Committing();
  Committing(const Committing&) = delete;
  Committing& operator=(const Committing&) = delete;

 private:
  sigset_t before_;
};
void note_files_in_place(bool there);

// The files, and empty folders, to remove should a signal end the program.
void set_temporaries(const std::vector<std::string>& paths);

// Like fork(), but signals are passed on to the new process, unless it gets them anyway (from a
// terminal), until it is forgotten. The new process has no children to pass them on to, and defers
// nothing.
int fork_child();
void forget_child(int pid);

}  // namespace delmesher::cli
