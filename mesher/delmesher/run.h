// How a run is limited and watched, and how it ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace delmesher {

// The tetrahedra that are guaranteed to be good, and that are written.
enum class Region : std::uint8_t {
  interior,  // tetrahedra in the solid; a bad tetrahedron disjoint from it is left alone
  hull       // everything down to the outer box
};

// The stages of a run, in the order of the statistics.
enum class Phase : std::uint8_t {
  read,
  check,
  remesh,
  filter,
  chamfer,
  delaunay,
  segments,
  facets,
  refine,
  enrich,
  classify,
  improve,
  round,
  write
};
inline constexpr std::size_t kPhaseCount = 14;

// Name of a phase as used by the statistics ("read", "check", ...).
const char* phase_name(Phase phase);

struct Progress {
  Phase phase;
  double done;                      // fraction of the phase in [0, 1]; negative if unknown
  std::uint64_t vertices;           // present number of mesh vertices, 0 if not meaningful
  double predicted_tetrahedra = 0;  // of the final mesh, known before refinement begins; 0: not yet
};

// How long a call may take, and who watches it. Beyond a limit it ends with
// StatusCode::limit_reached.
struct TimeLimit {
  double time_limit_seconds = 0;  // 0: no limit
  // Called several times a second from the calling thread; false, or any exception, cancels it.
  std::function<bool(const Progress&)> progress;
};

// The same, with vertices and threads.
struct Limits : TimeLimit {
  std::uint64_t max_vertices = 0;  // 0: no limit
  // Threads that share the work of checks, filter, classification of the refined mesh and
  // statistics. The result is the same for every number. 0: as many as the machine has cores.
  unsigned threads = 1;
};

enum class StatusCode : std::uint8_t {
  ok,
  invalid_options,  // the message names the option
  invalid_surface,  // the message names the vertices, edges or triangles
  limit_reached,    // vertices, tetrahedra, time, memory or the precision of doubles
  interrupted,      // the progress callback returned false
  internal_error,   // a bug; the message says where
  invalid_mesh      // the message names the vertices, triangles or tetrahedra
};

enum class Limit : std::uint8_t {
  none,
  size,       // Limits::max_vertices, or the range of indices
  time,       // Limits::time_limit_seconds
  memory,     // an allocation failed
  precision,  // features are too close to each other for doubles to express
  budget      // of tetrahedra: Options::budget, or what SurfaceChoice::automatic allows
};

struct Status {
  StatusCode code = StatusCode::ok;
  std::string message;
  Limit limit = Limit::none;  // which one, where code is limit_reached
  bool ok() const { return code == StatusCode::ok; }
};

}  // namespace delmesher
