// The filter of dihedral angles, in the terms of filter.h.
#pragma once

#include "mesher/predicates/filter.h"

namespace delmesher::predicates::filters {

// The polynomial of polynomials::Dihedral, with u = b - d, v = a - d, e = c - d: 12 monomials of at
// most mu mv me^2. Roundings: 4 differences, 2 + 2 in the crosses' products and differences, 1
// product, 2 sums, k = 11: 12 * 11 u = 132 u < 12 * 12 u, a 12 for each cross, which overflows if
// the cross does.
inline int dihedral(const Approximation& a, const Approximation& b, const Approximation& c,
                    const Approximation& d) {
  const double ux = b.x - d.x, uy = b.y - d.y, uz = b.z - d.z;
  const double vx = a.x - d.x, vy = a.y - d.y, vz = a.z - d.z;
  const double ex = c.x - d.x, ey = c.y - d.y, ez = c.z - d.z;
  const double mx = uy * ez - uz * ey, my = uz * ex - ux * ez, mz = ux * ey - uy * ex;
  const double nx = vy * ez - vz * ey, ny = vz * ex - vx * ez, nz = vx * ey - vy * ex;
  const double value = mx * nx + my * ny + mz * nz;
  const double mu = largest(ux, uy, uz), mv = largest(vx, vy, vz), me = largest(ex, ey, ez);
  // Underflow: 24 * 2^-1075 in the crosses, times at most 2 (mu + mv) me; 3 * 2^-1075 after them.
  double bound = ((12 * mu * me) * (12 * mv * me)) * 0x1p-53 + (mu + mv + 1) * (me + 1) * 0x1p-900;
  const double error = larger(larger(a.error, b.error), larger(c.error, d.error));
  if (error != 0) {
    const double f = kDifferenceError * error;
    const double nu = mu + f, nv = mv + f, ne = me + f;
    bound += 12.001 * f * ne * (nu * ne + nv * ne + 2 * nu * nv);
  }
  return certain_sign(value, bound);
}

}  // namespace delmesher::predicates::filters
