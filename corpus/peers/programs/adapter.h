// What the programs that put another mesher behind the contract of our own have in common: they
// are called as PROGRAM SWITCHES INPUT OUT.mesh STATS.json, read the surface with our reader, write
// the mesh with our writer, and end with our exit codes: 0 done, 2 usage, 3 unreadable or
// unwritable, 4 refused, 5 out of memory, 6 internal error.
#pragma once

#include <chrono>
#include <string>

#include "mesher/delmesher.h"

namespace tetproof::adapter {

struct Call {
  std::string program, switches, input, output, stats;
};

// Ends the process at once: destructors of the peer are not part of what is measured.
// A code other than 0 is explained on standard error.
[[noreturn]] void finish(const Call& call, int code, const std::string& file,
                         const std::string& reason);

// The surface to be meshed; ends with 3 if it cannot be read.
delmesher::Surface read(const Call& call);

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// Some meshers order corners the other way round. All are turned or none, so that tetrahedra that
// the peer inverted stay visible.
void orient(delmesher::TetMesh& mesh);

// Writes mesh and statistics, and ends with 0, or with 3 if they cannot be written. `reading` and
// `meshing` are seconds.
[[noreturn]] void deliver(const Call& call, const delmesher::Surface& surface,
                          const delmesher::TetMesh& mesh, double reading, double meshing);

// A peer that has two ways: its defaults, and without its steps of optimization.
struct Peer {
  const char* program;  // the name of the program that calls it
  const char* name;     // of the peer, for messages
  const char* version;
  // Fills the surface. A std::exception is a refusal with that reason, but std::bad_alloc.
  delmesher::TetMesh (*mesh)(const delmesher::Surface& surface, bool raw);
};

// The whole program for such a peer, whose SWITCHES are "-" or "raw".
int run(const Peer& peer, int argc, char** argv);

}  // namespace tetproof::adapter
