// Shapes of tetrahedra: gamma and SICN. Both are 1 for a regular tetrahedron and 0 for a flat one.
#pragma once

#include "oracles/mesh/tet_complex.h"

namespace tetproof::oracles {

struct TetShape {
  double gamma = 0;  // 3 times the radius of the inscribed sphere over that of the circumsphere
  // Gmsh's signed inverse condition number: 3 over the product of the Frobenius norms of S and its
  // inverse, where S maps a regular tetrahedron to this one. Negative for inverted tetrahedra.
  double sicn = 0;
};

// Right to 1e-7 of the values: by doubles where these are certain, else from exact coordinates.
TetShape shape_of(const ExactPoints& points, const Tet& tet);

// Takes the shapes and the smallest dihedral angles of tetrahedra, for a report.
class ShapeMeasure {
 public:
  void add(const TetShape& shape, double smallest_dihedral);
  // Adds shares, extremes, means and 1 % quantiles, if there were any tetrahedra.
  void report(OracleReport& report);

 private:
  std::vector<double> dihedrals_, gammas_;
  double below_5_ = 0, below_10_ = 0;
  double smallest_gamma_ = 1, smallest_sicn_ = 1, gamma_sum_ = 0, sicn_sum_ = 0;
};

}  // namespace tetproof::oracles
