// The ladder: what a run does where an attempt is not good enough.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace delmesher {

// In the order in which the rungs are taken: those of a stage are complete before the next stage
// begins, and the last ones repeat the run. What an attempt has to do to be good enough:
enum class Rung : std::uint8_t {
  // Filter and chamfering: no more tetrahedra are predicted than the budget or automatic allows.
  larger_tau,
  // Refinement: it ends.
  chamfers_everywhere,
  // With --planar 0: the mesh goes back to the surface as given. A kept surface: the edges between
  // its coplanar triangles come back.
  tetrahedrize_again,
  // Rounding: no tetrahedron is inverted or flat, as written or on exact coordinates.
  other_orders,
  untangle,
  thin_out,
  input_alone,
  // The run: with --surface auto, the mesh is not too heavy. No tetrahedron is inverted or flat:
  // where vertices were moved to make facets planar, and where the mesh has gone back.
  keep_surface,
  back_to_given,
  no_planes,
  // The run: the mesh is not too coarse for a solver, or has nine tenths of its budget.
  default_size,
  fill_budget
};
inline constexpr std::size_t kRungCount = 12;

// Each is taken as long as it applies and the attempt is not good enough, `at_most` times.
struct RungRow {
  const char* name;  // in the statistics
  std::size_t at_most;
  const char* when;    // besides that
  const char* change;  // for the next attempt
  const char* kept;    // of the attempt before
  const char* cost;
};

inline constexpr std::array<RungRow, kRungCount> kLadder = {{
    {"larger_tau", 1, "--surface auto", "the tau asked for: the filter drops more", "the surface",
     "filter, chamfering"},
    {"chamfers_everywhere", 1, "", "chamfers up to 90 degrees, empty diametral balls", "tau",
     "filter, chamfering, refinement"},
    {"tetrahedrize_again", 1, "no bound on edges, or a kept surface", "the surface as given",
     "points on its edges and in the volume", "a constrained tetrahedrization"},
    {"other_orders", 3, "few defects are left", "repairs in another order", "the mesh",
     "the repairs"},
    {"untangle", 8, "few defects are left", "repairs that move vertices over others", "the mesh",
     "a hundred times the repairs"},
    {"thin_out", 4, "", "points at the defects, then around them, are taken out", "other points",
     "the repairs"},
    {"input_alone", 1, "the surface is small", "only the vertices of the input", "the surface",
     "a constrained tetrahedrization, the repairs"},
    {"keep_surface", 1, "--surface auto", "as with --surface keep", "nothing",
     "a tetrahedron or two per triangle"},
    {"back_to_given", 1, "the mesh may go back", "as with planar facets only while it is refined",
     "nothing", "a run"},
    {"no_planes", 1, "", "no planar facets", "nothing", "a run; tetrahedra as before"},
    {"default_size", 1, "--size auto", "edges of a tenth or twentieth of the diagonal", "nothing",
     "a run; more than twice the tetrahedra"},
    {"fill_budget", 6, "--budget", "shorter edges, or longer ones than those that took too many",
     "nothing", "a run"},
}};

// How often each rung was taken.
struct RungCounts {
  std::array<std::uint64_t, kRungCount> times{};

  std::uint64_t& operator[](Rung rung) { return times[static_cast<std::size_t>(rung)]; }
  std::uint64_t operator[](Rung rung) const { return times[static_cast<std::size_t>(rung)]; }
  RungCounts& operator+=(const RungCounts& other) {
    for (std::size_t i = 0; i < kRungCount; ++i) times[i] += other.times[i];
    return *this;
  }
};

}  // namespace delmesher
