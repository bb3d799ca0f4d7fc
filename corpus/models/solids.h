// The solids that a surface bounds, for meshers that ask for each by itself: a shell and the
// cavities in it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "oracles/surface/input_surface.h"

namespace tetproof {

struct Solid {
  std::size_t outer;                  // the shell around it
  std::vector<std::size_t> cavities;  // shells in that one, with nothing of the solid inside
};

struct Solids {
  // Shells are connected by edges; numbered from 0 by their first triangles.
  std::vector<std::size_t> shell_of_triangle;
  std::vector<Solid> solids;  // by their outer shells; in a cavity there may be others
};

// By parity, decided exactly; whichever way the shells are oriented.
// \throw std::runtime_error if the surface bounds no solid: it is open, or shells meet.
Solids solids_of(const oracles::Polyhedron& surface);

}  // namespace tetproof
