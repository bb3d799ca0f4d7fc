// Policy: edges as short as a budget of tetrahedra allows.
#pragma once

#include <cmath>

#include "mesher/delmesher.h"

namespace delmesher::policies {

// The size of edges with which a mesh has at least nine tenths of Options::budget, by whole runs.
// Between two sizes tried, tetrahedra are taken for a power of the density: of the third power of
// how many edges go into a length.
class BudgetSize {
 public:
  // May a size be chosen, and has the mesh without one fewer than nine tenths?
  static bool is_wanted(const Options& options, const Result& without_size);

  BudgetSize(const Options& options, const Result& without_size);

  bool is_done() const { return is_done_; }
  // To be tried, if it is not done.
  double size() const { return size_; }
  // The mesh with that size has so many tetrahedra, and is good enough.
  void fits(double tetrahedra);
  // It has so many, or an unknown number, of which 0 is told, or is not good enough.
  void is_too_much(double tetrahedra);

 private:
  struct Tried {
    double density, tetrahedra;
  };

  void try_density(double density);
  void go_on(const Tried& last);

  const double budget_;
  Tried fitting_, too_much_;
  bool has_fitted_ = false, was_too_much_ = false;  // with sizes tried
  double ratio_ = HUGE_VAL;                         // of the densities of both before
  int steps_ = 0;                                   // before
  double size_ = 0;
  bool is_done_ = false;
};

}  // namespace delmesher::policies
