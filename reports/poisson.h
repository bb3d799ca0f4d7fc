// A mesh judged by a solver: the Poisson equation with linear elements, by conjugate gradients.
#pragma once

#include <cstdint>
#include <string>

#include "oracles/files/mesh_file.h"

namespace tetproof {

struct PoissonRun {
  std::uint64_t tetrahedra = 0, unknowns = 0;
  unsigned iterations = 0;  // until the residual is 1e-8 of the first one; `converged` says whether
  bool converged = false;
  // Condition number of the preconditioned matrix, estimated from the iterations: the largest over
  // the smallest eigenvalue that they met, so at most the true number. 0 without iterations.
  double condition = 0;
  double largest_error = 0;  // of the solution at a vertex, relative to the largest value
  double mean_error = 0;     // root of the mean square over the volume, in the same way
};

// Solves it on the tetrahedra inside (all, if the file does not tell them apart), with a smooth
// solution that is known and given on the boundary, preconditioned by the diagonal. The solution
// has about half a wave along the diagonal of the bounding box, in a direction that is not an axis.
// It is given up after 10 iterations per unknown (and 100), or `most_iterations`.
PoissonRun solve_poisson(const oracles::MeshFile& mesh, unsigned most_iterations = 5000);

// A line.
std::string to_json(const PoissonRun& run);

}  // namespace tetproof
